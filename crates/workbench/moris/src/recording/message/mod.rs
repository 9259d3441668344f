//! Messages about a recording: errors, the options that help, and quotations of the file.

mod error;
mod option;
mod quote;

pub use error::RecordingError;
pub use option::{Dialect, given, named};
pub use quote::quoted;
