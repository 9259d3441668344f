//! Errors of building an FMU.

use std::io;
use std::path::PathBuf;

use moris_interface::ParameterError;

use crate::Platform;
use crate::library::LibraryError;

/// Errors of building an FMU, with the remedy.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A tool for the platform is missing.
    #[error("{platform} needs {what}, which is not installed; install it with: {install}")]
    Missing { platform: Platform, what: &'static str, install: String },
    /// A tool for sources in C is missing.
    #[error("sources in C need {what}, which is not installed; install it with: {install}")]
    MissingForSources { what: String, install: String },
    /// The model could not be turned into sources in C.
    #[error("the sources in C cannot be made: {reason}")]
    Sources { reason: String },
    /// A program could not be started.
    #[error("cannot run {program}: {reason}")]
    Run { program: String, reason: io::Error },
    /// The compiler failed and printed the reason.
    #[error("the library for {platform} did not compile; the compiler's messages are above")]
    Compile { platform: Platform },
    /// FMI has no platform name for this machine.
    #[error("FMI has no platform name for this machine; choose a platform with --platform")]
    NoHostPlatform,
    /// The library compiled, but is unfit to ship.
    #[error(
        "the library for {platform} must not be shipped: {reason}; build it with cargo build-fmu from a clean checkout"
    )]
    Library { platform: Platform, reason: LibraryError },
    /// A file that should be there cannot be read.
    #[error("cannot read {}: {reason}", file.display())]
    Read { file: PathBuf, reason: io::Error },
    /// A library cannot take start values.
    #[error("the library for {platform} has no place for start values of this model's variables")]
    NoPlace { platform: Platform },
    /// An FMU cannot be the base of another.
    #[error("{} {reason}", file.display())]
    Base { file: PathBuf, reason: String },
    /// The model rejects the start values.
    #[error("{model} cannot start with these values: {error}")]
    Start { model: &'static str, error: ParameterError },
    /// A path file cannot be used.
    #[error("the path {} {reason}", file.display())]
    Path { file: PathBuf, reason: String },
    /// The option applies to none of the models.
    #[error("--{option} applies to none of the chosen models ({who}); choose other models, or omit it")]
    NotApplicable { option: &'static str, who: &'static str },
    /// Array variables need a version of FMI that has them.
    #[error("--arrays needs --fmi 3: FMI 2.0 has no array variables")]
    NoArrays,
    /// Only one version of FMI is offered with reals alone.
    #[error("--reals-only needs --fmi 2 and no --arrays: hosts that know only reals read FMI 2.0")]
    NoReals,
    /// A rig or parameter file cannot be used.
    #[error(transparent)]
    Setup(#[from] moris_setup::Error),
    /// The archive cannot be written.
    #[error("cannot pack the archive: {0}")]
    Archive(#[from] zip::result::ZipError),
    /// The FMU cannot be written.
    #[error("cannot write {}: {reason}", file.display())]
    Write { file: PathBuf, reason: io::Error },
}
