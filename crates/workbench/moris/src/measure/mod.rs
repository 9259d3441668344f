//! `moris measure`: one table of all channels of several recordings.
//!
//! [`moris_analysis::measure`] measures the recordings and checks the targets, and [`table`] prints
//! the table.

pub mod table;

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use moris_analysis::host::{Host, Inputs};
use moris_analysis::measure::MeasuredRecording;
use moris_analysis::measure::targets::Targets;
use moris_laps::Laps;
use moris_simulation::preview::{Previewer, parse_seconds};
use rayon::prelude::*;

use crate::learned_road::Kept;
use crate::option_values::number_in;
use crate::recording::{ConventionOptions, FADE_IN, Recording, files_in};
use crate::setup_options::SetupOptions;
use crate::status::WORSE_RESULT;

/// Measure recordings channel by channel and say which targets are missed
///
/// Prints a line for each recording and channel. The columns are the error of a platform at rest,
/// the bound (with --bound), the RMS error and the RMS error as sensed. Then come the fractions of
/// the time with a cue in the vehicle, with a false cue and with a missing cue on the platform. The
/// next is comfort: shake, jolt and peak of the felt force beyond the desired one, in m/s². The
/// last are shape, size and inverted time of surge and sway below 2 Hz. Below the table are the
/// limits that were active on each recording, and the targets. Recordings fade in from rest over 1
/// s; --fade-in changes it.
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    /// Recordings (CSV), or folders of them; see `moris simulate --help` for their columns
    #[arg(required = true, value_name = "RECORDING|FOLDER")]
    recordings: Vec<PathBuf>,

    #[command(flatten)]
    setup: SetupOptions,

    /// Communication step of the host, in s, a divisor or a multiple of the recording's
    /// [default: the recording's]
    #[arg(long, value_name = "SECONDS", value_parser = parse_step)]
    step: Option<f64>,

    /// Input within a step, as given by the host
    #[arg(long, value_enum, default_value_t)]
    inputs: Inputs,

    /// Preview of the recording's force for the predictive strategy, in s, at most 4
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = parse_seconds)]
    preview: f64,

    /// Preview for the predictive strategy that is learned from earlier passes of the same road:
    /// the columns x and y, or latitude and longitude, are the position. A file, one for each
    /// vehicle and track, is read first and written at the end
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true, conflicts_with = "preview")]
    learn: Option<Option<PathBuf>>,

    /// Compute the bound, the least error that any controller could reach. Takes
    /// some seconds a recording
    #[arg(long)]
    bound: bool,

    #[command(flatten)]
    targets: Targets,

    /// End with exit status 4 where a target is missed
    #[arg(long)]
    check: bool,

    #[command(flatten)]
    conventions: ConventionOptions,
}

/// Runs the command.
///
/// # Errors
/// A recording, the rig or the parameters cannot be used, or standard output cannot be written.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    let setup = options.setup.load_with_notes()?;
    let conventions = options.conventions.load_or_fade_in(FADE_IN)?.with_position(options.learn.is_some());
    let host =
        Host { step: options.step, inputs: options.inputs, preview: options.preview, learns: options.learn.is_some() };
    let file = options.learn.as_ref().and_then(Option::as_deref);
    let measure = |recording: &Recording, learned: Option<Previewer>| {
        MeasuredRecording::of(recording, &setup, &host, learned, options.bound).with_context(|| recording.name.clone())
    };
    let alone = |file: &PathBuf| {
        let recording = Recording::read(file, &conventions)?;
        let learned = host.learns.then(|| recording.learned(&mut Laps::new())).transpose()?;
        measure(&recording, learned)
    };
    let files = recordings(&options.recordings)?;
    let recordings: Vec<MeasuredRecording> = match file {
        None => files.par_iter().map(alone).collect::<Result<_>>()?,
        // Each one knows the road of those before it.
        Some(_) => {
            let mut road = Kept::open(file)?;
            let in_turn = |file: &PathBuf| {
                let recording = Recording::read(file, &conventions)?;
                let learned = road.learn(&recording)?;
                measure(&recording, Some(learned))
            };
            let measured = files.iter().map(in_turn).collect::<Result<_>>()?;
            road.save()?;
            measured
        }
    };
    let missed = options.targets.missed(&recordings);
    write!(out, "{}", table::text(&setup, &host, &recordings, &missed))?;
    Ok(if options.check && !missed.is_empty() { ExitCode::from(WORSE_RESULT) } else { ExitCode::SUCCESS })
}

/// The files named, and those of recordings in the folders named, by name.
pub(crate) fn recordings(paths: &[PathBuf]) -> Result<Vec<PathBuf>> {
    let named = |path: &PathBuf| if path.is_dir() { files_in(path) } else { Ok(vec![path.clone()]) };
    Ok(paths.iter().map(named).collect::<Result<Vec<_>, _>>()?.concat())
}

fn parse_step(text: &str) -> Result<f64, String> {
    number_in(text, 1e-6..=1.0, "a time from 1e-6 to 1 s is needed, such as 0.001")
}
