//! `moris`, the command.

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use moris::{parameters, rig, run};

/// The washout's workbench: does this ride fit my rig, how good are the cues, what limits them, which parameters are better?
#[derive(Parser)]
#[command(name = "moris", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    #[command(subcommand)]
    Rig(rig::Command),
    Run(run::Options),
    Parameters(parameters::Options),
}

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Rig(command) => rig::main(&command),
        Command::Run(options) => run::main(&options),
        Command::Parameters(options) => parameters::main(&options),
    };
    match result {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
