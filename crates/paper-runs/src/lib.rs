//! The paper's runs on the FMU: what goes in, what comes out, how good it is, and its figures 5 to
//! 9.
//!
//! The command is in `main.rs`; here are its parts, for tests and other programs to use.

mod chart;
pub mod figures;
pub mod manoeuvres;
pub mod parameter_set;
pub mod recording;
pub mod simulate;
pub mod table;
mod thin;
