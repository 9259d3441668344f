//! The hunter's command.

use std::fs::File;
use std::io::{BufWriter, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::{Parser, ValueEnum};
use moris_fmu_tests::hunter::episode::Episode;
use moris_fmu_tests::hunter::run::Runner;
use moris_fmu_tests::hunter::search::{Failure, FoundEpisode, Plan, Summary, search};
use moris_fmu_tests::hunter::target::{CrateTarget, FmuTarget, Target, Traced};
use moris_fmu_tests::hunter::variables::Variables;

/// Search for a machine, inputs and parameter changes with which the washout breaks a limit.
///
/// Random machines are driven by hostile inputs and previews, with tunable parameters changed in
/// flight, irregular steps and states rolled back. Some attackers look ahead for the worst inputs.
/// The outputs alone are judged. At rest the platform has to come home. What breaks a limit is
/// shrunk to a short episode and printed. Exit status: 0 without a breach, 1 with one, 2 when the
/// search cannot be made.
#[derive(Parser)]
#[command(name = "hunter", version)]
struct Arguments {
    /// Communication steps to make, as 2000000 or 2e6
    #[arg(long, value_name = "N", default_value = "1e7", value_parser = count)]
    steps: u64,

    /// Seed of the search; the same seed searches the same machines
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,

    /// Threads that search
    #[arg(long, value_name = "N", default_value_t = threads())]
    threads: usize,

    /// Machines to look at, at most
    #[arg(long, value_name = "N", default_value = "1e18", value_parser = count)]
    machines: u64,

    /// Number of the first machine
    #[arg(long, value_name = "N", default_value_t = 0)]
    first_machine: u64,

    /// Target of the search: the crate, or the C functions of the FMU
    #[arg(long, value_enum, default_value_t = Through::Crate)]
    through: Through,

    /// FMU or shared library for --through fmu [default: the library beside this command]
    #[arg(long, value_name = "FILE")]
    library: Option<PathBuf>,

    /// Breaches after which the search ends
    #[arg(long, value_name = "N", default_value_t = 1)]
    breaches: usize,

    /// Directory for a file of each episode found
    #[arg(long, value_name = "DIR")]
    save: Option<PathBuf>,

    /// File for the summary, as JSON
    #[arg(long, value_name = "FILE")]
    summary: Option<PathBuf>,

    /// Leave what is found as it is
    #[arg(long)]
    no_shrink: bool,

    /// Repeat an episode from a file instead of searching
    #[arg(long, value_name = "FILE")]
    replay: Option<PathBuf>,

    /// File for a table of all outputs of --replay, as CSV
    #[arg(long, value_name = "FILE", requires = "replay")]
    trace: Option<PathBuf>,
}

/// Target of the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Through {
    Crate,
    Fmu,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match &arguments.replay {
        Some(file) => replay(&arguments, file),
        None => hunt(&arguments),
    };
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

/// Searches. True without a breach.
fn hunt(arguments: &Arguments) -> Result<bool> {
    let plan = Plan {
        seed: arguments.seed,
        first_machine: arguments.first_machine,
        steps: arguments.steps,
        machines: arguments.machines,
        breaches: arguments.breaches.max(1),
        threads: arguments.threads.max(1),
        shrink: !arguments.no_shrink,
    };
    eprintln!("hunting with seed {}: {} steps on {} threads", plan.seed, plan.steps, plan.threads);
    let shows_progress = std::io::stderr().is_terminal();
    let mut printed = 0;
    let mut progress = |summary: &Summary| {
        for (number, found) in summary.found.iter().enumerate().skip(printed) {
            eprintln!();
            if let Err(error) = report(arguments, number, found) {
                eprintln!("error: {error:#}");
            }
        }
        printed = summary.found.len();
        if shows_progress {
            eprint!("\r{}   ", line(summary));
            _ = std::io::stderr().flush();
        }
    };
    let summary = match arguments.through {
        Through::Crate => search(&plan, || Ok(CrateTarget::default()), &mut progress)?,
        Through::Fmu => {
            let library = library(arguments)?;
            search(&plan, || FmuTarget::open(&library, &Variables::new()), &mut progress)?
        }
    };
    progress(&summary);
    if shows_progress {
        eprintln!();
    }
    if let Some(file) = &arguments.summary {
        let text = serde_json::to_string_pretty(&summary)?;
        std::fs::write(file, text).with_context(|| format!("writing {}", file.display()))?;
    }
    println!("{}", line(&summary));
    println!("largest ratios to the limits (positions: excess in units of the tolerance):");
    for (quantity, ratio) in &summary.worst {
        println!("  {quantity:28} {ratio:.9}");
    }
    Ok(summary.found.is_empty())
}

/// A search in a line.
fn line(summary: &Summary) -> String {
    let Summary { seed, machines, refused_machines, episodes, steps, seconds, found, .. } = summary;
    format!(
        "seed {seed}: {steps} steps in {seconds:.0} s, {episodes} episodes on {machines} machines ({refused_machines} \
         refused), {} breaches",
        found.len()
    )
}

/// Prints what was found, and keeps it in a file if --save is given.
fn report(arguments: &Arguments, number: usize, found: &FoundEpisode) -> Result<()> {
    match &found.failure {
        Failure::Breach(breach) => println!("BREACH {breach}; found after {} steps", found.found_after),
        Failure::Refused(reason) => println!("FAILURE: {reason}"),
    }
    let text = found.episode.to_toml()?;
    println!("--- episode, for --replay FILE ---\n{text}---");
    if let Some(directory) = &arguments.save {
        std::fs::create_dir_all(directory).with_context(|| format!("creating {}", directory.display()))?;
        let file = directory.join(format!("breach-{}-{number}.toml", arguments.seed));
        let heading = format!("# {:?}\n", found.failure).replace('\n', " ") + "\n";
        std::fs::write(&file, heading + &text).with_context(|| format!("writing {}", file.display()))?;
        println!("saved as {}", file.display());
    }
    Ok(())
}

/// Repeats an episode. True without a breach.
fn replay(arguments: &Arguments, file: &Path) -> Result<bool> {
    let text = moris_fmu_host::files::text(file, moris_fmu_host::files::MAX_TEXT_SIZE)
        .with_context(|| format!("reading {}", file.display()))?;
    let episode = Episode::from_toml(&text)?;
    match arguments.through {
        Through::Crate => replay_on(arguments, &episode, CrateTarget::default()),
        Through::Fmu => replay_on(arguments, &episode, FmuTarget::open(&library(arguments)?, &Variables::new())?),
    }
}

fn replay_on(arguments: &Arguments, episode: &Episode, target: impl Target) -> Result<bool> {
    let Some(file) = &arguments.trace else { return repeat(episode, target) };
    let out = File::create(file).with_context(|| format!("creating {}", file.display()))?;
    repeat(episode, Traced::new(target, BufWriter::new(out))?)
}

fn repeat(episode: &Episode, mut target: impl Target) -> Result<bool> {
    let runner = Runner::new()?;
    runner.make(&episode.parameters, &mut target)?;
    let outcome = runner.run(episode, &mut target)?;
    match outcome.breach {
        Some(breach) => println!("BREACH {breach}"),
        None => println!("no breach in {} steps", outcome.steps),
    }
    Ok(outcome.breach.is_none())
}

/// The shared library to drive.
fn library(arguments: &Arguments) -> Result<PathBuf> {
    if let Some(library) = &arguments.library {
        return Ok(library.clone());
    }
    let name = format!("{}MorisWashout{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let library = std::env::current_exe()?.with_file_name(name);
    anyhow::ensure!(
        library.is_file(),
        "{} is missing: build it with `cargo build --release --package moris-washout-fmi2`, or give --library",
        library.display()
    );
    Ok(library)
}

fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// A count, as a whole number or as 2e6.
fn count(text: &str) -> Result<u64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 1.0 && value.fract() == 0.0 && value <= u64::MAX as f64 => Ok(value as u64),
        _ => Err("a whole number above 0, as 2000000 or 2e6".to_owned()),
    }
}
