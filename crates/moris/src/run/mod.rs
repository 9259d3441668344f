//! `moris simulate`: simulates recordings on a rig and measures the felt motion.
//!
//! [`recording`] steps the washout; everything else looks at what came of it: [`output_table`] writes it down,
//! [`measured`] measures it, [`bounds`] says how much better it could have been, [`summary`] prints it, [`findings`] puts it in words, [`page`] makes the report.

pub mod bounds;
pub mod findings;
pub mod measured;
pub mod output_table;
pub mod page;
pub mod recording;
pub mod summary;

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use moris_measures::{Axes, Measures};
use moris_setup::Setup;

use crate::ride::{ConventionOptions, Ride};
use crate::setup_options::SetupOptions;
pub use bounds::AxisBound;
pub use recording::Recording;

/// Simulate recordings on a rig and report the cue quality
///
/// Prints the measures of each recording and writes two files into the report's directory. RECORDING.outputs.csv has every
/// input and output at every sample, under the names of the FMU's variables. RECORDING.html is one page with all charts and
/// the moving platform; it needs no network and no other files.
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    /// Recordings (CSV) with columns time, ax, ay, az (specific force, m/s2) and wx, wy, wz (rad/s) at the rider's head, x
    /// forward, y left, z up; the options below give other names, units and axes
    #[arg(required = true, value_name = "RECORDING")]
    rides: Vec<PathBuf>,

    #[command(flatten)]
    setup: SetupOptions,

    /// Further parameters to compare with: files or presets
    #[arg(long, alias = "against", value_name = "FILE|NAME")]
    compare: Vec<String>,

    /// Directory for the reports and the tables of outputs
    #[arg(long, value_name = "DIRECTORY", default_value = "report")]
    report: PathBuf,

    /// Do not compute the bound, the least error that any controller could reach; it takes some seconds a recording
    #[arg(long)]
    no_bound: bool,

    #[command(flatten)]
    conventions: ConventionOptions,
}

/// A simulation with one set of parameters, and its measures.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The rig and the parameters.
    pub setup: Setup,
    /// All inputs and outputs.
    pub recording: Recording,
    /// The measures.
    pub measures: Measures,
    /// The bound, axis by axis; none without a desired signal or if not requested.
    pub bounds: Axes<Option<AxisBound>>,
}

impl Outcome {
    /// Simulates and measures. `progress` is called after each sample.
    ///
    /// # Errors
    /// The parameters cannot be used.
    pub fn of(ride: &Ride, setup: &Setup, progress: impl FnMut()) -> Result<Self> {
        let parameters = ride.parameters(&setup.parameters);
        let recording = Recording::of(ride, &parameters, progress)?;
        let measures = measured::measures(&recording)?;
        let bounds = [const { None }; 3];
        Ok(Outcome { setup: Setup { parameters, ..setup.clone() }, recording, measures, bounds })
    }

    /// The same with its bounds.
    ///
    /// # Errors
    /// The recording is too short, or the solver fails.
    pub fn with_bounds(mut self) -> Result<Self> {
        self.bounds =
            bounds::bounds(&self.recording).context("cannot compute the bound; --no-bound does without it")?;
        Ok(self)
    }
}

/// Runs the command.
///
/// # Errors
/// A recording, a rig or parameters that cannot be used, or a file that cannot be written.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    let mut setups = vec![options.setup.load()?];
    for other in &options.compare {
        setups.push(Setup::load(options.setup.rig.as_deref(), std::slice::from_ref(other))?);
    }
    check_names(&options.rides, &setups)?;
    let conventions = options.conventions.load()?;
    fs::create_dir_all(&options.report).with_context(|| format!("cannot make {}", options.report.display()))?;
    for file in &options.rides {
        let ride = Ride::read(file, &conventions)?;
        let outcomes = outcomes(&ride, &setups, !options.no_bound)?;
        write!(out, "{}", summary::text(&ride, &outcomes))?;
        for file in write_files(&options.report, &ride, &outcomes)? {
            writeln!(out, "wrote {}", file.display())?;
        }
        writeln!(out)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Simulates with each setup, with a progress bar on a terminal.
fn outcomes(ride: &Ride, setups: &[Setup], with_bounds: bool) -> Result<Vec<Outcome>> {
    let bar = ProgressBar::new((ride.inputs().len() * setups.len()) as u64);
    bar.set_style(ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %")?);
    bar.set_message(ride.name.clone());
    let ridden = setups.iter().map(|setup| Outcome::of(ride, setup, || bar.inc(1)));
    let outcomes = if with_bounds { ridden.map(|outcome| outcome?.with_bounds()).collect() } else { ridden.collect() };
    bar.finish_and_clear();
    outcomes
}

/// The name of the table of a ride's outputs with one of the setups: the first's is the ride's, those beside it are told apart by
/// their parameters.
fn table_name(ride: &str, index: usize, setup: &Setup) -> String {
    match index {
        0 => format!("{ride}.outputs.csv"),
        _ => format!("{ride}.{}.outputs.csv", setup.parameters_name),
    }
}

/// Checks that tables and pages have different names, none of them a recording's.
///
/// # Errors
/// Two of them would be written into one file, or one over a recording.
fn check_names(rides: &[PathBuf], setups: &[Setup]) -> Result<()> {
    let mut tables = BTreeMap::new();
    for ride in rides {
        let stem = Ride::name_of(ride);
        for (index, setup) in setups.iter().enumerate() {
            let name = table_name(&stem, index, setup);
            if rides.iter().any(|ride| ride.file_name().is_some_and(|file| file == name.as_str())) {
                bail!(
                    "{name} is both a recording and what the outputs of {} are to be written into; rename the recording",
                    ride.display()
                );
            }
            match tables.insert(name.clone(), ride) {
                Some(other) if other == ride => bail!(
                    "{} would be simulated twice, or with two --compare of the same name, and both written into {name}; name each once, \
                     and rename one of two parameter files of the same name",
                    ride.display()
                ),
                Some(other) => bail!(
                    "the outputs of {} and {} would both be written into {name}; rename one of them, or ride each with a --report \
                     of its own",
                    other.display(),
                    ride.display()
                ),
                None => (),
            }
        }
    }
    Ok(())
}

/// Writes the tables of outputs and the page; returns their names.
fn write_files(directory: &Path, ride: &Ride, outcomes: &[Outcome]) -> Result<Vec<PathBuf>> {
    let mut written = Vec::new();
    for (index, outcome) in outcomes.iter().enumerate() {
        let file = directory.join(table_name(&ride.name, index, &outcome.setup));
        output_table::write(&file, &outcome.recording)?;
        written.push(file);
    }
    written.push(write_page(directory, ride, outcomes)?);
    Ok(written)
}

/// Writes the page of a ride; returns its name.
///
/// # Errors
/// The file cannot be written.
pub fn write_page(directory: &Path, ride: &Ride, outcomes: &[Outcome]) -> Result<PathBuf> {
    let file = directory.join(format!("{}.html", ride.name));
    let html = moris_report::html(&page::report(ride, outcomes)).context("the report does not fit together")?;
    fs::write(&file, html).with_context(|| format!("cannot write {}", file.display()))?;
    Ok(file)
}
