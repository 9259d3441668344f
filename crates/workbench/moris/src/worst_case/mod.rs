//! `moris worst-case`: what the rider feels where the platform is not the nominal one.
//!
//! [`moris_analysis::worst_case`] measures, and [`table`] prints the result.

pub mod table;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use anyhow::{Context, Result};
use moris_analysis::worst_case::points::points;
use moris_analysis::worst_case::study::Study;
use moris_interface::Group;
use moris_setup::{Setup, overlaid, parameter_file};
use moris_stewart_platform::Parameters as Platform;
use moris_washout::interface::StrategyKind;
use rayon::prelude::*;

use crate::measure;
use crate::progress::Progress;
use crate::recording::{ConventionOptions, FADE_IN, Recording};
use crate::setup_options::strategies;

/// Measure each strategy on platforms that differ from the nominal one
///
/// The washout's legs command a Stewart platform with dynamics; the washout gets no feedback. The
/// table has the RMS error, shake and jolt of the felt force: on the commanded motion, on the
/// nominal platform, and on the worst. Then comes where the worst is. The RMS error is the
/// geometric mean of surge and sway over all recordings, each at least 0.03 m/s². Shake and jolt
/// are the largest.
///
/// Load (all moving masses) goes from 50 to 150 %, bandwidth of the actuators from 70 to 130 %,
/// dead time from 0 to 50 ms. Nominal, least and largest value of each are tried in every
/// combination, then random points. Recordings fade in from rest over 1 s; --fade-in changes it.
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    /// Recordings (CSV), or folders of them; see `moris simulate --help` for their columns
    #[arg(required = true, value_name = "RECORDING|FOLDER")]
    recordings: Vec<PathBuf>,

    /// Strategies, separated by commas; each sets `strategy` and no other parameter [default: all]
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = strategies())]
    strategy: Vec<StrategyKind>,

    /// Rig file [default: the default rig]
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,

    /// Parameter file of the washout, or a preset. May be given several times: later ones override
    /// earlier ones
    #[arg(long, value_name = "FILE|NAME")]
    parameters: Vec<String>,

    /// Parameter file of the nominal platform: its actuators and masses. Rig and gravity are the
    /// washout's [default: those of StewartPlatform.fmu]
    #[arg(long, value_name = "FILE")]
    platform: Option<PathBuf>,

    /// Random points
    #[arg(long, value_name = "NUMBER", default_value_t = 50)]
    points: usize,

    /// Seed of the random points
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,

    #[command(flatten)]
    conventions: ConventionOptions,
}

/// Runs the command.
///
/// # Errors
/// A recording, the rig or the parameters cannot be used, or standard output cannot be written.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    let setup = Setup::load(options.rig.as_deref(), &options.parameters)?;
    let platform = options.platform.as_deref().map_or_else(|| Ok(Platform::default()), read_platform)?;
    let conventions = options.conventions.load_or_fade_in(FADE_IN)?;
    let progress = Progress::new("worst case", "reading")?;
    let rides: Vec<Recording> = measure::recordings(&options.recordings)?
        .par_iter()
        .map(|file| Ok(Recording::read(file, &conventions)?))
        .collect::<Result<_>>()?;
    let strategies = if options.strategy.is_empty() { StrategyKind::ALL } else { &options.strategy };
    let points = points(&platform, options.points, options.seed)?;

    let progress = Mutex::new(progress);
    let study = |strategy: &StrategyKind| {
        with(&progress, |bar| bar.phase(strategy.name(), (points.len() * rides.len()) as u64));
        let step = || with(&progress, Progress::step);
        Study::of(*strategy, &rides, &setup.parameters, &platform, &points, &step)
    };
    let studies: Vec<Study> = strategies.iter().map(study).collect::<Result<_, _>>()?;
    progress.into_inner().unwrap_or_else(PoisonError::into_inner).finish();
    write!(out, "{}", table::text(&setup, rides.len(), &studies))?;
    Ok(ExitCode::SUCCESS)
}

/// Calls a method of the progress from any thread.
fn with(progress: &Mutex<Progress>, call: impl FnOnce(&mut Progress)) {
    call(&mut progress.lock().unwrap_or_else(PoisonError::into_inner));
}

/// The default platform with the values of a parameter file.
fn read_platform(file: &Path) -> Result<Platform> {
    let text = moris_fmu_host::files::text(file, moris_fmu_host::files::TEXT)
        .with_context(|| format!("cannot read {}", file.display()))?;
    Ok(overlaid(&Platform::default(), &parameter_file::read(&text, &file.display().to_string(), Platform::ROWS)?))
}
