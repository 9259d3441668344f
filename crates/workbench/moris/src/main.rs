//! `moris`, the command.

use std::io::{ErrorKind, Write, stderr, stdout};
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use moris::{
    bench, build_fmu, fit, frequency_response, help, live, measure, parameters, ride, rig, schema, simulate, tune,
    words, worst_case,
};

/// Workbench of the washout: simulate recordings on a rig, measure cue quality, tune parameters
#[derive(Parser)]
#[command(name = "moris", version = moris::VERSION)]
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
    Live(live::Options),
    WorstCase(worst_case::Options),
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
        Command::Live(options) => live::main(&options, out),
        Command::WorstCase(options) => worst_case::main(&options, out),
        Command::Tune(options) => tune::main(&options, out),
        Command::FrequencyResponse(options) => frequency_response::main(&options, out),
        Command::Parameters(options) => parameters::main(&options, out),
        Command::BuildFmu(options) => build_fmu::main(&options, out),
        Command::Schema(options) => schema::main(&options, out),
        Command::Completions(options) => help::completions(&options, Arguments::command(), out),
        Command::Man(options) => help::man_pages(&options, Arguments::command(), out),
    };
    match result.and_then(|code| Ok(out.flush().map(|()| code)?)) {
        Ok(code) => code,
        Err(error) if nobody_reads_on(&error) => ExitCode::SUCCESS,
        Err(error) => {
            // The reader may be gone.
            let _ = writeln!(stderr(), "error: {}", shortened(&with_causes(&error)));
            ExitCode::FAILURE
        }
    }
}

/// The error and its causes; a cause that the text before it has said is left out.
fn with_causes(error: &anyhow::Error) -> String {
    let mut text = String::new();
    for cause in error.chain().map(words::error) {
        if !text.contains(cause.trim_end()) {
            text += if text.is_empty() { "" } else { ": " };
            text += &cause;
        }
    }
    text
}

/// The text with its lines cut at a length: some errors quote a line of a file.
fn shortened(text: &str) -> String {
    const LONGEST: usize = 2000;
    let cut = |line: &str| match line.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{} ...", &line[..end]),
        None => line.to_owned(),
    };
    text.lines().map(cut).collect::<Vec<_>>().join("\n")
}

/// True if the reader of the output, such as `head`, has closed it.
fn nobody_reads_on(error: &anyhow::Error) -> bool {
    error.downcast_ref::<std::io::Error>().is_some_and(|error| error.kind() == ErrorKind::BrokenPipe)
}
