//! As many inputs and outputs as a washout has at a step, and nothing between them.

use moris_interface::{
    Group, Identity, Model, Refusal, Row, Slot, concat_rows, interface, row_count, slot_count, slot_table, units::S,
};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

interface! {
    /// The independent variable.
    pub struct Clock: Independent, Continuous {
        /// Simulation time.
        "time" time: f64 [S] = 0.0;
    }
}

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

const GROUPS: &[&[Row]] = &[Clock::ROWS, Input::ROWS, Output::ROWS];
static ROWS: [Row; row_count(GROUPS)] = concat_rows(GROUPS);
static SLOTS: [Slot; slot_count(&concat_rows::<{ row_count(GROUPS) }>(GROUPS))] =
    slot_table(&concat_rows::<{ row_count(GROUPS) }>(GROUPS));

/// Nothing, as a model.
#[derive(Clone, Serialize, Deserialize)]
pub struct DoNothing;

impl Model for DoNothing {
    const IDENTITY: Identity = Identity {
        name: "DoNothing",
        version: "1",
        text: "A model that does nothing.",
        rows: &ROWS,
        slots: &SLOTS,
        main_parameters: &[],
        stop_time: 1.0,
        step_size: 0.001,
    };

    fn start(slots: &mut [f64]) {
        slots.fill(0.0);
    }

    fn new(_slots: &[f64]) -> Result<Self, Refusal> {
        Ok(DoNothing)
    }

    fn retune(&mut self, _slots: &[f64]) -> Result<(), Refusal> {
        Ok(())
    }

    fn step(&mut self, _slots: &[f64], _derivatives: Option<&[f64]>, _step: f64) {}

    fn outputs(&self, _slots: &mut [f64]) {}

    fn output_derivatives(&self, _slots: &mut [f64]) {}
}
