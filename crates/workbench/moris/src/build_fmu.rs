//! `moris build-fmu`: an own FMU from an existing one.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use moris_build_fmu::{FormOptions, OwnFmu, StartOptions};

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

    #[command(flatten)]
    form: FormOptions,

    /// Directory for the FMU, which gets its usual name
    #[arg(long, value_name = "DIRECTORY", default_value = "own-fmu")]
    output: PathBuf,
}

/// Makes the FMU and prints where it is.
///
/// # Errors
/// The base or the values cannot be used, or the FMU cannot be written.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    let own = OwnFmu::new(&options.base, &options.start, options.form)?;
    for line in own.notes() {
        writeln!(out, "{line}")?;
    }
    let file = own.write(&options.output)?;
    writeln!(out, "wrote {}", file.display())?;
    Ok(ExitCode::SUCCESS)
}
