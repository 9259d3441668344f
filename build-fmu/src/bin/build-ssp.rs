//! `cargo build-ssp`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use clap::builder::PossibleValuesParser;
use moris_build_fmu::ssp::{Form, SYSTEMS, System, Vehicle};
use moris_build_fmu::{Platform, workspace};

/// Builds a package of connected FMUs with their parameters.
///
/// MotorcycleSimulator.ssp is a motorcycle with its rider, the washout filter and the platform.
/// MotorcycleLap.ssp is the same on a lap: the motorcycle follows it by itself, and the washout
/// receives a preview of it.
///
/// Without options the FMUs are for this machine, and the package is written to target/fmu.
#[derive(Parser)]
#[command(name = "cargo build-ssp", version)]
struct Arguments {
    /// System to build
    #[arg(long, value_name = "NAME", default_value = SYSTEMS[0].name, value_parser = system_names())]
    system: String,

    /// Build the form .flat.ssp, without connectors of the system and with a parameter set for each
    /// component, for Ecos and libcosim
    #[arg(long)]
    flat: bool,

    /// Vehicle's FMU (FMI 2.0) in the place of the motorcycle: the package is OwnVehicle.ssp, in
    /// the form of --flat. Its outputs go to the washout's inputs of the same name
    #[arg(long, value_name = "FILE", conflicts_with = "system")]
    vehicle: Option<PathBuf>,

    /// Output of the vehicle, and the washout's input that it goes to, such as
    /// --connect acc_x=vehicle.specificForce.x. May be given several times
    #[arg(long, value_name = "OUTPUT=INPUT", requires = "vehicle")]
    connect: Vec<String>,

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
    let is_named = |system: &&&System| system.name == arguments.system;
    let system = SYSTEMS.iter().find(is_named).expect("names of systems are checked");
    let report = |line: &str| println!("{line}");
    let built = match &arguments.vehicle {
        None => system.build(form, &arguments.platform, &output, report),
        Some(file) => Vehicle::open(file, &arguments.connect).and_then(|vehicle| {
            vehicle.connections.iter().for_each(|line| report(line));
            System::with_vehicle(vehicle, &arguments.platform, &output, report)
        }),
    };
    match built {
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

fn system_names() -> PossibleValuesParser {
    PossibleValuesParser::new(SYSTEMS.iter().map(|system| system.name))
}
