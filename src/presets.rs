//! Parameter sets shipped beside the default, as names and values of the interface's variables.

use moris_interface::{Causality, Model};

use crate::interface::{Parameters, Preaction, StrategyKind};
use crate::model::parameters_in;
use crate::washout::Washout;

/// For a ride of small, quick motions, such as a truck's wake at constant speed (the paper's second run): low break
/// frequencies, so that the platform's travel reproduces everything above 0.1 Hz, and roll rates scaled down, because a
/// rolled platform adds gravity to the sway that is felt.
///
/// Not for longitudinal runs: accelerations that last would drive the platform into its safety units.
pub const WAKE: &[(&str, f64)] = &[
    ("splitter.x.omega1", 0.35),
    ("splitter.y.omega1", 0.35),
    ("splitter.z.omega1", 0.35),
    ("splitter.x.zeta1", 0.5),
    ("splitter.y.zeta1", 0.5),
    ("splitter.z.zeta1", 0.5),
    ("splitter.x.omega2", 0.35),
    ("splitter.y.omega2", 0.35),
    ("splitter.z.omega2", 0.35),
    ("splitter.x.zeta2", 0.5),
    ("splitter.y.zeta2", 0.5),
    ("splitter.z.zeta2", 0.5),
    ("scale.angularVelocity.x", 0.3),
];

/// For a ride that ends in a brusque stop, if the vehicle model gives its speed: tilt and surge act before it comes.
pub const PREACTION: &[(&str, f64)] = &[("preaction", 1.0 + Preaction::On as i32 as f64)]; // Items count from 1.

/// The default, by the strategies beside the classical one.
pub const ADAPTIVE: &[(&str, f64)] = &[("strategy", 1.0 + StrategyKind::Adaptive as i32 as f64)];
/// See [`ADAPTIVE`].
pub const OPTIMAL: &[(&str, f64)] = &[("strategy", 1.0 + StrategyKind::Optimal as i32 as f64)];
/// See [`ADAPTIVE`].
pub const PREDICTIVE: &[(&str, f64)] = &[("strategy", 1.0 + StrategyKind::Predictive as i32 as f64)];

/// The default parameters with a set's values over them.
///
/// # Panics
/// If the set names a variable that is not a parameter.
pub fn parameters(set: &[(&str, f64)]) -> Parameters {
    let identity = Washout::IDENTITY;
    let mut slots = vec![0.0; identity.slots.len()];
    Washout::start(&mut slots);
    for (name, value) in set {
        let slot = identity.slot(name).unwrap_or_else(|| panic!("{name} is no variable of the washout"));
        assert_eq!(identity.row(slot).causality, Causality::Parameter, "{name}");
        slots[slot] = *value;
    }
    parameters_in(&slots)
}
