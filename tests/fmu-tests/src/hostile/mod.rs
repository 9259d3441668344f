//! A hostile host: random calls of all functions with right and wrong arguments. All memory is
//! valid. Several instances exchange their states. After each call the status is compared with
//! the standard and the values with those that were set. Tests and the fuzzer use one driver for
//! both versions of FMI.

mod calls;
mod choices;
mod expected;
mod fmi2;
mod fmi3;
mod functions;
mod logger;
mod palette;
mod player;
mod states;
mod steps;
mod variables;
mod world;

pub use choices::Choices;
pub use functions::Functions;
pub use world::{CallCounts, run};
