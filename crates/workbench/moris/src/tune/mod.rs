//! `moris tune`: finds better parameters for a set of recordings, by [`moris_analysis::tune`].

mod options;

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::{ExitCode, exit};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use anyhow::{Context, Result};
use indicatif::{ProgressBar, ProgressStyle};
use moris_interface::Group as _;
use moris_setup::{NamedValues, Setup, all, overlaid, parameter_file};
use moris_washout::{Parameters, check};
use rayon::prelude::*;

use crate::recording::{FADE_IN, Recording, table};
use crate::simulate::{Outcome, write_page};
use crate::status::WORSE;
use crate::votes;
use cost::Objective;
pub use moris_analysis::tune::{cost, folds, search, space, summary, tested, tuner};
pub use options::Options;
use search::Budget;
use space::Space;
use summary::Verdict;
use tested::{Tested, tune_tested};
use tuner::Tuner;

/// Runs the command.
///
/// # Errors
/// A recording, the rig or the parameters cannot be used, no parameters keep the limits, or a
/// file cannot be written.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    let before = start(options)?;
    let tuned_on = objectives(options, &options.recordings, &before)?;
    let held_out = objectives(options, &options.hold_out, &before)?;
    let folds = folds::folds(tuned_on.len(), options.folds.unwrap_or(tuned_on.len()));

    let bar = ProgressBar::new((options.evaluations * (1 + folds.len())) as u64);
    bar.set_style(ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %, {eta} to go")?);
    let tuner = Tuner {
        setup: &before,
        space: Space::new(&before.parameters, &options.tune),
        budget: Budget { evaluations: options.evaluations, seed: options.seed },
        evaluate: &search::evaluate_here,
        observe: &|_, _, _| true,
        interrupted: listen()?,
        tried: AtomicUsize::new(0),
        show: &|tried, text| {
            bar.set_position(tried as u64);
            if let Some(text) = text {
                bar.set_message(text.to_owned());
            }
        },
    };
    let everything: Vec<&Objective> = tuned_on.iter().collect();
    let Tested { setup: tuned, results, fraction } =
        tune_tested(&tuner, &everything, &held_out.iter().collect::<Vec<_>>(), &folds)?;
    bar.finish_and_clear();
    save(options, &before, &tuned, &summary::first_line(&results, fraction))?;

    let text = summary::text(&before, &tuned, &results, fraction, tuner.was_interrupted());
    write!(out, "{text}")?;
    writeln!(out, "wrote {}", options.output.display())?;
    for file in write_reports(options, &text, tuned_on.iter().chain(&held_out), &[tuned, before])? {
        writeln!(out, "wrote {}", file.display())?;
    }
    let is_worse = Verdict::of(&results, fraction) == Verdict::Worse;
    Ok(if is_worse { ExitCode::from(WORSE) } else { ExitCode::SUCCESS })
}

/// The parameters that the search starts from.
fn start(options: &Options) -> Result<Setup> {
    let mut setup = options.setup.load()?;
    let Some(file) = &options.votes else { return Ok(setup) };
    let Some(values) = votes::preferred(&votes::read(file)?) else { return Ok(setup) };
    setup.parameters = overlaid(&setup.rig_alone, &values);
    check(&setup.parameters).with_context(|| file.display().to_string())?;
    setup.parameters_name = format!("preferred in {}", file.display());
    Ok(setup)
}

fn objectives(options: &Options, files: &[PathBuf], setup: &Setup) -> Result<Vec<Objective>> {
    let conventions = options.conventions.load_or_fade_in(FADE_IN)?;
    let objective = |file: &PathBuf| {
        let recording = Recording::read(file, &conventions)?;
        let objective = Objective::new(recording, &setup.parameters, &options.weights, options.stroke_reserve)?;
        Ok(objective.with_comfort_bounds(options.comfort))
    };
    table::recordings(files, &conventions).par_iter().map(objective).collect()
}

/// True after Ctrl-C; a second one ends the program.
fn listen() -> Result<Arc<AtomicBool>> {
    let interrupted = Arc::new(AtomicBool::new(false));
    let pressed = Arc::clone(&interrupted);
    let handler = move || {
        if pressed.swap(true, Ordering::Relaxed) {
            exit(130);
        }
        eprintln!("ending after this generation; press Ctrl-C again to end at once, with nothing kept");
    };
    ctrlc::set_handler(handler).context("cannot listen for Ctrl-C")?;
    eprintln!("searching; Ctrl-C ends it and keeps the best so far");
    Ok(interrupted)
}

/// Writes the parameter file: the values that differ from the rig's with default parameters.
fn save(options: &Options, before: &Setup, tuned: &Setup, first_line: &str) -> Result<()> {
    let heading = format!(
        "{first_line}\nTuned by moris on {} for {}, from {}, seed {}",
        options.recordings.iter().map(|recording| recording.display().to_string()).collect::<Vec<_>>().join(", "),
        before.rig_name,
        before.parameters_name,
        options.seed
    );
    let differing =
        all(&tuned.parameters).into_iter().zip(all(&before.rig_alone)).filter(|(mine, rigs)| mine.1 != rigs.1);
    let values: NamedValues = differing.map(|(mine, _)| mine).collect();
    let text = parameter_file::write(&heading, &values, Parameters::ROWS);
    fs::write(&options.output, text).with_context(|| format!("cannot write {}", options.output.display()))
}

fn write_reports<'a>(
    options: &Options,
    text: &str,
    objectives: impl Iterator<Item = &'a Objective>,
    setups: &[Setup; 2],
) -> Result<Vec<PathBuf>> {
    fs::create_dir_all(&options.report).with_context(|| format!("cannot make {}", options.report.display()))?;
    let file = options.report.join("tune.md");
    fs::write(&file, text).with_context(|| format!("cannot write {}", file.display()))?;
    let mut written = vec![file];
    for objective in objectives {
        let outcomes: Result<Vec<Outcome>> =
            setups.iter().map(|setup| Outcome::of(objective.recording(), setup, || ())).collect();
        written.push(write_page(
            &options.report,
            &format!("{}.tuned", objective.name()),
            objective.recording(),
            &outcomes?,
            None,
        )?);
    }
    Ok(written)
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        options: Options,
    }

    #[test]
    fn the_search_starts_from_the_set_that_votes_prefer() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("votes");
        let start_of = |votes: &str| {
            fs::write(&file, votes).unwrap();
            let line = Line::parse_from(["tune", "ride.csv", "--votes", file.to_str().unwrap()]);
            start(&line.options)
        };
        let setup = start_of("{\"better\":{\"scale.specificForce.x\":0.6},\"worse\":{}}\n").unwrap();
        assert!(all(&setup.parameters).contains(&("scale.specificForce.x".to_owned(), 0.6)));
        assert_eq!(setup.rig_alone, Parameters::default());
        let wrong = start_of("{\"better\":{\"tilt.angleLimit\":9},\"worse\":{}}\n").unwrap_err();
        assert!(format!("{wrong:#}").contains("tilt.angleLimit"), "{wrong:#}");
    }
}
