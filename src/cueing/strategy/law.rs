//! The law of a coordinated strategy: what decides on the dropped force and on the tilt.
//!
//! A new strategy is a file beside this one that implements [`Law`], a row of the list in
//! [`laws`](super::laws), its item of `StrategyKind` with its parameters, and its preset.

use alloc::{borrow::ToOwned, format};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::predictive::preview::PreviewedCue;
use super::regulator::AxisModel;
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
pub struct StepContext<'a> {
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

/// Input of a law: surge and sway at a step's beginning, and the effective references at its end
/// \[m/s2\].
#[derive(Clone, Copy, Debug)]
pub struct LawInput<'a> {
    pub states: [AxisState; 2],
    pub references: [f64; 2],
    pub context: &'a StepContext<'a>,
}

/// Control law for the dropped force and the tilt of surge and sway.
pub trait Law {
    /// At rest.
    ///
    /// # Errors
    /// The weights cannot be used.
    fn at_rest(models: &[AxisModel; 2], parameters: &Parameters) -> Result<Self, Unsolvable>
    where
        Self: Sized;

    /// Takes other parameters, and continues from its state: no decision jumps.
    ///
    /// # Errors
    /// The weights cannot be used. Nothing has changed then.
    fn set_parameters(&mut self, models: &[AxisModel; 2], parameters: &Parameters) -> Result<(), Unsolvable>;

    /// Decisions for a step of `step` seconds on surge and sway. None if there is nothing to decide
    /// by: the platform then returns to neutral.
    fn decisions(&mut self, law_input: &LawInput, step: f64) -> Option<[Decision; 2]>;

    /// The largest heave that is left to the heave channel \[m\].
    fn largest_heave(&self) -> f64 {
        f64::INFINITY
    }

    /// The plan that is carried out, of a law that plans.
    fn plan(&self) -> Option<PlanStatus> {
        None
    }

    /// The law as one that makes use of a preview, if it does.
    fn as_previewing(&mut self) -> Option<&mut dyn Previewing> {
        None
    }
}

/// A law that makes use of a preview.
pub trait Previewing {
    /// Sets the specific force of surge and sway that is to come.
    fn preview(&mut self, courses: &[PreviewedCue; 2]);

    /// Delays a preview that has just been given by `lag` seconds.
    fn delay_preview(&mut self, lag: f64);
}

/// The plan of a law that plans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanStatus {
    /// Time since the plan was begun \[s\].
    pub age: f64,
    /// Iterations that it took.
    pub iterations: u32,
    /// True if the last attempt at a newer plan failed.
    pub kept: bool,
}

/// The reason why weights and limits cannot be used. All of them enter the computation; none can be
/// named as the cause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unsolvable {
    /// The regulator's Riccati equation has no numerical solution.
    RiccatiEquation,
    /// The plan's quadratic program is not convex in numbers.
    Program,
    /// The strategy is not part of the program.
    NotBuiltIn,
}

impl Unsolvable {
    /// The refusal of a strategy with its weights.
    pub fn of_strategy(self, strategy: StrategyKind) -> ParameterError {
        let name = strategy.name();
        self.refusal("strategy", name, &format!("the weights and poles {name}.* and "))
    }

    /// The refusal of the automatic scale, whose weights are fixed.
    pub fn of_automatic_scale(self) -> ParameterError {
        self.refusal("scale.automatic", "on", "")
    }

    fn refusal(self, variable: &str, value: &str, weights: &str) -> ParameterError {
        let reason = match self {
            Unsolvable::RiccatiEquation => "the Riccati equation has no numerical solution",
            Unsolvable::Program => "the plan's quadratic program is not convex in numbers",
            Unsolvable::NotBuiltIn => {
                return ParameterError {
                    variable: variable.to_owned(),
                    reason: format!("is {value}, which is not built in; build with the feature {value}"),
                };
            }
        };
        ParameterError {
            variable: variable.to_owned(),
            reason: format!(
                "is {value}, and with {weights}the limits safety.* and tilt.* {reason}; choose them nearer to their start \
                 values"
            ),
        }
    }
}
