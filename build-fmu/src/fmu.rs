//! The build of an FMU: compile the libraries, check them, pack the archive.

use std::fs;
use std::path::{Path, PathBuf};

use crate::contents::Extras;
use crate::{Error, FmiVersion, FmuModel, Platform, Start};
use crate::{base, compile, library, workspace};

/// An FMU that has been written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Built {
    pub file: PathBuf,
    /// Size of the file \[bytes\].
    pub size: usize,
}

/// Builds a model's FMU with these start values into the directory `output`, which is created if
/// missing, and reports progress line by line.
///
/// Without platforms the FMU is for this machine.
///
/// # Errors
/// A tool that is missing, a library that does not compile or must not be shipped, a file that
/// cannot be written.
pub fn build(
    model: &FmuModel,
    start: &Start,
    fmi: FmiVersion,
    platforms: &[Platform],
    output: &Path,
    report: impl FnMut(&str),
) -> Result<Built, Error> {
    let archive = fmu(model, start, fmi, platforms, report)?;
    let file = output.join(fmi.fmu_file(model.name));
    write_whole(&file, &archive)?;
    Ok(Built { file, size: archive.len() })
}

/// Compiles the libraries of several FMUs, which takes a
/// fraction of the time that they take one after the other in [`build`].
///
/// # Errors
/// A tool that is missing, or a library that does not compile.
pub fn compile_together(libraries: &[(&FmuModel, FmiVersion)], platforms: &[Platform]) -> Result<(), Error> {
    compile::plan(platforms)?.iter().try_for_each(|plan| compile::compile_together(libraries, plan))
}

/// Builds a model's FMU and returns its bytes; otherwise as [`build`].
///
/// # Errors
/// As [`build`], but for the file.
pub fn fmu(
    model: &FmuModel,
    start: &Start,
    fmi: FmiVersion,
    platforms: &[Platform],
    mut report: impl FnMut(&str),
) -> Result<Vec<u8>, Error> {
    let plans = compile::plan(platforms)?;
    let mut libraries = Vec::new();
    for plan in &plans {
        report(&format!("{}: {plan}", plan.platform));
        let bytes = compile::compile(model, fmi, plan)?;
        let paths = workspace::private_paths()?;
        let info = library::examine(&bytes, fmi.functions(), &paths)
            .map_err(|reason| Error::Library { platform: plan.platform, reason })?;
        report(&format!("{}: {info}", plan.platform));
        libraries.push((plan.platform, bytes));
    }
    base::pack(model, start, fmi, libraries, Extras::default())
}

/// Writes a file that others never see half written.
///
/// # Errors
/// The directory or the file cannot be written.
pub fn write_whole(file: &Path, bytes: &[u8]) -> Result<(), Error> {
    let part = file.with_extension(format!("part.{}", std::process::id()));
    let write = || {
        fs::create_dir_all(file.parent().unwrap_or(Path::new(".")))?;
        fs::write(&part, bytes)?;
        fs::rename(&part, file)
    };
    write().map_err(|reason| Error::Write { file: file.to_owned(), reason })
}
