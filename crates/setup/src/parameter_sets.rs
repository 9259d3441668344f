//! The shipped parameter sets, by name.

use moris_washout::presets::{
    ADAPTIVE, CAR, CLASSICAL, MOTORCYCLE, OPTIMAL, PAPER, PREACTION, PREDICTIVE, PREVIEW, ROBUST, SMALL_MOTIONS,
};

/// The texts of the parameter sets that are shipped, by the names that users write.
pub const SETS: [(&str, &str); 12] = [
    ("default", ""),
    ("classical", CLASSICAL),
    ("motorcycle", MOTORCYCLE),
    ("car", CAR),
    ("paper", PAPER),
    ("small-motions", SMALL_MOTIONS),
    ("preaction", PREACTION),
    ("adaptive", ADAPTIVE),
    ("optimal", OPTIMAL),
    ("robust", ROBUST),
    ("predictive", PREDICTIVE),
    ("preview", PREVIEW),
];
