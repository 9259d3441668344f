//! Errors of loading and running an FMU.

use std::path::PathBuf;

use crate::api::Status;

/// Why an FMU could not be used.
#[derive(Debug, thiserror::Error)]
pub enum HostError {
    #[error("cannot read {path}", path = path.display())]
    File { path: PathBuf, source: std::io::Error },
    #[error("cannot unpack {path}", path = path.display())]
    Archive { path: PathBuf, source: crate::files::ArchiveError },
    #[error("modelDescription.xml: {0}")]
    Description(String),
    #[error("the FMU has no shared library for this platform, {0}")]
    NoBinary(String),
    #[error("cannot load {path}", path = path.display())]
    Library { path: PathBuf, source: libloading::Error },
    #[error("the FMU cannot be instantiated: {0}")]
    Instantiate(String),
    #[error("the FMU has no variable '{0}' that can be got and set as a number")]
    NoSuchVariable(String),
    /// A call that did not end with [`Status::Ok`], with the FMU's message.
    #[error("{function} returned {status:?}: {messages}")]
    Call { function: &'static str, status: Status, messages: String },
}
