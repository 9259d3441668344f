//! The paper's runs on the FMU: inputs, outputs and measures, and the paper's figures 5 to 9.
//!
//! The command is in `main.rs`. This library holds its parts for tests and other programs.

mod chart;
pub mod figures;
pub mod manoeuvres;
pub mod parameter_set;
pub mod recording;
pub mod simulate;
pub mod table;
mod thin;
