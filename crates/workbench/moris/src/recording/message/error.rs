//! Reasons why a recording cannot be simulated.

use std::io;
use std::path::PathBuf;

use moris_interface::shown;

use super::option::Dialect;

/// The reason why a recording cannot be simulated, with its place and the remedy.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// A file cannot be read.
    #[error("cannot read {}: {reason}", file.display())]
    Read { file: PathBuf, reason: io::Error },
    /// The file with the conventions is not one.
    #[error("{}: {reason}", file.display())]
    Conventions { file: PathBuf, reason: String },
    /// An option has a value out of its range.
    #[error("{name} is {}, but must be from {min} to {max} {unit}", shown(*value))]
    Option { name: &'static str, value: f64, min: f64, max: f64, unit: &'static str },
    /// A line or a value in it cannot be used.
    #[error("{}, line {line}{}: {reason}", file.display(), column.as_ref().map(|name| format!(", column {name}")).unwrap_or_default())]
    Line { file: PathBuf, line: u64, column: Option<String>, reason: String },
    /// The file as a whole cannot be used.
    #[error("{}: {reason}", file.display())]
    Whole { file: PathBuf, reason: String },
}

impl RecordingError {
    /// The same with the options in its reason written.
    pub(in crate::recording) fn written(self, dialect: Dialect) -> Self {
        match self {
            RecordingError::Line { file, line, column, reason } => {
                RecordingError::Line { file, line, column, reason: dialect.written(&reason) }
            }
            RecordingError::Whole { file, reason } => RecordingError::Whole { file, reason: dialect.written(&reason) },
            other => other,
        }
    }
}
