//! A host that does everything wrong that can be done with valid memory: random calls of all
//! functions with right and wrong arguments, on several instances that exchange their states. After
//! each call, what the library did is held against what the standard says, and what it shows
//! against what was set. One driver serves both versions of FMI, and tests and fuzzer alike.

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
