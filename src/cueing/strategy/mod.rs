//! The strategies: how the cue is divided between surge, sway and tilt.
//!
//! | module | strategy |
//! |---|---|
//! | [`classical`] | high-pass to travel, low-pass to tilt (the paper) |
//! | [`adaptive`] | a filter whose gains follow the gradient of a cost |
//! | [`optimal`] | a linear-quadratic regulator |
//! | [`robust`] | a regulator for the worst reference |
//! | [`predictive`] | a plan of the next seconds within all limits, made anew 50 times a second |
//!
//! Heave and the angular channel are the same for all. All but the first have
//! [`coordinated`] in common.

pub mod adaptive;
pub mod classical;
pub mod coordinated;
pub mod optimal;
pub mod predictive;
pub mod regulator;
pub mod riccati;
pub mod robust;
pub mod smooth_tilt;

use serde::{Deserialize, Serialize};

use self::classical::Classical;
use self::coordinated::Coordinated;
use self::predictive::{Plan, Predictive};
use crate::cueing::gravitational::Tilt;
use crate::interface::{Parameters, StrategyKind};
use crate::motion::Motion;

/// The strategy in use, with its state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(
    clippy::large_enum_variant,
    reason = "a strategy is chosen once, and a box would allocate when a state is copied"
)]
pub enum Strategy {
    Classical(Classical),
    Coordinated(Coordinated),
}

/// One axis: travel x \[m\] and the tilt q \[rad\] whose gravity acts along it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AxisState {
    pub position: f64,
    pub velocity: f64,
    pub tilt: f64,
    pub tilt_rate: f64,
    pub tilt_acceleration: f64,
}

/// A strategy's decision for one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// Felt force less the cue \[m/s2\].
    pub dropped_force: f64,
    /// Acceleration of the tilt \[rad/s2\].
    pub tilt_acceleration: f64,
}

impl Strategy {
    /// The strategy that the parameters choose, at rest at neutral. None if its
    /// parameters cannot be used.
    pub fn new(parameters: &Parameters) -> Option<Self> {
        Some(match parameters.structure.strategy {
            StrategyKind::Classical => Strategy::Classical(Classical::new(parameters)),
            StrategyKind::Adaptive | StrategyKind::Optimal | StrategyKind::Robust | StrategyKind::Predictive => {
                Strategy::Coordinated(Coordinated::new(parameters)?)
            }
        })
    }

    /// Takes other parameters. False, and nothing changes, if they cannot be used.
    pub fn retune(&mut self, parameters: &Parameters) -> bool {
        match self {
            Strategy::Classical(classical) => {
                classical.retune(parameters);
                true
            }
            Strategy::Coordinated(coordinated) => coordinated.retune(parameters),
        }
    }

    /// Roll and pitch of the tilt.
    pub fn tilt(&self) -> [Motion; 2] {
        match self {
            Strategy::Classical(classical) => [classical.tilt().roll, classical.tilt().pitch],
            Strategy::Coordinated(coordinated) => coordinated.tilt(),
        }
    }

    /// Roll and pitch of the tilt, without their motion.
    pub fn tilt_angles(&self) -> Tilt {
        let [roll, pitch] = self.tilt();
        Tilt { roll: roll.position, pitch: pitch.position }
    }

    /// The plan of the predictive strategy.
    pub fn plan(&self) -> Option<&Plan> {
        match self {
            Strategy::Classical(_) => None,
            Strategy::Coordinated(coordinated) => coordinated.plan(),
        }
    }

    /// The predictive strategy, which alone makes use of a preview.
    pub fn predictive_mut(&mut self) -> Option<&mut Predictive> {
        match self {
            Strategy::Classical(_) => None,
            Strategy::Coordinated(coordinated) => coordinated.predictive_mut(),
        }
    }

    /// The largest heave that the strategy leaves to the heave channel \[m\].
    pub fn largest_heave(&self) -> f64 {
        match self {
            Strategy::Classical(_) => f64::INFINITY,
            Strategy::Coordinated(coordinated) => coordinated.largest_heave(),
        }
    }

    /// True if a limit changed the strategy's tilt in the last step.
    pub fn tilt_limited(&self) -> bool {
        match self {
            Strategy::Classical(classical) => classical.tilt().limited,
            Strategy::Coordinated(coordinated) => coordinated.limited,
        }
    }
}

/// Below this a quantity is zero: what decays for long would otherwise end in denormal
/// numbers, which are slow.
const REST: f64 = 1e-30;

fn at_rest_if_tiny(value: f64) -> f64 {
    if value.abs() < REST { 0.0 } else { value }
}
