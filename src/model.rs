//! The washout as a model with variables.

use alloc::{string::String, vec::Vec};

use moris_interface::{Group, Identity, MOST_INTERNAL_STEPS, Model, ParameterError, variables};

use crate::interface::{Inputs, Output, Parameters};
use crate::validate::{input_warnings, warnings};
use crate::washout::Washout;

variables!(Inputs, Output, Parameters);

impl Model for Washout {
    type Input = Inputs;
    type Output = Output;
    type Parameters = Parameters;
    const IDENTITY: Identity = Identity {
        name: "MorisWashout",
        version: env!("CARGO_PKG_VERSION"),
        text: "Washout filter of the MORIS motorcycle simulator with the kinematics of its Stewart platform: from the specific force and angular velocity of a vehicle's rider to the motion of a platform and its six actuators.",
        rows: Variables::ROWS,
        slots: Variables::SLOTS,
        stop_time: 60.0,
        step_size: 0.001,
    };

    fn new(parameters: &Parameters, inputs: &Inputs) -> Result<Self, ParameterError> {
        Ok(Washout::new(parameters)?.starting_with(&inputs.vehicle))
    }

    fn retune(&mut self, parameters: &Parameters) -> Result<(), ParameterError> {
        Washout::retune(self, parameters)
    }

    fn warnings(parameters: &Parameters) -> Vec<String> {
        warnings(parameters)
    }

    fn input_warnings(parameters: &Parameters, inputs: &Inputs) -> Vec<String> {
        input_warnings(parameters, &inputs.vehicle)
    }

    fn max_communication_step(&self) -> f64 {
        MOST_INTERNAL_STEPS * self.parameters().structure.max_step
    }

    fn step(&mut self, inputs: &Inputs, step: f64) {
        self.preview(&inputs.preview);
        Washout::step(self, &inputs.vehicle, step);
    }

    fn step_between(&mut self, start: &Inputs, end: &Inputs, step: f64) {
        self.preview(&start.preview);
        Washout::step_between(self, &start.vehicle, &end.vehicle, step);
    }

    fn output(&self) -> Output {
        Washout::output(self)
    }

    fn output_derivative(&self) -> Output {
        Washout::output_derivative(self)
    }
}
