//! A first-order low-pass, as for an accelerometer ahead of the washout: a model of three
//! variables.
#![allow(non_snake_case)] // FMI 2.0 names the library as the model

use moris_interface::units::{M_PER_S2, S};
use moris_interface::{Group, Identity, Model, ParameterError, interface, variables};
use serde::{Deserialize, Serialize};

interface! {
    /// The signal.
    pub struct Input: Input, Continuous {
        /// Specific force before the filter.
        "u" u: f64 [M_PER_S2] = 0.0;
    }
}

interface! {
    /// The filtered signal.
    pub struct Output: Output, Continuous {
        /// Specific force after the filter.
        "y" y: f64 [M_PER_S2] = 0.0;
    }
}

interface! {
    /// Parameters.
    pub struct Parameters: Parameter, Tunable {
        /// Time constant.
        "tau" tau: f64 [S] { 1e-3 ..= 1e3 } = 0.5;
    }
}

variables!(Input, Output, Parameters);

/// The low-pass: tau y' = u - y.
#[derive(Clone, Serialize, Deserialize)]
pub struct LowPass {
    parameters: Parameters,
    u: f64,
    y: f64,
}

impl Model for LowPass {
    type Input = Input;
    type Output = Output;
    type Parameters = Parameters;
    const IDENTITY: Identity = Identity {
        name: "LowPass",
        version: "1",
        text: "A first-order low-pass.",
        rows: Variables::ROWS,
        slots: Variables::SLOTS,
        stop_time: 3.0,
        step_size: 0.01,
    };

    fn new(parameters: &Parameters, input: &Input) -> Result<Self, ParameterError> {
        Ok(LowPass { parameters: *parameters, u: input.u, y: input.u })
    }

    fn retune(&mut self, parameters: &Parameters) -> Result<(), ParameterError> {
        self.parameters = *parameters;
        Ok(())
    }

    /// Exact for an input that is held at its mean over the step.
    fn step_between(&mut self, start: &Input, end: &Input, step: f64) {
        let mean = 0.5 * (start.u + end.u);
        self.y = mean + (self.y - mean) * (-step / self.parameters.tau).exp();
        self.u = end.u;
    }

    fn output(&self) -> Output {
        Output { y: self.y }
    }

    fn output_derivative(&self) -> Output {
        Output { y: (self.u - self.y) / self.parameters.tau }
    }
}

moris_fmi::export_fmi2!(LowPass);
