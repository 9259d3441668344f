//! `moris build-fmu`: an own FMU from an existing one.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Result, bail};
use moris_build_fmu::{Base, StartOptions, write_whole};

/// Make an FMU that starts with your rig and parameters from an existing one,
/// for every platform in it
///
/// Nothing is compiled. The base is an FMU of this program's release; start values
/// that it has are replaced.
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    /// FMU of the washout, the motorcycle or the platform
    #[arg(long, value_name = "FILE.fmu")]
    base: PathBuf,

    #[command(flatten)]
    start: StartOptions,

    /// Directory for the FMU, which gets its usual name
    #[arg(long, value_name = "DIRECTORY", default_value = "own-fmu")]
    output: PathBuf,
}

/// Makes the FMU and prints where it is.
///
/// # Errors
/// The base or the values cannot be used, or the FMU cannot be written.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    let file = pack(&options.base, &options.start, &options.output, out)?;
    writeln!(out, "wrote {}", file.display())?;
    Ok(ExitCode::SUCCESS)
}

/// Makes an FMU from a base and tells of its start values. Returns the FMU's file.
///
/// # Errors
/// As [`main`].
pub fn pack(base_file: &Path, options: &StartOptions, output: &Path, out: &mut dyn Write) -> Result<PathBuf> {
    let base = Base::open(base_file)?;
    let model = base.model;
    let start = options.of_models(&[model])?.remove(0);
    let platforms: Vec<String> = base.platforms().map(|platform| platform.to_string()).collect();
    writeln!(out, "{}: {} start values of your own, for {}", model.name, start.count(), platforms.join(", "))?;
    for warning in (model.functions.warnings)(start.slots()) {
        writeln!(out, "warning: {warning}")?;
    }
    let file = output.join(base.fmi.fmu_file(model.name));
    if file.canonicalize().is_ok_and(|file| base_file.canonicalize().is_ok_and(|base| base == file)) {
        bail!("{} is the base; choose another directory with --output", file.display());
    }
    write_whole(&file, &base.pack(&start)?)?;
    Ok(file)
}
