//! `moris tune`: finds better parameters for a set of recordings, by [`moris_analysis::tune`].

mod kept;
mod options;

use std::fs;
use std::io::{IsTerminal, Write, stderr};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use moris_setup::Setup;
use moris_washout::interface::StrategyKind;
use rayon::prelude::*;

use crate::recording::{FADE_IN, Recording, table};
use crate::simulate::{Outcome, write_page};
use crate::status::WORSE_RESULT;
use crate::text;
use crate::words;
use cost::Objective;
use kept::Kept;
use moris_analysis::tune::error::TuneError;
pub use moris_analysis::tune::{cost, folds, search, space, summary, tested, tuner};
pub use options::{Choice, Options};
use search::Budget;
use space::Space;
use summary::{OfStrategy, RecordingResult, Verdict};
use tested::{Tested, tune_tested};
use tuner::Tuner;

/// Runs the command.
///
/// # Errors
/// A recording, the rig or the parameters cannot be used, no parameters keep the limits, or a
/// file cannot be written.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    let strategies = options.strategies();
    let kept = Arc::new(Kept::default());
    let interrupted = kept::listen(Arc::clone(&kept))?;
    let mut tunings: Vec<Tuning> = Vec::new();
    let mut missed: Vec<String> = Vec::new();
    for strategy in &strategies {
        let begun = Tuning::of(options, *strategy, &kept, &interrupted);
        match begun {
            Ok(tuning) => tunings.push(tuning),
            Err(error) if strategies.len() > 1 && is_infeasible(&error) => {
                missed.extend(strategy.map(|strategy| strategy.name().to_owned()));
                eprintln!("{}", words::error(&*error));
            }
            Err(error) => return Err(error),
        }
        if interrupted.load(Ordering::Relaxed) {
            break;
        }
    }
    let of = |tuning: &Tuning| OfStrategy { name: tuning.strategy_name(), results: Some(tuning.results.clone()) };
    let mut table: Vec<OfStrategy> = tunings.iter().map(of).collect();
    let Some(winner) = summary::winner(&table) else {
        bail!("no strategy has parameters that keep the limits on these recordings: {}", missed.join(", "));
    };
    table.extend(missed.into_iter().map(|name| OfStrategy { name, results: None }));

    let best = &tunings[winner];
    let mut text = String::new();
    if strategies.len() > 1 {
        text = summary::strategies(&table);
        write!(out, "{text}")?;
        // Each has a file of its own already; the winner's is the result.
        fs::copy(&best.file, &options.output).with_context(|| format!("cannot write {}", options.output.display()))?;
        tunings.iter().for_each(|tuning| text += &format!("\n{}", tuning.text()));
        for tuning in &tunings {
            writeln!(out, "wrote {}", tuning.file.display())?;
        }
    } else {
        text += &best.text();
        write!(out, "{text}")?;
    }
    writeln!(out, "wrote {}", options.output.display())?;
    let (files, verdicts) = write_reports(options, &text, &best.objectives, &[&best.tuned, &best.before])?;
    for file in files {
        writeln!(out, "wrote {}", file.display())?;
    }
    writeln!(out, "\n{}{}", verdicts, words::WHICH_COMMAND)?;
    let is_worse = Verdict::of(&best.results, best.fraction) == Verdict::Worse;
    Ok(if is_worse { ExitCode::from(WORSE_RESULT) } else { ExitCode::SUCCESS })
}

/// A strategy's tuning.
struct Tuning {
    before: Setup,
    tuned: Setup,
    /// The recordings, those held out last.
    objectives: Vec<Objective>,
    results: Vec<RecordingResult>,
    fraction: f64,
    was_interrupted: bool,
    /// The parameter file.
    file: PathBuf,
}

impl Tuning {
    /// Tunes a strategy, or that of the parameters, and writes its parameter file.
    fn of(
        options: &Options,
        strategy: Option<StrategyKind>,
        kept: &Kept,
        interrupted: &Arc<AtomicBool>,
    ) -> Result<Tuning> {
        // Time between the lines of progress in a log [s].
        const PROGRESS_INTERVAL: u64 = 10;
        let before = options.setup(strategy).load()?;
        let mut all = read_objectives(options, &options.recordings, &before)?;
        let count = all.len();
        all.extend(read_objectives(options, &options.hold_out, &before)?);
        let (tuned_on, held_out) = all.split_at(count);
        let folds = folds::folds(count, options.folds.unwrap_or(count));

        let evaluations = options.evaluations * (1 + folds.len());
        let bar = ProgressBar::new(evaluations as u64);
        // A log has lines in place of the bar.
        let (is_logged, said) = (!stderr().is_terminal(), AtomicU64::new(0));
        bar.set_style(ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %, {eta} to go")?);
        let name = before.parameters.structure.strategy.name();
        let file = match options.strategy {
            Some(Choice::All) => options.output.with_extension(format!("{name}.toml")),
            _ => options.output.clone(),
        };
        let (begin, is_first) = (Instant::now(), AtomicBool::new(true));
        let tuner = Tuner {
            setup: &before,
            space: Space::of_recordings(&before.parameters, &options.tune, tuned_on),
            budget: Budget { evaluations: options.evaluations, seed: options.seed },
            evaluate: &search::evaluate_here,
            observe: &|_, _, least| {
                if let Some(error) = least.filter(|_| is_first.swap(false, Ordering::Relaxed)) {
                    let seconds = begin.elapsed().as_secs_f64();
                    bar.suspend(|| eprintln!("{name}: first result after {seconds:.1} s, error {error:.4}"));
                }
                true
            },
            interrupted: Arc::clone(interrupted),
            tried: AtomicUsize::new(0),
            show: &|tried, text| {
                bar.set_position(tried as u64);
                let seconds = begin.elapsed().as_secs();
                if is_logged && seconds >= said.load(Ordering::Relaxed) + PROGRESS_INTERVAL {
                    said.store(seconds, Ordering::Relaxed);
                    eprintln!("{name}: {} % of the evaluations after {seconds} s", 100 * tried / evaluations);
                }
                if let Some(text) = text {
                    bar.set_message(format!("{name}, {text}"));
                }
            },
            so_far: kept.begin(&before, &file, &parameter_heading(options, &before)),
        };
        let (tuned_on, held_out): (Vec<_>, Vec<_>) = (tuned_on.iter().collect(), held_out.iter().collect());
        let Tested { setup: tuned, results, fraction } = tune_tested(&tuner, &tuned_on, &held_out, &folds)?;
        bar.finish_and_clear();
        let was_interrupted = tuner.was_interrupted();
        kept.finish(&tuned, &summary::first_line(&results, fraction, words::option))?;
        Ok(Tuning { before, tuned, objectives: all, results, fraction, was_interrupted, file })
    }

    fn strategy_name(&self) -> String {
        self.before.parameters.structure.strategy.name().to_owned()
    }

    fn text(&self) -> String {
        summary::text(&self.before, &self.tuned, &self.results, self.fraction, self.was_interrupted, words::option)
    }
}

/// True where no parameters keep the limits.
fn is_infeasible(error: &anyhow::Error) -> bool {
    matches!(error.downcast_ref(), Some(TuneError::Infeasible(_)))
}

fn read_objectives(options: &Options, files: &[PathBuf], setup: &Setup) -> Result<Vec<Objective>> {
    let conventions = options.conventions.load_or_fade_in(FADE_IN)?;
    let objective = |file: &PathBuf| {
        let recording = Recording::read(file, &conventions)?;
        let objective = Objective::new(recording, &setup.parameters, &options.weights, options.stroke_reserve)?;
        Ok(objective.with_comfort_bounds(options.comfort).with_aim(options.objective))
    };
    table::recordings(files, &conventions).par_iter().map(objective).collect()
}

/// Origin of the tuned parameters.
fn parameter_heading(options: &Options, before: &Setup) -> String {
    let recordings: Vec<String> = options.recordings.iter().map(|recording| recording.display().to_string()).collect();
    let (recordings, rig, parameters) = (recordings.join(", "), &before.rig_name, &before.parameters_name);
    text!["heading-of-tuning", recordings, rig, parameters, seed = options.seed].to_string()
}

/// Writes the summary and a report for each recording; returns the files, and the verdict of each
/// report on a line.
fn write_reports(
    options: &Options,
    text: &str,
    objectives: &[Objective],
    setups: &[&Setup; 2],
) -> Result<(Vec<PathBuf>, String)> {
    fs::create_dir_all(&options.report).with_context(|| format!("cannot make {}", options.report.display()))?;
    let file = options.report.join("tune.md");
    fs::write(&file, text).with_context(|| format!("cannot write {}", file.display()))?;
    let (mut written, mut verdicts) = (vec![file], String::new());
    for objective in objectives {
        let mut outcomes: Vec<Outcome> = setups
            .iter()
            .map(|setup| Outcome::of(objective.recording(), setup, None, || ()))
            .collect::<Result<_, _>>()?;
        outcomes[0].advice = outcomes[0].alternatives(objective.recording(), 0.0)?;
        verdicts += &format!("{}: {}\n", objective.name(), outcomes[0].evaluated().verdict().text);
        written.push(write_page(
            &options.report,
            &format!("{}.tuned", objective.name()),
            objective.recording(),
            &outcomes,
            &format!("cargo moris simulate {}.csv --parameters", objective.recording().name),
        )?);
    }
    Ok((written, verdicts))
}
