//! `cargo build-fmu`.

use std::path::PathBuf;
use std::process::ExitCode;

use build_fmu::{FmiVersion, MODELS, Platform, build, workspace};
use clap::Parser;

/// Builds the FMU: compiles the shared library and packs it with its model description and documentation.
///
/// Without options the FMU is for this machine and lands in target/fmu. Where cargo-zigbuild is installed, a library for
/// Linux runs on glibc 2.17 and newer; where it is not, on this machine's glibc and newer. Which it is, is said.
#[derive(Parser)]
#[command(name = "cargo build-fmu", version)]
struct Arguments {
    /// Version of FMI
    #[arg(long, value_name = "VERSION", default_value = "2")]
    fmi: FmiVersion,

    /// Platforms that the FMU shall run on, separated by commas [default: this machine's]
    #[arg(long, value_name = "PLATFORMS", value_delimiter = ',')]
    platform: Vec<Platform>,

    /// Directory that the FMU is written into [default: target/fmu in the workspace]
    #[arg(long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let output = arguments.output.unwrap_or_else(workspace::default_output);
    for model in MODELS {
        match build(model, arguments.fmi, &arguments.platform, &output, |line| println!("{line}")) {
            Ok(built) => println!("wrote {} ({} kB)", built.file.display(), built.size.div_ceil(1000)),
            Err(error) => {
                eprintln!("error: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}
