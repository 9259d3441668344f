//! `cargo build-fmu`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use clap::builder::PossibleValuesParser;
use moris_build_fmu::model::{MOTORCYCLE, WASHOUT, path_values};
use moris_build_fmu::{Error, FmiVersion, FmuModel, MODELS, Platform, Start, build, compile_together, workspace};
use moris_setup::{NamedValues, load_rig, load_set};

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

    /// Rig file to embed, in the FMUs of models with a rig
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,

    /// Parameter file, or preset (motorcycle, car, ...), to embed in the washout's FMU; in another
    /// model's if --model names that one alone. May be given several times: later ones override
    /// earlier ones, and all of them the rig
    #[arg(long, value_name = "FILE|NAME")]
    parameters: Vec<String>,

    /// CSV file of a path (distance, curvature, speed) that the motorcycle's FMU rides
    #[arg(long, value_name = "FILE")]
    path: Option<PathBuf>,

    /// Directory for the FMUs [default: target/fmu in the workspace]
    #[arg(long, value_name = "DIRECTORY")]
    output: Option<PathBuf>,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let output = arguments.output.clone().unwrap_or_else(workspace::default_output);
    let chosen =
        |model: &&FmuModel| arguments.model.is_empty() || arguments.model.iter().any(|name| name == model.name);
    let models: Vec<&FmuModel> = MODELS.iter().filter(chosen).collect();
    let versions = fmi_versions(arguments)?;
    // Before anything is compiled.
    check_used(arguments, &models)?;
    let start = |model: &&FmuModel| Start::with(model, &start_values(arguments, model)?);
    let starts = models.iter().map(start).collect::<Result<Vec<_>, _>>()?;
    let of_version = |fmi| models.iter().zip(&starts).map(move |(&model, start)| (model, start, fmi));
    let fmus: Vec<(&FmuModel, &Start, FmiVersion)> = versions.into_iter().flat_map(of_version).collect();
    let own = fmus.iter().filter(|(_, start, _)| start.is_own()).map(|&(model, _, fmi)| (model, fmi));
    compile_together(&own.collect::<Vec<_>>(), &arguments.platform)?;
    for (model, start, fmi) in fmus {
        if !start.is_own() {
            println!("{}: {} embedded start values", model.name, start.count());
            for warning in (model.functions.warnings)(start.slots()) {
                eprintln!("warning: {}: {warning}", model.name);
            }
        }
        let report = |line: &str| println!("{line}");
        let built = build(model, start, fmi, &arguments.platform, &output, report)?;
        println!("wrote {} ({} kB)", built.file.display(), built.size.div_ceil(1000));
    }
    Ok(())
}

/// The versions of FMI, with or without arrays.
fn fmi_versions(arguments: &Arguments) -> Result<Vec<FmiVersion>, Error> {
    let with_arrays = |fmi: &FmiVersion| fmi.with_arrays().ok_or(Error::NoArrays);
    if arguments.arrays { arguments.fmi.iter().map(with_arrays).collect() } else { Ok(arguments.fmi.clone()) }
}

/// Checks that each option with start values applies to one of the models.
fn check_used(arguments: &Arguments, models: &[&FmuModel]) -> Result<(), Error> {
    if arguments.rig.is_some() && !models.iter().any(|model| model.has_rig()) {
        return Err(Error::NotApplicable { option: "rig", who: "only models with a platform have a rig" });
    }
    if arguments.path.is_some() && !models.iter().any(|model| model.name == MOTORCYCLE.name) {
        return Err(Error::NotApplicable { option: "path", who: "only the motorcycle follows one" });
    }
    if !arguments.parameters.is_empty() && !models.iter().any(|model| accepts_parameters(arguments, model)) {
        let who = "with several models they are the washout's; choose another model alone with --model";
        return Err(Error::NotApplicable { option: "parameters", who });
    }
    Ok(())
}

/// Parameters are the washout's, or those of a model that is chosen alone.
fn accepts_parameters(arguments: &Arguments, model: &FmuModel) -> bool {
    arguments.model.len() == 1 || model.name == WASHOUT.name
}

/// Start values that replace a model's own: the rig where it has one, and over it the parameters
/// where they are its own.
fn start_values(arguments: &Arguments, model: &FmuModel) -> Result<NamedValues, Error> {
    let mut values = NamedValues::new();
    if let Some(file) = arguments.rig.as_ref().filter(|_| model.has_rig()) {
        values.extend(load_rig(file)?.values());
    }
    if let Some(file) = arguments.path.as_ref().filter(|_| model.name == MOTORCYCLE.name) {
        values.extend(path_values(file)?);
    }
    if accepts_parameters(arguments, model) {
        for set in &arguments.parameters {
            values.extend(load_set(set, model.functions.identity.rows)?);
        }
    }
    Ok(values)
}

fn model_names() -> PossibleValuesParser {
    PossibleValuesParser::new(MODELS.iter().map(|model| model.name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error_of(arguments: &[&str]) -> Option<String> {
        let arguments = Arguments::parse_from([&["build-fmu"], arguments].concat());
        let chosen =
            |model: &&FmuModel| arguments.model.is_empty() || arguments.model.iter().any(|name| name == model.name);
        let models: Vec<&FmuModel> = MODELS.iter().filter(chosen).collect();
        check_used(&arguments, &models).err().map(|error| error.to_string())
    }

    #[test]
    fn values_that_no_chosen_model_takes_are_refused() {
        let refused = error_of(&["--model", "Motorcycle", "--rig", "rig.toml"]).unwrap();
        assert!(refused.contains("--rig applies to none") && refused.contains("--model"), "{refused}");
        let refused = error_of(&["--model", "StewartPlatform", "--path", "bend.csv"]).unwrap();
        assert!(refused.contains("--path applies to none"), "{refused}");
        let refused = error_of(&["--model", "Motorcycle,StewartPlatform", "--parameters", "mine.toml"]).unwrap();
        assert!(refused.contains("--parameters applies to none"), "{refused}");
    }

    #[test]
    fn values_that_one_of_the_models_takes_are_not() {
        assert_eq!(error_of(&["--rig", "rig.toml", "--parameters", "small-motions"]), None);
        assert_eq!(error_of(&["--model", "Motorcycle", "--parameters", "mine.toml"]), None);
        assert_eq!(error_of(&["--model", "Motorcycle,StewartPlatform", "--rig", "rig.toml"]), None);
    }

    #[test]
    fn a_path_becomes_start_values_of_the_motorcycle_alone() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../crates/simulator/motorcycle/paths/hairpin.csv");
        let arguments = Arguments::parse_from(["build-fmu", "--path", file]);
        let values = start_values(&arguments, &MOTORCYCLE).unwrap();
        let value = |name: &str| values.iter().find(|(known, _)| known == name).unwrap().1;
        assert_eq!((value("path.course"), value("path.point.count")), (2.0, 6.0));
        assert_eq!(value("path.point.distance[2]"), 150.0);
        assert!(Start::with(&MOTORCYCLE, &values).is_ok());
        assert_eq!(start_values(&arguments, &WASHOUT).unwrap(), []);
        let missing = Arguments::parse_from(["build-fmu", "--path", "no-such.csv"]);
        assert!(start_values(&missing, &MOTORCYCLE).unwrap_err().to_string().contains("no-such.csv"));
    }

    #[test]
    fn arrays_are_for_fmi_3() {
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
    }
}
