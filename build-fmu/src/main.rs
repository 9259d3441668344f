//! `cargo build-fmu`.

use std::path::PathBuf;
use std::process::ExitCode;

use build_fmu::{FmiVersion, MODELS, Model, Platform, build, workspace};
use clap::Parser;
use clap::builder::PossibleValuesParser;

/// Builds FMUs: compiles each shared library and packs it with its model description and documentation.
///
/// Without options every model's FMU is built for this machine and lands in target/fmu. Where cargo-zigbuild is
/// installed, a library for Linux runs on glibc 2.17 and newer; where it is not, on this machine's glibc and newer. Which
/// it is, is said.
#[derive(Parser)]
#[command(name = "cargo build-fmu", version)]
struct Arguments {
    /// Model to build, or several separated by commas [default: all]
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = model_names())]
    model: Vec<String>,

    /// Version of FMI
    #[arg(long, value_name = "VERSION", default_value = "2")]
    fmi: FmiVersion,

    /// Platforms that the FMUs shall run on, separated by commas [default: this machine's]
    #[arg(long, value_name = "PLATFORMS", value_delimiter = ',')]
    platform: Vec<Platform>,

    /// Directory that the FMUs are written into [default: target/fmu in the workspace]
    #[arg(long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let output = arguments.output.unwrap_or_else(workspace::default_output);
    let chosen = |model: &&Model| arguments.model.is_empty() || arguments.model.iter().any(|name| name == model.name);
    for model in MODELS.iter().filter(chosen) {
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

fn model_names() -> PossibleValuesParser {
    PossibleValuesParser::new(MODELS.iter().map(|model| model.name))
}
