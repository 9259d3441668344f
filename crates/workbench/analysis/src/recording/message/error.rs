//! Reasons why a recording cannot be simulated.

use std::io;
use std::path::{Path, PathBuf};

use moris_interface::shown;

use super::option::Dialect;

/// The reason why a recording cannot be simulated, with its place and the remedy.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// A file cannot be read.
    #[error("cannot read {}: {reason}", file.display())]
    Read { file: PathBuf, reason: io::Error },
    /// An option has a value out of its range.
    #[error("{name} is {}, but must be from {min} to {max} {unit}", shown(*value))]
    Option { name: &'static str, value: f64, min: f64, max: f64, unit: &'static str },
    /// A line or a value in it cannot be used.
    #[error("{}, line {line}{}: {reason}", file.display(), column.as_ref().map(|name| format!(", column {name}")).unwrap_or_default())]
    Line { file: PathBuf, line: u64, column: Option<String>, reason: String },
    /// The file, of a recording or of conventions, as a whole cannot be used.
    #[error("{}: {reason}", file.display())]
    Whole { file: PathBuf, reason: String },
}

impl RecordingError {
    /// A file that cannot be used as a whole.
    pub fn whole(file: &Path, reason: impl Into<String>) -> Self {
        RecordingError::Whole { file: file.to_owned(), reason: reason.into() }
    }

    /// A line that cannot be used, or the value of a column in it.
    pub fn line(file: &Path, line: u64, column: Option<String>, reason: impl Into<String>) -> Self {
        RecordingError::Line { file: file.to_owned(), line, column, reason: reason.into() }
    }

    /// The same with the options in its reason written.
    pub(in crate::recording) fn written(mut self, dialect: Dialect) -> Self {
        if let RecordingError::Line { reason, .. } | RecordingError::Whole { reason, .. } = &mut self {
            *reason = dialect.written(reason);
        }
        self
    }
}
