//! The washout filter with the platform's kinematics.

use moris_setup::NamedValues;
use moris_washout::Washout;

use super::{
    ACTUATOR_TERMINAL, FmuModel, ModelFns, POSE_MEMBERS, POSE_TERMINAL, PREVIEW_MEMBERS, PREVIEW_TERMINAL,
    VEHICLE_MEMBERS, VEHICLE_TERMINAL, Wording, example, row_terminal, section,
};

/// The washout's FMU.
pub const WASHOUT: FmuModel = FmuModel {
    name: "MorisWashout",
    packages: ["moris-washout-fmi2", "moris-washout-fmi3"],
    libraries: ["MorisWashout", "MorisWashout_fmi3"],
    title: "MORIS washout: motion cueing on a Stewart platform",
    functions: ModelFns::from::<Washout>(),
    derived_start_values: |_| NamedValues::new(),
    sections: &[
        section!("MorisWashout", "what", "Overview"),
        section!("MorisWashout", "connect", "Connections"),
        section!("MorisWashout", "blocks", "Equations and blocks"),
        section!("MorisWashout", "limits", "Limits"),
        section!("MorisWashout", "errata", "Errata and choices"),
    ],
    wording: &[
        Wording::names(
            "actuators",
            "<code>actuator[1].length</code> to <code>actuator[6].length</code>",
            "the six elements of <code>actuator.length</code>",
        ),
        Wording::fmi2_only(
            "slopes",
            ", or followed linearly where the host gives their derivatives (<code>fmi2SetRealInputDerivatives</code>)",
        ),
        example!("MorisWashout"),
    ],
    terminals: &[
        row_terminal("vehicle", VEHICLE_TERMINAL, VEHICLE_MEMBERS),
        row_terminal("preview", PREVIEW_TERMINAL, PREVIEW_MEMBERS),
        row_terminal(
            "actuators",
            ACTUATOR_TERMINAL,
            &[("actuator.length", "length"), ("actuator.velocity", "velocity")],
        ),
        row_terminal("platform", POSE_TERMINAL, POSE_MEMBERS),
    ],
    icon: include_bytes!("../../icons/MorisWashout.png"),
    reference_input: include_str!("../../reference/MorisWashout_in.csv"),
};
