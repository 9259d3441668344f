//! Parameter sets shipped beside the default, as names and values of the interface's variables.
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

use moris_interface::{Causality, Model, SlotModel};

use crate::interface::{Compensation, Parameters, Preaction, Reconstruction, StrategyKind, TiltTracking};
use crate::washout::Washout;

/// The set of the paper's runs.
///
/// - Filters: fourth order, with one break frequency for all axes.
/// - Rates: cued in full, without a low-pass.
/// - Compensation by block (4): accelerations only.
/// - Inputs: held.
/// - Soft limits: off.
///
/// It is made for smooth rides. Where rates vibrate, the platform turns with them and
/// shakes the rider's head.
pub const PAPER: &[(&str, f64)] = &joined::<{ OF_THE_PAPER.len() + QUICK_TILT.len() }>(OF_THE_PAPER, QUICK_TILT);

/// For a ride of small, quick motions at constant speed, such as in a truck's wake
/// (the paper's second run).
///
/// Break frequencies are low, so that the platform's travel reproduces everything above 0.1 Hz.
/// Roll rates are scaled down, because a rolled platform adds gravity to the felt sway.
/// Otherwise as [`PAPER`].
///
/// Not for longitudinal runs: accelerations that last would drive the platform
/// into its safety units.
pub const SMALL_MOTIONS: &[(&str, f64)] =
    &joined::<{ OF_THE_PAPER.len() + LONG_TRAVEL.len() }>(OF_THE_PAPER, LONG_TRAVEL);

/// Common part of the sets for the paper's runs.
const OF_THE_PAPER: &[(&str, f64)] = &[
    ("strategy", item(StrategyKind::Classical as i32)),
    ("splitter.order", 4.0),
    ("angular.order", 4.0),
    ("angular.roll.omega1", 1.0),
    ("angular.pitch.omega1", 1.0),
    ("angular.yaw.omega1", 1.0),
    ("scale.angularVelocity.y", 1.0),
    ("scale.angularVelocity.z", 1.0),
    ("compensation", item(Compensation::Full as i32)),
    ("input.rateCutoff", 0.0),
    ("input.reconstruction", item(Reconstruction::Hold as i32)),
    ("tilt.rateLimit", 0.052_359_877_559_829_88),
    ("tilt.accelerationLimit", 0.2),
    ("tilt.angleLimit", 0.38),
    ("tilt.tracking", item(TiltTracking::Exact as i32)),
    ("limit.specificForce.x", 8.0),
    ("limit.specificForce.y", 8.0),
    ("softLimit.pace", 0.0),
];

/// Break frequencies at which tilt reproduces nearly all of an acceleration.
const QUICK_TILT: &[(&str, f64)] = &[
    ("splitter.x.omega1", 2.5),
    ("splitter.y.omega1", 2.5),
    ("splitter.z.omega1", 2.5),
    ("splitter.x.zeta1", 1.0),
    ("splitter.y.zeta1", 1.0),
    ("splitter.z.zeta1", 1.0),
    ("splitter.x.omega2", 2.5),
    ("splitter.y.omega2", 2.5),
    ("splitter.z.omega2", 2.5),
    ("splitter.x.zeta2", 1.0),
    ("splitter.y.zeta2", 1.0),
    ("splitter.z.zeta2", 1.0),
    ("scale.angularVelocity.x", 1.0),
];

/// Break frequencies at which travel reproduces nearly all of an acceleration.
const LONG_TRAVEL: &[(&str, f64)] = &[
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

/// For motorcycles: the classical strategy with less surge, and with tilt that is small and slow. A
/// slalom's braking and accelerating at 7 m/s2 then fits.
pub const MOTORCYCLE: &[(&str, f64)] = &[
    ("strategy", item(StrategyKind::Classical as i32)),
    ("splitter.x.omega1", 5.5),
    ("splitter.x.zeta1", 1.3),
    ("splitter.x.omega2", 1.3),
    ("splitter.y.omega1", 1.6),
    ("splitter.y.zeta1", 1.8),
    ("splitter.y.omega2", 0.6),
    ("splitter.z.omega1", 4.0),
    ("angular.roll.omega1", 0.6),
    ("angular.pitch.omega1", 0.35),
    ("angular.yaw.omega1", 0.3),
    ("scale.specificForce.x", 0.75),
    ("scale.specificForce.y", 0.9),
    ("scale.specificForce.z", 0.9),
    ("scale.angularVelocity.x", 0.28),
    ("scale.angularVelocity.y", 0.45),
    ("scale.angularVelocity.z", 0.3),
    ("input.rateCutoff", 16.0),
    ("tilt.rateLimit", 0.026),
    ("tilt.accelerationLimit", 0.14),
    ("tilt.angleLimit", 0.15),
];

/// For cars, which turn slowly and sway hard: the classical strategy with less sway and slow tilt.
/// Roll, pitch and heave go down to a low frequency.
pub const CAR: &[(&str, f64)] = &[
    ("strategy", item(StrategyKind::Classical as i32)),
    ("splitter.x.omega1", 3.0),
    ("splitter.x.zeta1", 1.3),
    ("splitter.x.omega2", 0.35),
    ("splitter.y.omega1", 3.2),
    ("splitter.y.zeta1", 1.8),
    ("splitter.y.omega2", 1.4),
    ("splitter.z.omega1", 3.0),
    ("angular.roll.omega1", 0.35),
    ("angular.pitch.omega1", 0.5),
    ("angular.yaw.omega1", 0.12),
    ("scale.specificForce.x", 0.9),
    ("scale.specificForce.y", 0.6),
    ("scale.specificForce.z", 0.9),
    ("scale.angularVelocity.x", 0.25),
    ("scale.angularVelocity.y", 0.3),
    ("scale.angularVelocity.z", 0.4),
    ("input.rateCutoff", 22.0),
    ("tilt.rateLimit", 0.033),
    ("tilt.accelerationLimit", 0.12),
    ("tilt.angleLimit", 0.165),
];

/// For a ride that ends in an abrupt stop, if the vehicle model gives its speed: tilt and
/// surge act before it comes.
pub const PREACTION: &[(&str, f64)] = &[("preaction", item(Preaction::On as i32))];

/// The classical strategy. The start values of its parameters are made for any kind of motion.
pub const CLASSICAL: &[(&str, f64)] = &only(StrategyKind::Classical);
/// The adaptive strategy.
pub const ADAPTIVE: &[(&str, f64)] = &only(StrategyKind::Adaptive);
/// The optimal strategy.
pub const OPTIMAL: &[(&str, f64)] = &only(StrategyKind::Optimal);
/// The robust strategy.
pub const ROBUST: &[(&str, f64)] = &only(StrategyKind::Robust);
/// The predictive strategy, which is the start value.
pub const PREDICTIVE: &[(&str, f64)] = &only(StrategyKind::Predictive);

/// The predictive strategy for a vehicle whose force is previewed. Its limits of force and tilt are
/// wider, since what comes after is known.
pub const PREVIEW: &[(&str, f64)] = &joined::<{ PREDICTIVE.len() + FARTHER.len() }>(PREDICTIVE, FARTHER);

/// The limits of force and tilt that a preview allows, since what comes after is known.
const FARTHER: &[(&str, f64)] = &[
    ("limit.specificForce.x", 10.0),
    ("limit.specificForce.y", 10.0),
    ("tilt.angleLimit", 0.38),
    ("softLimit.pace", 9.0),
];

/// The choice of a strategy, and nothing else.
const fn only(strategy: StrategyKind) -> [(&'static str, f64); 1] {
    [("strategy", item(strategy as i32))]
}

/// The value of an enumeration's item: they count from 1.
const fn item(index: i32) -> f64 {
    1.0 + index as f64
}

/// Two sets as one; N is the sum of their lengths.
pub const fn joined<const N: usize>(
    first: &[(&'static str, f64)],
    second: &[(&'static str, f64)],
) -> [(&'static str, f64); N] {
    let mut all = [("", 0.0); N];
    let mut k = 0;
    while k < N {
        all[k] = if k < first.len() { first[k] } else { second[k - first.len()] };
        k += 1;
    }
    all
}

/// The default parameters with a set's values over them.
///
/// # Panics
/// If the set names a variable that is not a parameter.
pub fn parameters(set: &[(&str, f64)]) -> Parameters {
    let identity = Washout::IDENTITY;
    let mut slots = vec![0.0; identity.slots.len()];
    Washout::start_slots(&mut slots);
    for (name, value) in set {
        let slot = identity.slot(name).unwrap_or_else(|| panic!("{name} is no variable of the washout"));
        assert_eq!(identity.row(slot).causality, Causality::Parameter, "{name}");
        slots[slot] = *value;
    }
    Washout::parameters_in(&slots)
}
