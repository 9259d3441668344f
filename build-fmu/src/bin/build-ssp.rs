//! `cargo build-ssp`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use moris_build_fmu::ssp::{self, Form, MOTORCYCLE_SIMULATOR};
use moris_build_fmu::{Platform, workspace};

/// Builds MotorcycleSimulator.ssp: motorcycle, washout filter and platform as FMUs, connected, with
/// their parameters.
///
/// Without options the FMUs are for this machine, and the package is written to target/fmu.
#[derive(Parser)]
#[command(name = "cargo build-ssp", version)]
struct Arguments {
    /// Build MotorcycleSimulator.flat.ssp, without inputs of the system and with a parameter set
    /// for each component, for Ecos and libcosim
    #[arg(long)]
    flat: bool,

    /// Platforms of the FMUs, separated by commas [default: this machine's]
    #[arg(long, value_name = "PLATFORMS", value_delimiter = ',')]
    platform: Vec<Platform>,

    /// Directory for the package [default: target/fmu in the workspace]
    #[arg(long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let output = arguments.output.unwrap_or_else(workspace::default_output);
    let form = if arguments.flat { Form::Flat } else { Form::Whole };
    match ssp::build(&MOTORCYCLE_SIMULATOR, form, &arguments.platform, &output, |line| println!("{line}")) {
        Ok(built) => {
            println!("wrote {} ({} kB)", built.file.display(), built.size.div_ceil(1000));
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
