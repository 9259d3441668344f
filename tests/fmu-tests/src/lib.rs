//! Shared parts of the libraries' tests: a hostile host for any of them, and the hunter, which
//! searches for a broken limit of the washout.

pub mod hostile;
pub mod hunter;
/// The calling sequence of FMI 2.0.
#[path = "../../../crates/fmi/tests/fmi2/standard.rs"]
pub mod standard2;
/// The calling sequence of FMI 3.0.
#[path = "../../../crates/fmi/tests/fmi3/standard.rs"]
pub mod standard3;
pub mod swing;
