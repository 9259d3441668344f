//! The platform's name and variables.

use moris_interface::{Group, Identity, Row, variables, with_tunable};

use crate::interface::{Input, Output, Parameters};

variables!(Input, Output, Parameters);

/// The rows of [`Variables`]. The drives' limits are the rig's; they are fixed for the washout,
/// which plans by them, and tunable here.
static ROWS: [Row; Variables::ROWS.len()] = with_tunable(
    *Variables::ROWS.first_chunk().expect("an array has as many rows as itself"),
    &[("actuator.velocityLimit", 8), ("actuator.accelerationLimit", 9)],
);

/// The parameters' rows.
pub fn parameter_rows() -> &'static [Row] {
    &ROWS[ROWS.len() - Parameters::ROWS.len()..]
}

pub const IDENTITY: Identity = Identity {
    name: "StewartPlatform",
    version: env!("CARGO_PKG_VERSION"),
    text: "Stewart platform with the dynamics of its actuators and of its body: from commanded actuator lengths to the real ones, the forces they carry, and what the rider feels on the real motion.",
    rows: &ROWS,
    slots: Variables::SLOTS,
    stop_time: 60.0,
    step_size: 0.001,
};
