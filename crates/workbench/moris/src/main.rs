//! `moris`, the command.

use std::ffi::OsString;
use std::io::stdout;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use moris::{
    bench, build_fmu, fit, frequency_response, help, measure, parameters, ride, rig, schema, sibling, simulate, tune,
};
use moris_command_line::exit_status;

/// Workbench of the washout: simulate recordings on a rig, measure cue quality, tune parameters
#[derive(Parser)]
#[command(name = "moris", version = moris::PACKAGE_VERSION)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    #[command(subcommand)]
    Rig(rig::Command),
    #[command(alias = "run")]
    Simulate(simulate::Options),
    Measure(measure::Options),
    Fit(fit::Options),
    Bench(bench::Options),
    Ride(ride::Options),
    /// Step the washout beside a running vehicle, and command a platform: the program moris-live
    #[command(disable_help_flag = true)]
    Live {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "ARGUMENT")]
        arguments: Vec<OsString>,
    },
    Tune(tune::Options),
    #[command(alias = "respond")]
    FrequencyResponse(frequency_response::Options),
    Parameters(parameters::Options),
    BuildFmu(build_fmu::Options),
    Schema(schema::Options),
    Completions(help::CompletionOptions),
    Man(help::ManOptions),
}

fn main() -> ExitCode {
    let out = &mut stdout();
    let result = match Arguments::parse().command {
        Command::Rig(command) => rig::main(&command, out),
        Command::Simulate(options) => simulate::main(&options, out),
        Command::Measure(options) => measure::main(&options, out),
        Command::Fit(options) => fit::main(&options, out),
        Command::Bench(options) => bench::main(&options, out),
        Command::Ride(options) => ride::main(&options, out),
        Command::Live { arguments } => sibling::run("moris-live", &arguments),
        Command::Tune(options) => tune::main(&options, out),
        Command::FrequencyResponse(options) => frequency_response::main(&options, out),
        Command::Parameters(options) => parameters::main(&options, out),
        Command::BuildFmu(options) => build_fmu::main(&options, out),
        Command::Schema(options) => schema::main(&options, out),
        Command::Completions(options) => help::completions(&options, Arguments::command(), out),
        Command::Man(options) => help::man_pages(&options, Arguments::command(), out),
    };
    exit_status(result, out)
}
