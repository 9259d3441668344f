//! The robust strategy: the regulator that is least for the worst reference, one for each axis.
//!
//! The paper names robust washout last. Its references (Idan and Sahar 1996) give no weights. The
//! strategy here is the [`optimal`](super::optimal) one with the gains of the
//! [`minimax`](super::minimax) regulator.

use serde::{Deserialize, Serialize};

use super::law::{Decision, Law, LawInput, Unsolvable};
use super::minimax::Disturbance;
use super::optimal::{Optimal, Tuning};
use super::regulator::{AxisModel, Weights};
use crate::interface::{Parameters, RobustParameters};

/// The strategy: the optimal one with the gains of this regulator.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Robust(Optimal);

impl Law for Robust {
    fn at_rest(models: &[AxisModel; 2], parameters: &Parameters) -> Result<Self, Unsolvable> {
        Optimal::new(models, &(&parameters.robust).into()).map(Robust)
    }

    fn set_parameters(&mut self, models: &[AxisModel; 2], parameters: &Parameters) -> Result<(), Unsolvable> {
        self.0.retune(models, &(&parameters.robust).into())
    }

    fn decisions(&mut self, law_input: &LawInput, step: f64) -> Option<[Decision; 2]> {
        self.0.decisions(law_input, step)
    }
}

impl From<&RobustParameters> for Tuning {
    #[rustfmt::skip]
    fn from(parameters: &RobustParameters) -> Self {
        let RobustParameters {
            weight_position: position, weight_velocity: velocity, weight_tilt_rate: tilt_rate,
            weight_tilt_acceleration: tilt_acceleration, slow_pole, fast_pole, attenuation, fast_disturbance, split_time,
        } = *parameters;
        let weights = Weights { position, velocity, tilt_rate, tilt_acceleration, slow_pole, fast_pole };
        Tuning { weights, split_time, disturbance: Some(Disturbance { attenuation, fast: fast_disturbance }) }
    }
}
