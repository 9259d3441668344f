//! The paper's runs on the FMU: inputs, outputs and measures, and the paper's figures 5 to 9.
//!
//! The commands are in `main.rs` and `bin/first-ride.rs`. This library holds its parts for
//! tests and other programs.

mod chart;
pub mod curves;
pub mod figures;
pub mod fmu;
pub mod parameter_set;
pub mod simulate;
pub mod table;
mod thin;
pub mod trace;
