//! As many inputs and outputs as a washout has at a step, and nothing between them.

use moris_interface::{Group, Identity, Model, ParameterError, interface, variables};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

interface! {
    /// Nine inputs.
    pub struct Input: Input, Continuous {
        /// An input that does nothing.
        "a.@" a: Vector3<f64> = Vector3::new(0.0, 0.0, 0.0);
        /// An input that does nothing.
        "b.@" b: Vector3<f64> = Vector3::new(0.0, 0.0, 0.0);
        /// An input that does nothing.
        "c.@" c: Vector3<f64> = Vector3::new(0.0, 0.0, 0.0);
    }
}

interface! {
    /// Twelve outputs.
    pub struct Output: Output, Continuous {
        /// An output that stays zero.
        "x[#]" x: [f64; 6] = [0.0; 6];
        /// An output that stays zero.
        "y[#]" y: [f64; 6] = [0.0; 6];
    }
}

interface! {
    /// A parameter.
    pub struct Parameters: Parameter, Fixed {
        /// A parameter that does nothing.
        "idle" idle: bool = false;
    }
}

variables!(Input, Output, Parameters);

/// Nothing, as a model.
#[derive(Clone, Serialize, Deserialize)]
pub struct DoNothing;

impl Model for DoNothing {
    type Input = Input;
    type Output = Output;
    type Parameters = Parameters;
    const IDENTITY: Identity = Identity {
        name: "DoNothing",
        version: "1",
        text: "A model that does nothing.",
        rows: Variables::ROWS,
        slots: Variables::SLOTS,
        stop_time: 1.0,
        step_size: 0.001,
    };

    fn new(_: &Parameters, _: &Input) -> Result<Self, ParameterError> {
        Ok(DoNothing)
    }

    fn retune(&mut self, _: &Parameters) -> Result<(), ParameterError> {
        Ok(())
    }

    fn step_between(&mut self, _: &Input, _: &Input, _: f64) {}

    fn output(&self) -> Output {
        Output::START
    }

    fn output_derivative(&self) -> Output {
        Output::START
    }
}
