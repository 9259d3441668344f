//! `cargo paper-runs`: builds the FMU, simulates the paper's runs, prints the errors, draws the
//! figures.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Parser;
use moris_build_fmu::workspace;
use moris_fmu_host::Fmu;
use moris_paper_runs::curves::write_curves;
use moris_paper_runs::figures::{write_figures, write_strategies};
use moris_paper_runs::fmu::{built, open};
use moris_paper_runs::parameter_set::{PAPER_SET, PREACTION_SET, ParameterSet, SMALL_MOTIONS, STRATEGY_SETS};
use moris_paper_runs::simulate::simulate;
use moris_paper_runs::table::{force_table, platform_table, rate_table};
use moris_paper_runs::trace::Trace;
use moris_simulation::drives::runs::{Manoeuvre, RUN_A, RUN_A_BRISK, RUN_B, RUN_C, TOWN_RUN};

/// Simulates the paper's runs with the washout's FMU, prints the errors of the felt motion, and
/// draws figures 5 to 9; then compares the strategies. Writes the curves as CSV, too.
#[derive(Parser)]
#[command(name = "cargo paper-runs", bin_name = "cargo paper-runs")]
struct Options {
    /// Directory for the figures and curves [default: target/paper-runs]
    #[arg(long, value_name = "DIR")]
    output: Option<PathBuf>,

    /// Communication step in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 0.001)]
    step: f64,

    /// Use the existing target/fmu/MorisWashout.fmu without building it
    #[arg(long)]
    no_build: bool,
}

fn main() -> Result<()> {
    let options = Options::parse();
    let fmu = if options.no_build { open(&workspace::default_output().join("MorisWashout.fmu"))? } else { built()? };
    let traces = make_runs(&fmu, &paper_runs(), options.step)?;
    let compared = make_runs(&fmu, &strategy_runs(), options.step)?;
    println!("{}", force_table(&traces));
    println!("{}", rate_table(&traces));
    println!("{}", platform_table(&traces));
    println!("The strategies\n");
    println!("{}", force_table(&compared));
    println!("{}", platform_table(&compared));

    let output = options.output.unwrap_or_else(|| workspace::target_directory().join("paper-runs"));
    fs::create_dir_all(&output).with_context(|| format!("cannot make {}", output.display()))?;
    for path in write_figures(&output, &traces)? {
        println!("{}", path.display());
    }
    let strategies = output.join("strategies.svg");
    write_strategies(&strategies, &compared)?;
    println!("{}", strategies.display());
    for path in write_curves(&output, &traces)?.into_iter().chain(write_curves(&output, &compared)?) {
        println!("{}", path.display());
    }
    Ok(())
}

/// The four runs with the paper's set, run b with the one made for it, and run c with preaction.
fn paper_runs() -> Vec<(Manoeuvre, ParameterSet)> {
    vec![
        (RUN_A, PAPER_SET),
        (RUN_A_BRISK, PAPER_SET),
        (RUN_B, PAPER_SET),
        (RUN_B, SMALL_MOTIONS),
        (RUN_C, PAPER_SET),
        (RUN_C, PREACTION_SET),
    ]
}

/// Run c and the ride through town with each strategy.
fn strategy_runs() -> Vec<(Manoeuvre, ParameterSet)> {
    [RUN_C, TOWN_RUN].into_iter().flat_map(|run| STRATEGY_SETS.map(|set| (run, set))).collect()
}

fn make_runs(fmu: &Fmu, runs: &[(Manoeuvre, ParameterSet)], step: f64) -> Result<Vec<Trace>> {
    let make = |(run, parameters): &(Manoeuvre, ParameterSet)| {
        simulate(fmu, run, parameters, step)
            .with_context(|| format!("run {} with parameters {}", run.name, parameters.name))
    };
    runs.iter().map(make).collect()
}
