//! Why a recording cannot be ridden.

use std::io;
use std::path::PathBuf;

/// Why a recording cannot be ridden, with the place and what to do.
#[derive(Debug, thiserror::Error)]
pub enum RideError {
    /// A file cannot be read.
    #[error("cannot read {}: {reason}", file.display())]
    Read { file: PathBuf, reason: io::Error },
    /// The file with the conventions is not one.
    #[error("{}: {reason}", file.display())]
    Conventions { file: PathBuf, reason: String },
    /// An option has a value that it cannot have.
    #[error("{name} is {value}, but must be from {min} to {max} {unit}")]
    Option { name: &'static str, value: f64, min: f64, max: f64, unit: &'static str },
    /// A column is not there.
    #[error(
        "{}: there is no column {column}; there are {}{}; say what it is called with --columns {key}=NAME",
        file.display(), present.join(", "), nearest.as_ref().map(|name| format!(" (is it {name}?)")).unwrap_or_default()
    )]
    NoColumn { file: PathBuf, key: &'static str, column: String, present: Vec<String>, nearest: Option<String> },
    /// A line or a value in it is not what it should be.
    #[error("{}, line {line}{}: {reason}", file.display(), column.as_ref().map(|name| format!(", column {name}")).unwrap_or_default())]
    Line { file: PathBuf, line: u64, column: Option<String>, reason: String },
    /// The file as a whole is not what it should be.
    #[error("{}: {reason}", file.display())]
    Whole { file: PathBuf, reason: String },
}
