//! Why a setup cannot be used.

use std::io;
use std::path::PathBuf;

use moris_interface::ParameterError;

use crate::names::suggestion;
use crate::parameter_sets::PARAMETER_SETS;
use crate::rigs::SHIPPED_RIGS;

/// Why a rig file, a parameter file or both together cannot be used, in words that say what to do.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The file cannot be read.
    #[error("cannot read {}: {reason}", file.display())]
    Read { file: PathBuf, reason: io::Error },
    /// Neither a file nor the name of a shipped set.
    #[error(
        "{name} is neither a file nor a parameter set that is shipped{}",
        suggestion(nearest, &format!("shipped are {}", PARAMETER_SETS.map(|(name, _)| name).join(", ")))
    )]
    NoSuchSet { name: String, nearest: Vec<String> },
    /// Neither a file nor the name of a shipped rig.
    #[error(
        "{name} is neither a file nor a rig that is shipped{}",
        suggestion(nearest, &format!("shipped are {}", SHIPPED_RIGS.map(|(name, _)| name).join(", ")))
    )]
    NoSuchRig { name: String, nearest: Vec<String> },
    /// The file is not TOML, or a key has a value of the wrong kind or is missing; the text shows
    /// the place.
    #[error("{source_name}: {}\n{remedy}", text.trim_end())]
    Toml { source_name: String, text: String, remedy: &'static str },
    /// A name that is not one.
    #[error("{source_name}: there is no {what} {name}{}", suggestion(nearest, otherwise))]
    UnknownName { source_name: String, what: &'static str, name: String, nearest: Vec<String>, otherwise: &'static str },
    /// A value that the name cannot have.
    #[error("{source_name}: {name} {reason}")]
    WrongValue { source_name: String, name: String, reason: String },
    /// Each value could be used, but not all together.
    #[error(transparent)]
    Refused(#[from] ParameterError),
}

impl Error {
    pub(crate) fn toml(source_name: &str, error: &toml::de::Error, remedy: &'static str) -> Self {
        Error::Toml { source_name: source_name.to_owned(), text: error.to_string(), remedy }
    }

    pub(crate) fn wrong_value(source_name: &str, name: &str, reason: String) -> Self {
        Error::WrongValue { source_name: source_name.to_owned(), name: name.to_owned(), reason }
    }
}
