//! The shipped parameter sets, by name.

use moris_washout::presets::{ADAPTIVE, OPTIMAL, PREACTION, PREDICTIVE, WAKE};

/// A parameter set: names and values of variables.
pub type ParameterSet = &'static [(&'static str, f64)];

/// The parameter sets that are shipped, by the names that users write.
pub const SETS: &[(&str, ParameterSet)] = &[
    ("default", &[]),
    ("wake", WAKE),
    ("preaction", PREACTION),
    ("adaptive", ADAPTIVE),
    ("optimal", OPTIMAL),
    ("predictive", PREDICTIVE),
];
