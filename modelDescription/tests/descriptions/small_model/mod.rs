//! A model with a variable of every kind, for the tests.

use moris_interface::units::{M, RAD_PER_S};
use moris_interface::{Group, Identity, Model, ParameterError, enumeration, interface, interface_tree, variables};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

interface! {
    /// Inputs.
    pub struct Entry: Input, Continuous {
        /// A direction & a "size" < 1.
        "entry.@" entry: Vector3<f64> [M] = Vector3::new(0.1 + 0.2, -0.0, 1e-9);
        /// True if it counts.
        "counts" counts: bool = true;
    }
}

interface! {
    /// Outputs.
    pub struct Exit: Output, Continuous {
        /// Angular velocity.
        "exit[#].rate" rate: [f64; 6] [RAD_PER_S] = [0.5; 6];
        /// True if it turns.
        "turns" turns: bool = true;
    }
}

enumeration! {
    /// Direction of rotation.
    pub enum Turning {
        /// To the left.
        "left" Left,
        /// To the right.
        "right" Right,
    }
}

interface! {
    /// Tunable parameters.
    pub struct Tunable: Parameter, Tunable {
        /// A ratio.
        "ratio" ratio: f64 { 0 ..= 1 } = 1.0 / 3.0;
        /// The sense of turning.
        "turning" turning: Turning = Turning::Right;
    }
}

interface! {
    /// Fixed parameters.
    pub struct Fixed: Parameter, Fixed {
        /// Number.
        "many" many: i32 { 1 ..= 9 } = 3, importance_rank(1);
        /// True if it is stiff.
        "stiff" stiff: bool = false;
    }
}

interface_tree! {
    /// All parameters.
    pub struct Parameters {
        tunable: Tunable,
        fixed: Fixed,
    }
}

variables!(Entry, Exit, Parameters);

/// A model that does nothing: it is only described.
#[derive(Clone, Serialize, Deserialize)]
pub struct Small;

impl Model for Small {
    type Input = Entry;
    type Output = Exit;
    type Parameters = Parameters;
    const IDENTITY: Identity = Identity {
        name: "Small",
        version: "1.2.3",
        text: "A model for tests.",
        rows: Variables::ROWS,
        slots: Variables::SLOTS,
        stop_time: 2.5,
        step_size: 0.01,
    };

    fn new(_: &Parameters, _: &Entry) -> Result<Self, ParameterError> {
        Ok(Small)
    }

    fn retune(&mut self, _: &Parameters) -> Result<(), ParameterError> {
        Ok(())
    }

    fn step_between(&mut self, _: &Entry, _: &Entry, _: f64) {}

    fn output(&self) -> Exit {
        Exit::START
    }

    fn output_derivative(&self) -> Exit {
        Exit::START
    }
}
