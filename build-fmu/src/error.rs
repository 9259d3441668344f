//! Why an FMU could not be built.

use std::io;
use std::path::PathBuf;

use moris_interface::Refusal;

use crate::Platform;
use crate::library::Flaw;

/// Why an FMU could not be built, in words that say what to do.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A tool that the platform's compilation needs is not there.
    #[error("{platform} needs {what}, which is not installed; install it with: {install}")]
    Missing { platform: Platform, what: &'static str, install: String },
    /// A program could not be started.
    #[error("cannot run {program}: {reason}")]
    Run { program: String, reason: io::Error },
    /// The compiler has failed; it has said why.
    #[error("the library for {platform} did not compile: see above")]
    Compile { platform: Platform },
    /// No platform of FMI is the machine on which this runs.
    #[error("FMI has no name for this machine; say which platform to build for with --platform")]
    NoHostPlatform,
    /// The library compiled, but is not one to ship.
    #[error("the library for {platform} is not fit to be shipped: {flaw}")]
    Library { platform: Platform, flaw: Flaw },
    /// A file that should be there cannot be read.
    #[error("cannot read {}: {reason}", file.display())]
    Read { file: PathBuf, reason: io::Error },
    /// The parameters of a system name what there is not.
    #[error("the system's parameters cannot be used: {reason}")]
    Parameters { reason: String },
    /// The model cannot start with the values that it was to be given.
    #[error("{model} cannot start with these values: {refusal}")]
    Start { model: &'static str, refusal: Refusal },
    /// None of the models that are to be built takes what was given.
    #[error(
        "--{option} would do nothing: none of the models to build takes it ({who}); choose others with --model, or leave it out"
    )]
    NotTaken { option: &'static str, who: &'static str },
    /// Array variables were asked for in a version of FMI without them.
    #[error("--arrays needs --fmi 3: FMI 2.0 has no array variables")]
    NoArrays,
    /// A rig or parameter file cannot be used.
    #[error("{0}")]
    Setup(#[from] moris_setup::Error),
    /// The archive cannot be made.
    #[error("cannot pack the archive: {0}")]
    Archive(#[from] zip::result::ZipError),
    /// The FMU cannot be written.
    #[error("cannot write {}: {reason}", file.display())]
    Write { file: PathBuf, reason: io::Error },
}
