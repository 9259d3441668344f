//! A host that does everything wrong that can be done with valid memory: random calls of all
//! functions with right and wrong arguments, on several instances that exchange their states. After
//! each call, what the library did is held against what the standard says, and what it shows
//! against what was set.

mod calls;
mod choices;
mod expected;
mod logger;
mod palette;
mod player;
mod states;
mod steps;
mod variables;
mod world;

pub use choices::Choices;
pub use world::{Tally, run};
