//! From the recording's axes to the washout's inputs: `convert` turns them by the [`mounting`].

pub mod convert;
mod mounting;
