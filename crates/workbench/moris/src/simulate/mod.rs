//! `moris simulate`: simulates a recording on a rig and measures the cues.
//!
//! `moris_simulation` steps the washout, measures, and describes the measures in sentences. The
//! modules process its result:
//!
//! - [`output_table`] writes inputs and outputs to a file.
//! - [`bounds`] computes the least possible error.
//! - [`summary`] and [`json`] print the measures.
//! - [`page`] makes the report, with a `simulator` in it; [`index`] lists the reports
//!   of several recordings.

mod command_line;
pub mod index;
pub mod json;
pub mod output_table;
pub mod summary;

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use moris_pages::report::MODULE_REMEDY;
use moris_setup::Setup;
use moris_simulation::advice::Advice;
use moris_simulation::foreign::ForeignMotion;
use moris_simulation::preview::{Previewer, parse_seconds};
use moris_washout::interface::StrategyKind;

use crate::learned_road::Kept;
use crate::progress::Progress;
use crate::recording::felt::FeltTable;
use crate::recording::{ConventionOptions, Conventions, FADE_IN, Recording, source, table};
use crate::setup_options::SetupOptions;
use crate::status::DOES_NOT_FIT;
use crate::text;
use crate::washout_fmu::WashoutFmu;
use crate::words;
pub use moris_analysis::bounds::{self, AxisBound};
use moris_analysis::host::check_predictive;
pub use moris_analysis::outcome::Outcome;
use moris_analysis::outcome::{counted, listed};
pub use moris_analysis::page;
pub(crate) use moris_analysis::page::simulator;
pub use moris_simulation::findings::{fit, fits_the_rig, is_better_than_rest};
pub use moris_simulation::{Simulation, measures};

/// Simulate recordings on a rig and report the quality of the cues
///
/// Prints the measures of each recording and writes files. NAME.outputs.csv has every input and
/// output at every sample, by the names of the FMU's variables. NAME.html is a self-contained page
/// with all curves and the moving platform. NAME.advice.toml has the parameters that the verdict
/// recommends, if it does. With several recordings, index.html lists the pages,
/// the worst first. If a recording cannot be used, the others are still simulated. Recordings fade
/// in from rest over 1 s; --fade-in changes it.
///
/// The exit status is 0 if every recording stays within the rig, and 1 if one could not
/// be simulated. The status is 3 if a safety unit or the actuator guard was active on one, with
/// the first parameters.
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    /// Recordings: CSV, also .csv.gz; - is standard input. The columns are time, the specific force
    /// ax, ay, az [m/s2] and the angular velocity wx, wy, wz [rad/s]. Columns apply to the rider's
    /// head, with x forward, y left, z up. Units in brackets in the header are read. Other names,
    /// units and axes are given by the options below
    #[arg(required = true, value_name = "RECORDING")]
    recordings: Vec<PathBuf>,

    #[command(flatten)]
    setup: SetupOptions,

    /// Parameters to compare with the first ones: files, shipped sets, or "strategies", the other
    /// strategies with the first parameters
    #[arg(long, alias = "against", value_name = "FILE|NAME|strategies")]
    compare: Vec<String>,

    /// Also simulate the predictive strategy with a preview of the recording's
    /// force, in s, at most 4
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    preview: Option<f64>,

    /// Also simulate the predictive strategy with a preview learned from earlier passes of the same
    /// road: the columns x and y, or latitude and longitude, are the position. A file, one for
    /// each vehicle and track, is read first and written at the end
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true)]
    learn: Option<Option<PathBuf>>,

    /// Motion that another washout computed for the recording, compared with these parameters: CSV
    /// with felt forces, poses of the platform or lengths of the legs. A folder has such a file for
    /// each recording, under the recording's name.
    /// docs/your-washout.md lists the columns. The motion is judged at the washout location, at the
    /// scale and on the rig of the first parameters
    #[arg(long, value_name = "FILE")]
    felt: Vec<PathBuf>,

    /// Another washout as an FMU for co-simulation of FMI 2.0 or 3.0, which is stepped through the
    /// recording. Its poses, legs or felt forces are judged as those of --felt
    #[arg(long, value_name = "FMU", requires = "map")]
    washout: Option<PathBuf>,

    /// Map of the inputs and outputs of --washout, in TOML. docs/your-washout.md has an example
    #[arg(long, value_name = "FILE", requires = "washout")]
    map: Option<PathBuf>,

    /// Directory for the reports and the tables of outputs
    #[arg(long, value_name = "DIRECTORY", default_value = crate::REPORT_DIRECTORY)]
    report: PathBuf,

    /// Do not compute the bound, the least error that any controller could reach. The bound takes
    /// some seconds a recording
    #[arg(long)]
    no_bound: bool,

    /// Print the measures as JSON, an array with an object for each recording; `moris schema
    /// simulation` describes it
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    conventions: ConventionOptions,
}

/// Simulates the recordings.
///
/// # Errors
/// The rig, the parameters or an option cannot be used, or standard output cannot be written.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    let cases = compared_cases(options)?;
    let conventions = options.conventions.load_or_fade_in(FADE_IN)?.with_position(options.learn.is_some());
    let recordings = table::recordings(&options.recordings, &conventions);
    if let Some(file) = options.felt.iter().find(|felt| recordings.len() > 1 && !felt.is_dir()) {
        bail!(text!["one-file-for-many", file = file.display().to_string(), count = recordings.len()]);
    }
    check_names(&recordings, &cases)?;
    if !simulator::is_compiled() {
        eprintln!("note: the reports only show. {MODULE_REMEDY}");
    }
    let mut road = Kept::open(options.learn.as_ref().and_then(Option::as_deref))?;
    let mut entries = Vec::new();
    let (mut all_fit, mut any_failed, mut needs_change) = (true, false, false);
    let mut objects = Vec::new();
    for file in &recordings {
        let simulated = match simulate_recording(options, file, &cases, &conventions, &mut road) {
            Ok(simulated) => simulated,
            Err(error) => {
                let reason = words::with_causes(&error);
                eprintln!("error: {reason}");
                entries.push(vec![index::Entry::failed(source::name(file), reason)]);
                any_failed = true;
                continue;
            }
        };
        all_fit &= simulated.fits;
        needs_change |= simulated.needs_change;
        entries.push(simulated.entries);
        if options.json {
            objects.push(simulated.json);
            continue;
        }
        write!(out, "{}", simulated.text)?;
        for file in simulated.files {
            writeln!(out, "wrote {}", file.display())?;
        }
        writeln!(out)?;
    }
    road.save()?;
    if needs_change && !options.json {
        writeln!(out, "{}\n", words::WHICH_COMMAND)?;
    }
    if entries.len() > 1 {
        let names = listed(cases.iter().map(|case| case.setup.parameters_name.as_str()));
        fs::create_dir_all(&options.report).with_context(|| format!("cannot make {}", options.report.display()))?;
        let file = index::write(&options.report, &cases[0].setup.rig_name, &names, entries)?;
        if !options.json {
            writeln!(out, "wrote {}", file.display())?;
        }
    }
    if options.json {
        writeln!(out, "{:#}", serde_json::to_value(objects)?)?;
    }
    Ok(match (any_failed, all_fit) {
        (true, _) => ExitCode::FAILURE,
        (false, false) => ExitCode::from(DOES_NOT_FIT),
        (false, true) => ExitCode::SUCCESS,
    })
}

/// Parameters on a rig, and where the motion that is judged comes from.
struct Case {
    setup: Setup,
    origin: Origin,
}

enum Origin {
    /// The washout, with a preview of this length \[s\]; 0: none.
    Washout(f64),
    /// The washout, with a preview that is learned.
    Learned,
    /// A file with another washout's motion, or a folder with one for each recording.
    Felt(PathBuf),
    /// Another washout as an FMU.
    Fmu(WashoutFmu),
}

impl Case {
    fn of(setup: Setup) -> Self {
        Case { setup, origin: Origin::Washout(0.0) }
    }

    fn outcome(&self, recording: &Recording, learned: Option<&Previewer>, progress: impl FnMut()) -> Result<Outcome> {
        let judged = |file: &Path, motion: Result<(ForeignMotion, Vec<String>)>| {
            let judged = motion.and_then(|(motion, notes)| {
                Ok(Outcome::foreign(recording, &self.setup, &self.setup.parameters_name, &motion, notes)?)
            });
            judged.with_context(|| file.display().to_string())
        };
        match &self.origin {
            Origin::Washout(preview) => {
                let previewer = Previewer::of(&recording.manoeuvre, *preview);
                Ok(Outcome::of(recording, &self.setup, previewer, progress)?.advised(recording, *preview)?)
            }
            Origin::Learned => Ok(Outcome::of(recording, &self.setup, learned.cloned(), progress)?),
            Origin::Felt(file) => {
                let in_folder = file.is_dir().then(|| file.join(format!("{}.csv", recording.name)));
                let file = in_folder.as_ref().unwrap_or(file);
                let motion = || FeltTable::read(file)?.motion(recording).map_err(anyhow::Error::msg);
                judged(file, motion())
            }
            Origin::Fmu(fmu) => judged(&fmu.file, fmu.motion(recording).map_err(anyhow::Error::from)),
        }
    }
}

/// The parameters, the ones to compare, again those of the predictive strategy with the preview,
/// and the motions of other washouts.
fn compared_cases(options: &Options) -> Result<Vec<Case>> {
    // Value of `--compare` that means every other strategy.
    const ALL_STRATEGIES: &str = "strategies";
    let first = options.setup.load()?;
    let named = |file: &Path| Setup { parameters_name: source::name(file), ..first.clone() };
    let fmu = options.washout.as_ref().zip(options.map.as_ref());
    let fmu = fmu.map(|(file, map)| WashoutFmu::with_map(file, map)).transpose()?;
    let fmu = fmu.map(|fmu| Case { setup: named(&fmu.file), origin: Origin::Fmu(fmu) });
    let felt = options.felt.iter().map(|file| Case { setup: named(file), origin: Origin::Felt(file.clone()) });
    let judged: Vec<Case> = felt.chain(fmu).collect();
    let mut cases = vec![Case::of(first)];
    for other in &options.compare {
        if other == ALL_STRATEGIES {
            let own = cases[0].setup.parameters.structure.strategy;
            let others = StrategyKind::ALL.iter().filter(|kind| **kind != own);
            let with = |kind: &StrategyKind| SetupOptions { strategy: Some(*kind), ..options.setup.clone() }.load();
            cases.extend(others.map(with).collect::<Result<Vec<_>, _>>()?.into_iter().map(Case::of));
            continue;
        }
        let setup = Setup::load(options.setup.rig.as_deref(), std::slice::from_ref(other))?;
        cases.push(Case::of(setup));
    }
    cases.extend(previewed_cases(options, &cases)?);
    cases.extend(judged);
    Ok(cases)
}

/// The parameters of the predictive strategy with the previews that are asked for.
fn previewed_cases(options: &Options, cases: &[Case]) -> Result<Vec<Case>> {
    let preview = options.preview.filter(|&seconds| seconds > 0.0);
    let predictive: Vec<&Case> =
        cases.iter().filter(|case| case.setup.parameters.structure.strategy == StrategyKind::Predictive).collect();
    for (option, is_given) in [("preview", preview.is_some()), ("learn", options.learn.is_some())] {
        if is_given && predictive.is_empty() {
            check_predictive(option, cases[0].setup.parameters.structure.strategy)?;
        }
    }
    let with = |Case { setup, .. }: &Case, origin: Origin, preview: &str| {
        let parameters_name = format!("{}, {preview}", setup.parameters_name);
        Case { setup: Setup { parameters_name, ..setup.clone() }, origin }
    };
    let previewed = predictive.into_iter().flat_map(|case| {
        let ahead = preview.map(|seconds| with(case, Origin::Washout(seconds), &format!("preview of {seconds} s")));
        let learned = options.learn.is_some().then(|| with(case, Origin::Learned, "learned preview"));
        ahead.into_iter().chain(learned)
    });
    Ok(previewed.collect())
}

/// A recording's results, ready to be printed.
struct Simulated {
    /// The recording fits the rig with the first parameters.
    fits: bool,
    /// The verdict with the first parameters is not that nothing is wrong.
    needs_change: bool,
    text: String,
    json: json::SimulatedRecording,
    files: Vec<PathBuf>,
    entries: Vec<index::Entry>,
}

/// Simulates a recording with each of the setups, and writes its files.
fn simulate_recording(
    options: &Options,
    file: &Path,
    cases: &[Case],
    conventions: &Conventions,
    road: &mut Kept,
) -> Result<Simulated> {
    let mut progress = Progress::new(&source::name(file), "reading")?;
    let recording = Recording::read(file, conventions)?;
    let learned = options.learn.is_some().then(|| road.learn(&recording)).transpose()?;
    let outcomes = simulated_outcomes(&recording, cases, learned.as_ref(), !options.no_bound, &mut progress)
        .with_context(|| recording.name.clone())?;
    progress.phase("writing the report", 0);
    fs::create_dir_all(&options.report).with_context(|| format!("cannot make {}", options.report.display()))?;
    let files = write_files(&options.report, file, &recording, &outcomes, &cases[0].setup)?;
    progress.finish();
    let json = json::recording(&recording, &outcomes, &files);
    let page = files.last().map(PathBuf::as_path).unwrap_or(file);
    let entries = index::Entry::of_recording(&recording, &outcomes, page);
    Ok(Simulated {
        fits: fits_the_rig(&outcomes[0].measures),
        needs_change: outcomes[0].evaluated().fault().is_some(),
        text: summary::text(&recording, &outcomes),
        json,
        files,
        entries,
    })
}

fn simulated_outcomes(
    recording: &Recording,
    cases: &[Case],
    learned: Option<&Previewer>,
    with_bounds: bool,
    progress: &mut Progress,
) -> Result<Vec<Outcome>> {
    progress.phase("simulating", (recording.inputs().len() * cases.len()) as u64);
    let mut outcomes: Vec<Outcome> =
        cases.iter().map(|case| case.outcome(recording, learned, || progress.step())).collect::<Result<_>>()?;
    if with_bounds {
        progress.phase("computing the bound", 0);
        for index in 0..outcomes.len() {
            // The bound does not depend on a preview.
            let is_same = |other: &&Outcome| other.setup.parameters == outcomes[index].setup.parameters;
            outcomes[index].bounds = match outcomes[..index].iter().find(is_same) {
                Some(same) => same.bounds.clone(),
                None => bounds::bounds(&outcomes[index].simulation)
                    .context("cannot compute the bound (--no-bound omits it)")?,
            };
        }
    }
    Ok(outcomes)
}

/// File name of the outputs with one of the setups: the recording's for the first, with the
/// parameters' name for others.
fn table_name(recording: &str, index: usize, setup: &Setup) -> String {
    match index {
        0 => format!("{recording}.outputs.csv"),
        _ => {
            let set = setup.parameters_name.replace(", ", "-").replace(" + ", "+").replace(' ', "-");
            format!("{recording}.{set}.outputs.csv")
        }
    }
}

/// Checks that tables and pages have different names, none of them a recording's.
///
/// # Errors
/// Two of them would be written into one file, or one over a recording.
fn check_names(recordings: &[PathBuf], cases: &[Case]) -> Result<()> {
    let mut tables = BTreeMap::new();
    for file in recordings {
        let (stem, recording) = (source::name(file), file.display().to_string());
        for (index, case) in cases.iter().enumerate() {
            let name = table_name(&stem, index, &case.setup);
            if recordings.iter().any(|recording| recording.file_name().is_some_and(|file| file == name.as_str())) {
                bail!(text!["recording-is-output", name, recording]);
            }
            match tables.insert(name.clone(), file) {
                Some(other) if other == file => bail!(text!["output-twice", recording, name]),
                Some(other) => bail!(text!["output-of-two", other = other.display().to_string(), recording, name]),
                None => (),
            }
        }
    }
    Ok(())
}

/// Writes the tables of outputs, the parameters that the first verdict recommends in place of the
/// setup's, and the page; returns their names.
fn write_files(
    directory: &Path,
    file: &Path,
    recording: &Recording,
    outcomes: &[Outcome],
    setup: &Setup,
) -> Result<Vec<PathBuf>> {
    let mut written = Vec::new();
    for (index, outcome) in outcomes.iter().enumerate() {
        let file = directory.join(table_name(&recording.name, index, &outcome.setup));
        output_table::write(&file, &outcome.simulation)?;
        written.push(file);
    }
    if let Some(recommended) = outcomes[0].advice.as_ref().and_then(Advice::recommended) {
        let file = directory.join(format!("{}.advice.toml", recording.name));
        let Setup { rig_name, parameters_name, parameters, .. } = setup;
        let (name, changes) = (&recording.name, recommended.text());
        let heading = text!["heading-of-advice", name, rig_name, parameters_name, changes].to_string();
        let changed = Setup { parameters: recommended.changes.applied(parameters), ..setup.clone() };
        fs::write(&file, changed.parameter_file(&heading))
            .with_context(|| format!("cannot write {}", file.display()))?;
        written.push(file);
    }
    let command = command_line::with_other_parameters(file);
    written.push(write_page(directory, &recording.name, recording, outcomes, &command)?);
    Ok(written)
}

/// Writes the page of a recording under a name; returns the file. `command` simulates the recording
/// with a parameter file whose name is to follow.
///
/// # Errors
/// The file cannot be written.
pub fn write_page(
    directory: &Path,
    name: &str,
    recording: &Recording,
    outcomes: &[Outcome],
    command: &str,
) -> Result<PathBuf> {
    let file = directory.join(format!("{name}.html"));
    fs::write(&file, page::html(recording, outcomes, command, words::option))
        .with_context(|| format!("cannot write {}", file.display()))?;
    Ok(file)
}
