//! Errors of recordings, and quotations of the file.

use std::io;
use std::path::{Path, PathBuf};

use moris_interface::shown;

use crate::message::{Message, Words};

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
    Line { file: PathBuf, line: u64, column: Option<String>, reason: Message },
    /// The file, of a recording or of conventions, as a whole cannot be used.
    #[error("{}: {reason}", file.display())]
    Whole { file: PathBuf, reason: Message },
}

impl RecordingError {
    /// A file that cannot be used as a whole.
    pub fn whole(file: &Path, reason: impl Into<Message>) -> Self {
        RecordingError::Whole { file: file.to_owned(), reason: reason.into() }
    }

    /// A line that cannot be used, or the value of a column in it.
    pub fn line(file: &Path, line: u64, column: Option<String>, reason: impl Into<Message>) -> Self {
        RecordingError::Line { file: file.to_owned(), line, column, reason: reason.into() }
    }

    /// The error in a face's words.
    pub fn worded(&self, words: Words) -> String {
        match self {
            RecordingError::Line { file, line, column, reason } => {
                Self::line(file, *line, column.clone(), reason.worded(words)).to_string()
            }
            RecordingError::Whole { file, reason } => Self::whole(file, reason.worded(words)).to_string(),
            RecordingError::Read { .. } | RecordingError::Option { .. } => self.to_string(),
        }
    }
}

/// Text of a file for a message: shortened, and without control characters.
pub fn quoted(text: &str) -> String {
    // Longest text of a file that a message quotes [characters].
    const LONGEST_QUOTE: usize = 40;
    let visible = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let mut quoted: String = text.chars().take(LONGEST_QUOTE).map(visible).collect();
    if text.chars().nth(LONGEST_QUOTE).is_some() {
        quoted.push('…');
    }
    quoted
}
