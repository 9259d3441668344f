//! The Stewart platform with dynamics.

use moris_setup::{NamedValues, overlaid, values_of};
use moris_stewart_platform::StewartPlatform;
use moris_stewart_platform::interface::neutral_lengths;
use moris_washout::Rig;

use super::{
    ACTUATOR_TERMINAL, FmuModel, ModelFns, POSE_MEMBERS, POSE_TERMINAL, RIDER_TERMINAL, Wording, example, row_terminal,
    section,
};

/// The platform's FMU.
pub const STEWART_PLATFORM: FmuModel = FmuModel {
    name: "StewartPlatform",
    packages: ["moris-stewart-platform-fmi2", "moris-stewart-platform-fmi3"],
    libraries: ["StewartPlatform", "StewartPlatform_fmi3"],
    title: "Stewart platform: a motion base with dynamics",
    functions: ModelFns::from::<StewartPlatform>(),
    derived_start_values: commands_at_neutral,
    sections: &[
        section!("StewartPlatform", "what", "Overview"),
        section!("StewartPlatform", "connect", "Connections"),
        section!("StewartPlatform", "inside", "Equations and blocks"),
        section!("StewartPlatform", "limits", "Limits"),
    ],
    wording: &[
        Wording::names(
            "commands",
            "<code>command[1].length</code> to <code>command[6].length</code>",
            "the six elements of <code>command.length</code>",
        ),
        Wording::names(
            "rates",
            "<code>command[1].velocity</code> to <code>command[6].velocity</code>",
            "the six elements of <code>command.velocity</code>",
        ),
        Wording::fmi2_only(
            "slopes",
            " Where the host gives the lengths' derivatives (<code>fmi2SetRealInputDerivatives</code>), those count instead.",
        ),
        example!("StewartPlatform"),
    ],
    terminals: &[
        row_terminal("actuators", ACTUATOR_TERMINAL, &[("command.length", "length"), ("command.velocity", "velocity")]),
        row_terminal("rider", RIDER_TERMINAL, &[("rider.lean", "lean")]),
        row_terminal("platform", POSE_TERMINAL, POSE_MEMBERS),
    ],
    icon: include_bytes!("../../icons/StewartPlatform.png"),
    reference_input: include_str!("../../reference/StewartPlatform_in.csv"),
};

/// The platform starts at neutral, and its commands are those of neutral.
fn commands_at_neutral(start: &[f64]) -> NamedValues {
    let rig = overlaid(&Rig::default(), &values_of(&STEWART_PLATFORM.functions.identity, start));
    let (quantity, unit) = if rig.has_cranks() { ("angle", rig.crank_arm) } else { ("length", 1.0) };
    let neutral = (1..).zip(neutral_lengths(&rig));
    neutral.map(|(leg, position)| (format!("command[{leg}].{quantity}"), position / unit)).collect()
}
