//! The optimal strategy: a linear-quadratic regulator for each axis.
//!
//! After Sivan, Ish-Shalom and Huang (1982), Reid and Nahon (1985), and Telban and Cardullo
//! (NASA/CR-2005-213747), with the dropped force in place of the vestibular error. As feedback of
//! the motion that the limits leave, it needs no measure against wind-up.

use serde::{Deserialize, Serialize};

use super::regulator::{AxisModel, Regulator, State, Weights};
use super::{AxisState, Decision, at_rest_if_tiny};
use crate::interface::OptimalParameters;

/// The strategy with its state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Optimal {
    models: [AxisModel; 2],
    regulators: [Regulator; 2],
    tuning: Tuning,
    /// Low-pass of each axis's reference \[m/s2\].
    slow: [f64; 2],
}

/// The tunable parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tuning {
    pub weights: Weights,
    /// Time constant that splits the reference into its slow and its fast part \[s\].
    pub split_time: f64,
}

impl From<&OptimalParameters> for Tuning {
    fn from(parameters: &OptimalParameters) -> Self {
        Tuning {
            weights: Weights {
                position: parameters.weight_position,
                velocity: parameters.weight_velocity,
                tilt_rate: parameters.weight_tilt_rate,
                tilt_acceleration: parameters.weight_tilt_acceleration,
                slow_pole: parameters.slow_pole,
                fast_pole: parameters.fast_pole,
            },
            split_time: parameters.split_time,
        }
    }
}

impl Optimal {
    /// At rest. None if the weights cannot be used.
    pub fn new(models: &[AxisModel; 2], tuning: &Tuning) -> Option<Self> {
        let regulator = |axis: usize| Regulator::new(&models[axis], &tuning.weights);
        let regulators = [regulator(0)?, regulator(1)?];
        Some(Optimal { models: *models, regulators, tuning: *tuning, slow: [0.0; 2] })
    }

    /// Takes other parameters. False, and nothing changes, if they cannot be used.
    pub fn retune(&mut self, models: &[AxisModel; 2], tuning: &Tuning) -> bool {
        if (models, tuning) == (&self.models, &self.tuning) {
            return true;
        }
        let Some(tuned) = Optimal::new(models, tuning) else { return false };
        *self = Optimal { slow: self.slow, ..tuned };
        true
    }

    /// Decision for a step of `step` seconds that begins in these states, with these
    /// references at its end.
    pub fn decide(&mut self, states: &[AxisState; 2], references: [f64; 2], step: f64) -> [Decision; 2] {
        let fraction = 1.0 - libm::exp(-step / self.tuning.split_time);
        [0, 1].map(|k: usize| {
            self.slow[k] = at_rest_if_tiny(self.slow[k] + fraction * (references[k] - self.slow[k]));
            let AxisState { position, velocity, tilt, tilt_rate } = states[k];
            let (slow, fast) = (self.slow[k], references[k] - self.slow[k]);
            let state = State::new(position, velocity, tilt, tilt_rate, slow, fast);
            let [dropped_force, tilt_acceleration] = self.regulators[k].control(&state);
            Decision { dropped_force, tilt_acceleration }
        })
    }
}
