//! The whole: parameters, state, and a step.

use model_interface::Refusal;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::interface::{Input, Output, Parameters};

/// How many internal steps a communication step may take.
pub const MOST_INTERNAL_STEPS: f64 = 100_000.0;

/// A motorcycle and its rider.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Motorcycle {
    parameters: Parameters,
    output: Output,
}

impl Motorcycle {
    /// The motorcycle at its initial speed.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why.
    pub fn new(parameters: &Parameters, _input: &Input) -> Result<Self, Refusal> {
        Ok(Motorcycle { parameters: *parameters, output: Output::default() })
    }

    /// The parameters that it was made with.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// Advances by `step` seconds while the inputs go linearly from `start` to `end`.
    pub fn step_between(&mut self, _start: &Input, end: &Input, step: f64) {
        self.output.speed = (self.output.speed + step * (10.0 * end.throttle - 10.0 * end.brake)).max(0.0);
    }

    /// The outputs now.
    pub fn output(&self) -> &Output {
        &self.output
    }

    /// The outputs' time derivatives.
    pub fn output_derivative(&self) -> Output {
        Output { specific_force: Vector3::zeros(), feet_down: 0.0, ..Output::default() }
    }
}
