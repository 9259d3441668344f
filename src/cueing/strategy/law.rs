//! The law of a coordinated strategy: what decides on the dropped force and on the tilt.
//!
//! A new strategy is a file beside this one that implements [`Law`], a row of the list at the end
//! of this file, its item of [`StrategyKind`] with its parameters, and its preset.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::adaptive::Adaptive;
use super::optimal::Optimal;
use super::predictive::{Plan, Predictive};
use super::regulator::AxisModel;
use super::robust::Robust;
use crate::interface::{Parameters, StrategyKind};
use crate::motion::Motion;
use crate::platform::{ActuatorGuard, LocationFrame};
use moris_interface::ParameterError;

/// One axis: travel x \[m\] and the tilt q \[rad\] whose gravity acts along it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AxisState {
    pub position: f64,
    pub velocity: f64,
    pub tilt: f64,
    pub tilt_rate: f64,
    pub tilt_acceleration: f64,
}

/// A law's decision for one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// Felt force less the cue \[m/s2\].
    pub dropped_force: f64,
    /// Acceleration of the tilt \[rad/s2\].
    pub tilt_acceleration: f64,
}

/// State at a step's beginning, and the known part of its end.
#[derive(Clone, Copy, Debug)]
pub struct Circumstances<'a> {
    pub parameters: &'a Parameters,
    pub guard: &'a ActuatorGuard,
    pub head: &'a LocationFrame,
    /// The cue at the step's end, in head axes \[m/s2\].
    pub force: Vector3<f64>,
    /// Roll, pitch and yaw beside the tilt, at the step's end.
    pub angles: &'a Motion<Vector3<f64>>,
    /// The rider's lean as far as the platform makes up for it \[rad\].
    pub lean: f64,
    /// 1: engaged, 0: disengaged; between them: being engaged or disengaged.
    pub engagement: f64,
    /// Time until the vehicle stands, infinite while no stop is foreseen \[s\].
    pub time_to_stop: f64,
}

/// What a law decides by: surge and sway at a step's beginning, and the effective references at its
/// end \[m/s2\].
#[derive(Clone, Copy, Debug)]
pub struct Situation<'a> {
    pub states: [AxisState; 2],
    pub references: [f64; 2],
    pub circumstances: &'a Circumstances<'a>,
}

/// What decides on the dropped force and the tilt of surge and sway.
pub trait Law: Sized {
    /// At rest.
    ///
    /// # Errors
    /// The weights cannot be used.
    fn at_rest(models: &[AxisModel; 2], parameters: &Parameters) -> Result<Self, Unsolvable>;

    /// Takes other parameters, and continues from its state.
    ///
    /// # Errors
    /// The weights cannot be used. Nothing has changed then.
    fn set_parameters(&mut self, models: &[AxisModel; 2], parameters: &Parameters) -> Result<(), Unsolvable>;

    /// Decisions for a step of `step` seconds on surge and sway. None if there is nothing to decide
    /// by: the platform then returns to neutral.
    fn decisions(&mut self, situation: &Situation, step: f64) -> Option<[Decision; 2]>;

    /// The largest heave that is left to the heave channel \[m\].
    fn largest_heave(&self) -> f64 {
        f64::INFINITY
    }

    /// The plan that is carried out, of a law that plans.
    fn plan(&self) -> Option<&Plan> {
        None
    }

    /// The law that makes use of a preview, if this one does.
    fn previewed(&mut self) -> Option<&mut Predictive> {
        None
    }
}

/// The error for weights with which the Riccati equation has no numerical solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unsolvable {
    /// Of the strategy, as its parameters begin.
    pub strategy: &'static str,
    pub weight_position: f64,
}

impl From<Unsolvable> for ParameterError {
    fn from(Unsolvable { strategy, weight_position }: Unsolvable) -> Self {
        ParameterError {
            variable: format!("{strategy}.weightPosition"),
            reason: format!(
                "is {weight_position}, and with the strategy's other weights and poles the Riccati equation has no \
                 numerical solution; choose them nearer to their start values"
            ),
        }
    }
}

/// Makes [`AnyLaw`] of the laws, each with the item of [`StrategyKind`] that chooses it.
macro_rules! laws {
    ($($item:ident: $law:ty),+ $(,)?) => {
        /// The law of the strategy in use.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub enum AnyLaw {
            $($item($law)),+
        }

        impl AnyLaw {
            /// The law that the parameters choose, at rest. None for the classical strategy, which
            /// has none.
            ///
            /// # Errors
            /// The weights cannot be used.
            pub fn of(models: &[AxisModel; 2], parameters: &Parameters) -> Result<Option<Self>, Unsolvable> {
                Ok(match parameters.structure.strategy {
                    StrategyKind::Classical => None,
                    $(StrategyKind::$item => Some(AnyLaw::$item(Law::at_rest(models, parameters)?))),+
                })
            }

            /// As [`Law::set_parameters`].
            pub fn set_parameters(&mut self, models: &[AxisModel; 2], parameters: &Parameters) -> Result<(), Unsolvable> {
                match self {
                    $(AnyLaw::$item(law) => law.set_parameters(models, parameters)),+
                }
            }

            /// As [`Law::decisions`].
            pub fn decisions(&mut self, situation: &Situation, step: f64) -> Option<[Decision; 2]> {
                match self {
                    $(AnyLaw::$item(law) => law.decisions(situation, step)),+
                }
            }

            /// As [`Law::largest_heave`].
            pub fn largest_heave(&self) -> f64 {
                match self {
                    $(AnyLaw::$item(law) => law.largest_heave()),+
                }
            }

            /// As [`Law::plan`].
            pub fn plan(&self) -> Option<&Plan> {
                match self {
                    $(AnyLaw::$item(law) => law.plan()),+
                }
            }

            /// As [`Law::previewed`].
            pub fn previewed(&mut self) -> Option<&mut Predictive> {
                match self {
                    $(AnyLaw::$item(law) => law.previewed()),+
                }
            }
        }
    };
}

laws! {
    Adaptive: Adaptive,
    Optimal: Optimal,
    Robust: Robust,
    Predictive: Box<Predictive>,
}
