//! The shipped parameter sets, by name.

use moris_washout::presets::{ADAPTIVE, CLASSICAL, OPTIMAL, PAPER, PREVIEW, ROBUST};

/// The texts of the parameter sets that are shipped, by the names that users write.
pub const PARAMETER_SETS: [(&str, &str); 7] = [
    ("default", ""),
    ("classical", CLASSICAL),
    ("paper", PAPER),
    ("adaptive", ADAPTIVE),
    ("optimal", OPTIMAL),
    ("robust", ROBUST),
    ("preview", PREVIEW),
];
