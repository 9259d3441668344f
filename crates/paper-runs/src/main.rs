//! `cargo paper-runs`: builds the FMU, simulates the paper's runs, prints the errors, draws the
//! figures.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Parser;
use moris_build_fmu::{FmiVersion, model, workspace};
use moris_fmu_host::Fmu;
use moris_paper_runs::figures::{write_figures, write_readme_picture};
use moris_paper_runs::manoeuvres::{A, A_BRISK, B, C, Manoeuvre};
use moris_paper_runs::parameter_set::{PAPER, PREACTION, ParameterSet, SMALL_MOTIONS};
use moris_paper_runs::recording::Recording;
use moris_paper_runs::simulate::simulate;
use moris_paper_runs::table::{force_table, platform_table, rate_table};

/// Simulates the paper's runs with the washout's FMU, prints the errors of the felt motion, and
/// draws figures 5 to 9.
#[derive(Parser)]
#[command(name = "cargo paper-runs", bin_name = "cargo paper-runs")]
struct Options {
    /// Directory for the figures [default: target/paper-runs]
    #[arg(long, value_name = "DIR")]
    output: Option<PathBuf>,

    /// Communication step in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 0.001)]
    step: f64,

    /// Use the existing target/fmu/MorisWashout.fmu without building it
    #[arg(long)]
    no_build: bool,

    /// Also write a compact figure of run a to this file
    #[arg(long, value_name = "FILE")]
    readme_picture: Option<PathBuf>,
}

fn main() -> Result<()> {
    let options = Options::parse();
    let path = if options.no_build { workspace::default_output().join("MorisWashout.fmu") } else { build_fmu()? };
    let recordings = make_runs(&path, options.step)?;
    println!("{}", force_table(&recordings));
    println!("{}", rate_table(&recordings));
    println!("{}", platform_table(&recordings));

    let output = options.output.unwrap_or_else(|| workspace::root().join("target/paper-runs"));
    fs::create_dir_all(&output).with_context(|| format!("cannot make {}", output.display()))?;
    for path in write_figures(&output, &recordings)? {
        println!("{}", path.display());
    }
    if let Some(path) = &options.readme_picture {
        write_readme_picture(path, &recordings)?;
        println!("{}", path.display());
    }
    Ok(())
}

/// Builds the FMU for this machine, as `cargo build-fmu` does, with progress on standard error.
fn build_fmu() -> Result<PathBuf> {
    let built = moris_build_fmu::build(&model::WASHOUT, FmiVersion::Fmi2, &[], &workspace::default_output(), |line| {
        eprintln!("{line}");
    })?;
    eprintln!("{}\n", built.file.display());
    Ok(built.file)
}

/// The four runs with the paper's set, run b with the one made for it, and run c with preaction.
fn make_runs(path: &Path, step: f64) -> Result<Vec<Recording>> {
    let fmu = Fmu::open(path).with_context(|| format!("cannot open {}", path.display()))?;
    let runs = [(A, PAPER), (A_BRISK, PAPER), (B, PAPER), (B, SMALL_MOTIONS), (C, PAPER), (C, PREACTION)];
    let make = |(run, parameters): &(Manoeuvre, ParameterSet)| {
        simulate(&fmu, run, parameters, step)
            .with_context(|| format!("run {} with parameters {}", run.name, parameters.name))
    };
    runs.iter().map(make).collect()
}
