//! The washout's FMU: built for this machine, and opened.

use std::path::Path;

use anyhow::{Context, Result};
use moris_build_fmu::{FmiVersion, Start, model, workspace};
use moris_fmu_host::Fmu;

/// Builds the FMU as `cargo build-fmu` does, with progress on standard error, and opens it.
///
/// # Errors
/// The FMU cannot be built or opened.
pub fn built() -> Result<Fmu> {
    let (model, output) = (&model::WASHOUT, workspace::default_output());
    let report = |line: &str| eprintln!("{line}");
    let built = moris_build_fmu::build(model, &Start::own(model), FmiVersion::Fmi2, &[], &output, report)?;
    eprintln!("{}\n", built.file.display());
    open(&built.file)
}

/// Opens an FMU.
///
/// # Errors
/// There is none at this path.
pub fn open(path: &Path) -> Result<Fmu> {
    Fmu::open(path).with_context(|| format!("cannot open {}", path.display()))
}
