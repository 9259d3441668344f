//! What tests of several libraries share: a hostile host that the washout's library has to stand.

pub mod hostile;
/// The calling sequence of FMI 2.0.
#[path = "../../fmi/tests/abi/standard.rs"]
pub mod standard2;
/// The calling sequence of FMI 3.0.
#[path = "../../fmi/tests/fmi3/standard.rs"]
pub mod standard3;
