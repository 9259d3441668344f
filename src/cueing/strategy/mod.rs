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
//! [`coordinated`] in common, and differ by their [`law`].

pub mod adaptive;
pub mod classical;
pub mod coordinated;
pub mod law;
pub mod laws;
pub mod minimax;
pub mod optimal;
pub mod predictive;
pub mod regulator;
pub mod robust;
pub mod smooth_tilt;

use moris_interface::ParameterError;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use self::classical::Classical;
use self::coordinated::Coordinated;
pub use self::law::{AxisState, Decision, Unsolvable};
use self::law::{PlanStatus, Previewing, StepContext};
use crate::cueing::direct_linear::DirectLinearMotion;
use crate::interface::{Compensation, Parameters};
use crate::motion::Motion;
use crate::motion::orientation::RotationalMotion;

/// The strategy in use, with its state.
#[allow(clippy::large_enum_variant)] // a washout has one, and steps it a thousand times a second
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Strategy {
    Classical(Classical),
    Coordinated(Coordinated),
}

impl Strategy {
    /// The strategy that the parameters choose, at rest at neutral.
    ///
    /// # Errors
    /// Its weights cannot be used.
    pub fn new(parameters: &Parameters) -> Result<Self, ParameterError> {
        match Coordinated::new(parameters) {
            Ok(Some(coordinated)) => Ok(Strategy::Coordinated(coordinated)),
            Ok(None) => Ok(Strategy::Classical(Classical::new(parameters))),
            Err(reason) => Err(reason.of_strategy(parameters.structure.strategy)),
        }
    }

    /// Takes other parameters.
    ///
    /// # Errors
    /// Its weights cannot be used. Nothing has changed then.
    pub fn retune(&mut self, parameters: &Parameters) -> Result<(), ParameterError> {
        match self {
            Strategy::Classical(classical) => {
                classical.retune(parameters);
                Ok(())
            }
            Strategy::Coordinated(coordinated) => {
                coordinated.retune(parameters).map_err(|reason| reason.of_strategy(parameters.structure.strategy))
            }
        }
    }

    /// Advances the tilt by `step` seconds, in which the force in the base frame goes linearly
    /// between these two. `rotation` is the platform's, as predicted for the step's end.
    #[inline(always)]
    pub fn advance_tilt(
        &mut self,
        forces: [Vector3<f64>; 2],
        rotation: &Matrix3<f64>,
        context: &StepContext,
        step: f64,
    ) {
        match self {
            Strategy::Classical(classical) => {
                let StepContext { parameters, head, lean, .. } = *context;
                classical.advance_tilt(forces, rotation, head, lean, parameters, step);
            }
            Strategy::Coordinated(coordinated) => coordinated.advance_tilt(context, step),
        }
    }

    /// The demanded linear motion at a step's end. `filtered` is that of the linear channel,
    /// `preaction` the surge of preaction, and `turning` the platform's rotation.
    #[inline(always)]
    pub fn demand(
        &self,
        mut filtered: Motion<Vector3<f64>>,
        preaction: &Motion,
        context: &StepContext,
        turning: &RotationalMotion,
        step: f64,
    ) -> Motion<Vector3<f64>> {
        match self {
            Strategy::Classical(_) => filtered.add_to_axis(0, preaction),
            Strategy::Coordinated(coordinated) => {
                let heave = filtered.axis(2);
                let [surge, sway] = coordinated.travel(context, turning, &heave, step);
                filtered = Motion::from_axes(|k| [surge, sway, heave][k]);
            }
        }
        filtered
    }

    /// Continues the linear channel from the real motion, without soft limits, where the actuators
    /// have changed it.
    pub fn resume(&self, linear: &mut DirectLinearMotion, parameters: &Parameters, real: &Motion<Vector3<f64>>) {
        match self {
            Strategy::Classical(_) => linear.stay_within(&parameters.safety, real),
            // These strategies decide from the real motion: there is nothing to catch up with.
            Strategy::Coordinated(_) => linear.continue_from(real),
        }
    }

    /// True if travel makes up for the tilt's acceleration as a part of a demand that can stay
    /// beyond a limit. The other strategies ask from one step to the next for what the limits
    /// leave.
    pub fn allows_tilt_overshoot(&self, compensation: Compensation) -> bool {
        matches!(self, Strategy::Classical(_)) && matches!(compensation, Compensation::Full | Compensation::Gravity)
    }

    /// True if preaction moves and tilts the platform. The other strategies see the stop itself.
    pub fn takes_preaction(&self) -> bool {
        matches!(self, Strategy::Classical(_))
    }

    /// Roll and pitch of the tilt.
    pub fn tilt(&self) -> [Motion; 2] {
        match self {
            Strategy::Classical(classical) => [classical.tilt().roll, classical.tilt().pitch],
            Strategy::Coordinated(coordinated) => coordinated.tilt(),
        }
    }

    /// The plan that is carried out, of a strategy that plans.
    pub fn plan(&self) -> Option<PlanStatus> {
        match self {
            Strategy::Classical(_) => None,
            Strategy::Coordinated(coordinated) => coordinated.law.plan(),
        }
    }

    /// The user of a preview; none if the strategy has no use for one.
    pub fn as_previewing(&mut self) -> Option<&mut dyn Previewing> {
        match self {
            Strategy::Classical(_) => None,
            Strategy::Coordinated(coordinated) => coordinated.law.as_previewing(),
        }
    }

    /// The largest heave that the strategy leaves to the heave channel \[m\].
    pub fn largest_heave(&self) -> f64 {
        match self {
            Strategy::Classical(_) => f64::INFINITY,
            Strategy::Coordinated(coordinated) => coordinated.law.largest_heave(),
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
const DENORMAL_THRESHOLD: f64 = 1e-30;

pub(super) fn at_rest_if_tiny(value: f64) -> f64 {
    if value.abs() < DENORMAL_THRESHOLD { 0.0 } else { value }
}
