//! `moris fit`: the largest scale at which the cues have the right sign and proportion.
//!
//! [`source`] reads the recordings, [`moris_analysis::fit`] fits them, and [`picture`] draws size
//! against shape.

pub mod picture;
pub mod source;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use moris_analysis::fit::{Common, Fitted, Strategy, common, fit_means, fitted};
use moris_analysis::message::Message;
use moris_analysis::outcome::{counted, listed};
use moris_setup::Setup;
use moris_simulation::fit::{Aims, Candidate, Fit};
use moris_simulation::preview::parse_seconds;
use moris_washout::interface::StrategyKind;
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::measure::recordings;
use crate::option_values::number_in;
use crate::recording::{ConventionOptions, Recording};
use crate::setup_options::{SetupOptions, strategies};
use crate::status::DOES_NOT_FIT;
use crate::text;
use crate::text_table::TextTable;
use crate::words::WHICH_COMMAND;

/// Find the largest scale at which the cues have the right sign and proportion
///
/// Prints a table of strategies by recordings: scale, shape, inverted time and size. The winner has
/// the best shape of those that reach --error and --inverted, and of the same shape the largest
/// size. Writes NAME.fit.toml with the winner's parameters for each recording, fit.toml with one
/// set for several recordings, and fit.svg with the curves of size against shape. The files are for
/// `moris simulate --parameters`. One factor scales surge, sway and all rates; heave has its own.
/// The classical strategy gets a second factor on its break frequencies of surge and sway.
///
/// A second line says what a tilt of 6 degrees a second would give. No choice depends on that line.
///
/// The exit status is 3 if no scale fits a recording; then the nearest one is shown.
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    /// Recordings (CSV) or folders of them, each with conventions of its own after @: a file, as in
    /// ride.csv@carsim.toml, or a logger's format, as in ride.csv@racechrono
    #[arg(required = true, value_name = "RECORDING[@CONVENTIONS]")]
    recordings: Vec<PathBuf>,

    /// Rig file, or shipped rig (hobby150, ...) [default: the default rig]
    #[arg(long, value_name = "FILE|NAME")]
    rig: Option<PathBuf>,

    /// Parameter file or preset over those of each strategy. May be given several times
    #[arg(long, value_name = "FILE|NAME")]
    parameters: Vec<String>,

    /// Strategies to fit [default: all]
    #[arg(long, value_parser = strategies())]
    strategy: Vec<StrategyKind>,

    /// Preview of the recording's force for the predictive strategy, in s, at most 4
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = parse_seconds)]
    preview: f64,

    /// Largest shape error of surge and sway together, in %
    #[arg(long, value_name = "PERCENT", default_value_t = 50.0, value_parser = parse_percent)]
    error: f64,

    /// Largest inverted time of an axis, in %
    #[arg(long, value_name = "PERCENT", default_value_t = 2.0, value_parser = parse_percent)]
    inverted: f64,

    /// Directory for the parameter files and the picture
    #[arg(long, value_name = "DIRECTORY", default_value = crate::REPORT_DIRECTORY)]
    report: PathBuf,

    /// Print the results as JSON; inverted and shapeError are in %
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    conventions: ConventionOptions,
}

/// Runs the command.
///
/// # Errors
/// A recording, the rig or the parameters cannot be used, or a file cannot be written.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    let recordings = read_recordings(options)?;
    let strategies = all_strategies(options)?;
    let aims = Aims { error: options.error / 100.0, inverted: options.inverted / 100.0, ..Aims::default() };
    let fitted = fitted(&recordings, &strategies, options.preview, aims)?;
    let several = recordings.len() > 1;
    let common = if several { common(&recordings, &strategies, options.preview, aims, &fitted)? } else { None };
    let files = write_files(&options.report, &recordings, &fitted, common.as_ref(), &strategies)?;
    if options.json {
        let mut results: Vec<Value> =
            fitted.iter().zip(&files).map(|(one, file)| json_of(one, file, &strategies)).collect();
        results.extend(common.iter().zip(files.get(fitted.len())).map(|(common, file)| {
            json!({
                "recordings": fitted.iter().map(|one| &one.name).collect::<Vec<_>>(),
                "winner": strategies[common.strategy].name,
                "fitting": common.fitting,
                "scale": common.worst.factors.scale,
                "breakFrequencies": common.worst.factors.breaks,
                "heave": common.worst.factors.heave,
                "parameters": file.display().to_string(),
            })
        }));
        writeln!(out, "{:#}", Value::from(results))?;
    } else {
        write!(out, "{}", fit_text(&fitted, common.as_ref(), &strategies, aims))?;
        for file in files {
            writeln!(out, "wrote {}", file.display())?;
        }
        writeln!(out, "\n{WHICH_COMMAND}")?;
    }
    let all_fit = fitted.iter().all(|one| one.fits[one.winner].fits);
    Ok(if all_fit { ExitCode::SUCCESS } else { ExitCode::from(DOES_NOT_FIT) })
}

fn read_recordings(options: &Options) -> Result<Vec<Recording>> {
    let files = recordings(&options.recordings)?;
    files.par_iter().map(|file| source::recording(file, &options.conventions)).collect()
}

fn all_strategies(options: &Options) -> Result<Vec<Strategy>> {
    let kinds = if options.strategy.is_empty() { StrategyKind::ALL } else { &options.strategy[..] };
    let load = |kind: &StrategyKind| {
        let setup =
            SetupOptions { rig: options.rig.clone(), parameters: options.parameters.clone(), strategy: Some(*kind) }
                .load()?;
        Ok(Strategy { name: kind.name().to_owned(), setup })
    };
    kinds.iter().map(load).collect()
}

/// Writes the winner's parameters for each recording, those for all, and the picture; returns the
/// files in this order.
fn write_files(
    directory: &Path,
    recordings: &[Recording],
    fitted: &[Fitted],
    common: Option<&Common>,
    strategies: &[Strategy],
) -> Result<Vec<PathBuf>> {
    fs::create_dir_all(directory).with_context(|| format!("cannot make {}", directory.display()))?;
    let mut files = Vec::new();
    let mut write = |name: String, text: String| {
        let file = directory.join(name);
        fs::write(&file, text).with_context(|| format!("cannot write {}", file.display()))?;
        files.push(file);
        Ok::<(), anyhow::Error>(())
    };
    let text = |names: &str, strategy: usize, best: &Candidate| {
        let Strategy { name, setup } = &strategies[strategy];
        let (rig, strategy, words) = (&setup.rig_name, name, candidate_words(best));
        let heading = text!["heading-of-fit", names, rig, strategy, words].to_string();
        Setup { parameters: best.factors.applied(&setup.parameters), ..setup.clone() }.parameter_file(&heading)
    };
    for (recording, one) in recordings.iter().zip(fitted) {
        let name = format!("{}.fit.toml", recording.name.replace(' ', "-"));
        write(name, text(&recording.name, one.winner, &one.fits[one.winner].best))?;
    }
    if let Some(Common { strategy, worst, .. }) = common {
        let names = listed(recordings.iter().map(|recording| recording.name.as_str()));
        write("fit.toml".to_owned(), text(&names, *strategy, worst))?;
    }
    write("fit.svg".to_owned(), picture::svg(fitted, strategies)?)?;
    Ok(files)
}

fn fit_text(fitted: &[Fitted], common: Option<&Common>, strategies: &[Strategy], aims: Aims) -> String {
    let heads =
        ["scale: shape, inverted, size"].into_iter().chain(strategies.iter().map(|strategy| strategy.name.as_str()));
    let mut table = TextTable::new(heads.chain(["winner"]));
    for one in fitted {
        let cells = one.fits.iter().map(fit_cell);
        table.push([one.name.clone()].into_iter().chain(cells).chain([strategies[one.winner].name.clone()]).collect());
    }
    let mut text = format!("{table}\n");
    for (index, strategy) in strategies.iter().enumerate() {
        let means = fit_means(fitted.iter().map(|one| &one.fits[index]));
        let misfits = match means.misfits {
            0 => String::new(),
            count => format!("; no scale fits {count} of {}", fitted.len()),
        };
        let (inverted, most) = (100.0 * means.mean_inverted, 100.0 * means.max_inverted);
        let (name, shape, size, scale) = (&strategy.name, means.shape, means.size, means.scale);
        text += &text!["fit-means", name, shape, inverted, most, size, scale, misfits].to_string();
    }
    text += "\n";
    for one in fitted {
        let fit = &one.fits[one.winner];
        let name = &strategies[one.winner].name;
        let (error, inverted) = (100.0 * aims.error, 100.0 * aims.inverted);
        let misfit = if fit.fits { Message::default() } else { text!["fit-misfit", error, inverted] };
        text += &format!("{}: {name}, {}.{misfit}\n", one.name, candidate_words(&fit.best));
        if let Some(faster) = &one.faster_tilt {
            text +=
                &format!("  With a tilt of 6 °/s (tilt.rateLimit, your choice): {}.\n", candidate_words(&faster.best));
        }
    }
    if let Some(Common { strategy, worst, fitting }) = common {
        let (recordings, strategy) = (counted(fitted.len(), "recording"), &strategies[*strategy].name);
        text +=
            &text!["fit-for-all", fitting = *fitting, recordings, strategy, words = candidate_words(worst)].to_string();
    }
    text
}

/// Scale, shape, inverted time and size in a cell; in brackets where no scale fits.
fn fit_cell(fit: &Fit) -> String {
    let shape = &fit.best.shape;
    let (Some(least), Some((_, inverted)), Some(size)) =
        (shape.least_shape(), shape.most_inverted_axis(), shape.size())
    else {
        return "nothing asked".to_owned();
    };
    let text = format!("{:.2}: {least:.2}, {:.1} %, {size:.2}", fit.best.factors.scale, 100.0 * inverted);
    if fit.fits { text } else { format!("({text})") }
}

fn candidate_words(best: &Candidate) -> String {
    let factors = &best.factors;
    let breaks =
        if factors.breaks != 1.0 { format!(", break frequencies times {:.2}", factors.breaks) } else { String::new() };
    let heave = if factors.heave < 1.0 { format!(", heave times {:.2}", factors.heave) } else { String::new() };
    let shape = &best.shape;
    let (Some(least), Some((_, inverted)), Some(size)) =
        (shape.least_shape(), shape.most_inverted_axis(), shape.size())
    else {
        return format!("scale {:.2}: nearly no surge or sway is desired{heave}", factors.scale);
    };
    let (scale, inverted) = (factors.scale, 100.0 * inverted);
    text!["fit-words", scale, breaks, heave, least, inverted, size].to_string()
}

fn json_of(one: &Fitted, file: &Path, strategies: &[Strategy]) -> Value {
    let fit = |(fit, strategy): (&Fit, &Strategy)| {
        let channel = |axis: usize| {
            fit.best.shape.axes[axis]
                .map(|axis| json!({ "shape": axis.shape, "size": axis.size, "inverted": 100.0 * axis.inverted }))
        };
        json!({
            "strategy": strategy.name,
            "fits": fit.fits,
            "scale": fit.best.factors.scale,
            "breakFrequencies": fit.best.factors.breaks,
            "heave": fit.best.factors.heave,
            "shapeError": fit.best.shape.error.map(|error| 100.0 * error),
            "surge": channel(0),
            "sway": channel(1),
        })
    };
    json!({
        "recording": one.name,
        "winner": strategies[one.winner].name,
        "fits": one.fits.iter().zip(strategies).map(fit).collect::<Vec<_>>(),
        "parameters": file.display().to_string(),
    })
}

fn parse_percent(text: &str) -> Result<f64, String> {
    number_in(text, 0.1..=100.0, "a percentage from 0.1 to 100 is needed, such as 50")
}
