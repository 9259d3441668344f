//! The motorcycle's name and variables.

use moris_interface::{Group, Identity, variables};

use crate::interface::{Input, Output, Parameters};

variables!(Input, Output, Parameters);

pub const IDENTITY: Identity = Identity {
    name: "Motorcycle",
    version: env!("CARGO_PKG_VERSION"),
    text: "Motorcycle and rider: from throttle, brake, lean and wind to the motion of the rider's head, as the washout takes it in.",
    rows: Variables::ROWS,
    slots: Variables::SLOTS,
    stop_time: 60.0,
    step_size: 0.001,
};
