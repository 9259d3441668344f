//! From the recording's axes to the washout's inputs.

pub mod convert;
pub mod mounting;
