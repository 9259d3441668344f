//! Messages to whom reads a recording.

mod error;
pub mod option;

pub use error::RecordingError;
pub use option::{Dialect, given, named};
