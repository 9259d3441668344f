//! Messages to whom reads a recording.

mod error;
mod option;
mod quote;

pub use error::RecordingError;
pub use option::{Dialect, given, named};
pub use quote::quoted;
