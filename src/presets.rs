//! Parameter sets shipped beside the default: files of `presets/`, in the format that users write.
//!
//! ```
//! use moris_washout::presets::{self, CLASSICAL};
//! use moris_washout::{Parameters, Washout};
//!
//! let predictive = Washout::new(&Parameters::default())?;
//! let classical = Washout::new(&presets::parameters(CLASSICAL))?;
//! assert_eq!(classical.output().length, predictive.output().length, "both are at rest");
//! # Ok::<(), moris_washout::ParameterError>(())
//! ```

use alloc::{vec, vec::Vec};

use moris_interface::{Causality, Kind, Model, SlotModel};

use crate::interface::Parameters;
use crate::washout::Washout;

/// The set of the paper's runs.
///
/// - Filters: fourth order, with one break frequency for all axes.
/// - Rates: cued in full, without a low-pass.
/// - Compensation by block (4): accelerations only.
/// - Inputs: held.
/// - Soft limits: off.
///
/// The set is made for smooth rides. Where rates vibrate, the platform turns with them and
/// shakes the rider's head.
pub const PAPER: &str = include_str!("../presets/paper.toml");

/// The classical strategy. The start values of its parameters are made for any kind of motion.
pub const CLASSICAL: &str = include_str!("../presets/classical.toml");

/// The adaptive strategy.
pub const ADAPTIVE: &str = include_str!("../presets/adaptive.toml");

/// The optimal strategy.
pub const OPTIMAL: &str = include_str!("../presets/optimal.toml");

/// The robust strategy.
pub const ROBUST: &str = include_str!("../presets/robust.toml");

/// The predictive strategy for a vehicle whose force is previewed. Its limits of force and tilt are
/// wider, since what comes after is known.
pub const PREVIEW: &str = include_str!("../presets/preview.toml");

/// Names of a set's variables, and their values as slots hold them: enumerations count from 1.
///
/// For the shipped sets: a line is a comment, or a quoted name and its value. The package
/// `moris-setup` reads users' files, and refuses their mistakes with errors.
///
/// # Panics
/// If a line is anything else, such as `[section]` or a value with a comment behind it, or if the
/// name is no variable.
pub fn values(set: &str) -> Vec<(&str, f64)> {
    let is_value = |line: &&str| !line.is_empty() && !line.starts_with('#');
    let value = |line| {
        let (name, value) = str::split_once(line, " = ").unwrap_or_else(|| panic!("{line} is no name and value"));
        (without_quotes(name), parsed_value(without_quotes(name), without_quotes(value)))
    };
    set.lines().filter(is_value).map(value).collect()
}

fn without_quotes(text: &str) -> &str {
    text.trim_matches('"')
}

fn parsed_value(name: &str, value: &str) -> f64 {
    let item = match Washout::IDENTITY.row(variable_slot(name)).kind {
        Kind::Enumeration(enumeration) => enumeration.items.iter().position(|item| item.name == value),
        _ => None,
    };
    let number = item.map_or_else(|| value.parse().ok(), |item| Some(1.0 + item as f64));
    number.unwrap_or_else(|| panic!("{name} has no value {value}"))
}

fn variable_slot(name: &str) -> usize {
    Washout::IDENTITY.slot(name).unwrap_or_else(|| panic!("{name} is no variable of the washout"))
}

/// The default parameters with a set's values over them.
///
/// # Panics
/// As [`values`], and if a name is not that of a parameter.
pub fn parameters(set: &str) -> Parameters {
    with(set, &[])
}

/// The default parameters with a set's values over them, and with these over both.
///
/// # Panics
/// As [`parameters`], also for a name in `changed`.
pub fn with(set: &str, changed: &[(&str, f64)]) -> Parameters {
    let mut slots = vec![0.0; Washout::IDENTITY.slots.len()];
    Washout::start_slots(&mut slots);
    for (name, value) in values(set).iter().chain(changed) {
        let slot = variable_slot(name);
        assert_eq!(Washout::IDENTITY.row(slot).causality, Causality::Parameter, "{name}");
        slots[slot] = *value;
    }
    Washout::parameters_in(&slots)
}
