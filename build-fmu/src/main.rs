//! `cargo build-fmu`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use clap::builder::PossibleValuesParser;
use moris_build_fmu::{
    Base, Error, FMU_MODELS, FmiVersion, FmuModel, FormOptions, Platform, Sources, Start, StartOptions, build,
    compile_together, workspace, write_whole,
};

/// Builds FMUs: compiles each shared library and packs it with its model description and
/// documentation.
///
/// Without options every model's FMU is built for this machine and lands in target/fmu. A library
/// for Linux runs on glibc 2.17 and newer.
///
/// --rig and --parameters embed a rig and parameters as start values in place of the models' own.
#[derive(Parser)]
#[command(name = "cargo build-fmu", version)]
struct Arguments {
    /// Model to build, or several separated by commas [default: all]
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = model_names())]
    model: Vec<String>,

    /// Version of FMI, or both separated by a comma
    #[arg(long, value_name = "VERSION", value_delimiter = ',', default_value = "2")]
    fmi: Vec<FmiVersion>,

    /// Describe vectors as array variables (FMI 3.0 only), for tools that support them
    #[arg(long)]
    arrays: bool,

    /// Platforms of the FMUs, separated by commas [default: this machine's]
    #[arg(long, value_name = "PLATFORMS", value_delimiter = ',')]
    platform: Vec<Platform>,

    /// Add sources in C, for tools that compile FMUs themselves; needs wasm2c 1.0.32 of WABT
    #[arg(long)]
    sources: bool,

    #[command(flatten)]
    form: FormOptions,

    #[command(flatten)]
    start: StartOptions,

    /// Directory for the FMUs [default: target/fmu in the workspace]
    #[arg(long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

fn main() -> ExitCode {
    match run_arguments(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run_arguments(arguments: &Arguments) -> Result<(), Error> {
    let output = arguments.output.clone().unwrap_or_else(workspace::default_output);
    let chosen =
        |model: &&FmuModel| arguments.model.is_empty() || arguments.model.iter().any(|name| name == model.name);
    let models: Vec<&FmuModel> = FMU_MODELS.iter().filter(chosen).collect();
    let versions = fmi_versions(arguments)?;
    // Before anything is compiled.
    let starts = arguments.start.of_models(&models)?;
    let of_version = |fmi| models.iter().zip(&starts).map(move |(&model, start)| (model, start, fmi));
    let fmus: Vec<(&FmuModel, &Start, FmiVersion)> = versions.into_iter().flat_map(of_version).collect();
    let libraries: Vec<(&FmuModel, FmiVersion)> = fmus.iter().map(|&(model, _, fmi)| (model, fmi)).collect();
    compile_together(&libraries, &arguments.platform)?;
    for (model, start, fmi) in fmus {
        if !start.is_own() {
            println!("{}: {} embedded start values", model.name, start.count());
            for warning in (model.functions.warnings)(start.slots()) {
                eprintln!("warning: {}: {warning}", model.name);
            }
        }
        let report = |line: &str| println!("{line}");
        let mut built = build(model, start, fmi, &arguments.platform, &output, report)?;
        if arguments.sources || arguments.form.terminals {
            let mut base = Base::open(&built.file)?.in_form(arguments.form)?;
            if arguments.sources {
                base = base.with_sources(Sources::make(model, fmi)?);
            }
            let archive = base.pack(start)?;
            write_whole(&built.file, &archive)?;
            built.size = archive.len();
        }
        println!("wrote {} ({} kB)", built.file.display(), built.size.div_ceil(1000));
    }
    Ok(())
}

/// The versions of FMI, with or without arrays, or with reals only.
fn fmi_versions(arguments: &Arguments) -> Result<Vec<FmiVersion>, Error> {
    let in_form = |&fmi: &FmiVersion| {
        let fmi = if arguments.arrays { fmi.with_arrays().ok_or(Error::NoArrays)? } else { fmi };
        arguments.form.of(fmi)
    };
    arguments.fmi.iter().map(in_form).collect()
}

fn model_names() -> PossibleValuesParser {
    PossibleValuesParser::new(FMU_MODELS.iter().map(|model| model.name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_are_for_fmi_3_and_reals_only_for_fmi_2() {
        let files = |arguments: &[&str]| -> Result<Vec<String>, Error> {
            let versions = fmi_versions(&Arguments::parse_from([&["build-fmu"], arguments].concat()))?;
            Ok(versions.iter().map(|fmi| fmi.fmu_file("Model")).collect())
        };
        assert_eq!(files(&["--fmi", "3", "--arrays"]).unwrap(), ["Model.fmi3.arrays.fmu"]);
        assert_eq!(files(&["--fmi", "3"]).unwrap(), ["Model.fmi3.fmu"]);
        assert_eq!(files(&["--fmi", "2,3"]).unwrap(), ["Model.fmu", "Model.fmi3.fmu"]);
        assert_eq!(files(&[]).unwrap(), ["Model.fmu"]);
        for wrong in [&["--arrays"][..], &["--fmi", "2,3", "--arrays"]] {
            assert!(files(wrong).unwrap_err().to_string().contains("--fmi 3"));
        }
        assert_eq!(files(&["--reals-only"]).unwrap(), ["Model.reals.fmu"]);
        for wrong in [&["--reals-only", "--fmi", "2,3"][..], &["--reals-only", "--fmi", "3", "--arrays"]] {
            assert!(files(wrong).unwrap_err().to_string().contains("--fmi 2"));
        }
    }
}
