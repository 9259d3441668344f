//! The rows of the bench.

use std::path::{Path, PathBuf};

use moris_setup::{SHIPPED_RIGS, Setup, load_rig};
use moris_simulation::Simulation;
use moris_simulation::fit::{Aims, Search};
use moris_simulation::foreign::ForeignMotion;
use moris_simulation::measures::Axes;
use moris_washout::Parameters;
use moris_washout::interface::{AutomaticScale, StrategyKind};
use moris_washout::platform::Pose;

use super::columns::BENCH_COLUMNS;
use super::drives::{Drive, RATE_FRAME};
use crate::bounds::{self, AxisBound};
use crate::error::{About, Result};
use crate::message::Message;
use crate::outcome::Outcome;
use crate::recording::felt::FeltTable;
use crate::recording::{Recording, source};
use crate::washout_fmu::WashoutFmu;

/// Scale of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// The vehicle's force, unscaled.
    One,
    /// The scale of `moris fit`, which reaches its aims or comes nearest to them.
    Fit {
        /// On force and rates.
        factor: f64,
        /// True if it reaches them.
        fits: bool,
    },
    /// The automatic scale, from the vehicle's force on.
    Automatic {
        /// Mean of the scale over the drive.
        factor: f64,
    },
    /// The scale of another washout.
    Own,
}

/// A washout on a drive and a rig.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Name of the drive.
    pub drive: &'static str,
    /// Name of the rig.
    pub rig: &'static str,
    /// Name of the washout.
    pub washout: String,
    /// Scale of force and rates.
    pub scale: Scale,
    /// The measures, of [`BENCH_COLUMNS`].
    pub values: Vec<Option<f64>>,
    /// The least RMS errors of all rows of the drive on the rig \[m/s2\].
    pub best: [Option<f64>; 3],
    /// Remarks on another washout's motion, such as on its units or rate.
    pub remarks: Vec<String>,
}

impl Row {
    /// A measure by its name.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.values[BENCH_COLUMNS.iter().position(|column| column.name == name)?]
    }
}

/// Another washout.
#[derive(Clone, Debug)]
pub struct Foreign {
    name: String,
    source: Source,
}

/// Source of another washout's motion.
#[derive(Clone, Debug)]
enum Source {
    /// A folder of the motions that it computed.
    Folder(PathBuf),
    /// The washout as an FMU.
    Fmu(WashoutFmu),
}

impl Foreign {
    /// The folder, under its own name.
    pub fn of(folder: &Path) -> Self {
        let full = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
        let name = full.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Foreign { name, source: Source::Folder(folder.to_owned()) }
    }

    /// The FMU with its map, under the FMU's name.
    ///
    /// # Errors
    /// The map cannot be used.
    pub fn fmu(file: &Path, map: &Path) -> Result<Self> {
        Ok(Foreign { name: source::name(file), source: Source::Fmu(WashoutFmu::with_map(file, map)?) })
    }

    /// The file for a drive on a rig: that of the motion, or the FMU.
    pub fn file(&self, rig: &'static str, drive: &Drive) -> Option<PathBuf> {
        let name = format!("{}.csv", drive.name);
        match &self.source {
            Source::Folder(folder) => {
                [folder.join(rig).join(&name), folder.join(name)].into_iter().find(|file| file.is_file())
            }
            Source::Fmu(fmu) => Some(fmu.file.clone()),
        }
    }

    /// The motion for a drive, and sentences about it.
    fn motion(&self, file: &Path, recording: &Recording) -> Result<(ForeignMotion, Vec<String>)> {
        match &self.source {
            Source::Folder(_) => {
                let motion = FeltTable::read(file)?.motion(recording).map_err(Message::from);
                motion.about(|| file.display().to_string())
            }
            Source::Fmu(fmu) => fmu.motion(recording).about(|| file.display().to_string()),
        }
    }
}

/// Names of the bench's rigs: every shipped one with legs, by stroke, and a desk model and a
/// person's simulator with cranks.
pub fn rigs() -> impl Iterator<Item = &'static str> {
    SHIPPED_RIGS.iter().take(14).map(|(name, _)| *name)
}

/// The rows of a drive on a rig: a platform at rest, the strategies, and other washouts.
///
/// # Errors
/// A set cannot be used on the rig, or a motion cannot be judged.
pub fn rows(
    rig: &'static str,
    drive: &'static Drive,
    strategies: &[StrategyKind],
    foreign: &[Foreign],
) -> Result<Vec<Row>> {
    // Interval of the bound's controls [s].
    const BOUND_INTERVAL: f64 = 0.05;
    // Measures whose least is `Row::best`.
    const ERROR_MEASURES: [&str; 3] = ["RMS error x [m/s2]", "RMS error y [m/s2]", "RMS error z [m/s2]"];
    let of = || format!("{} on {}", drive.name, rig);
    let setup = load_rig(rig.as_ref()).map(|rig| Setup::unchecked(Some(rig), &[])).about(of)?;
    let recording = Recording::computed(&drive.name, drive.manoeuvre(), RATE_FRAME);
    let unscaled = recording.parameters(&with_unit_scale(&setup.parameters, StrategyKind::Classical));
    let asked = Simulation::without_outputs(&recording.manoeuvre, &unscaled);
    let bounds = bounds::bounds_at(&asked, BOUND_INTERVAL).about(of)?;
    let row = |washout: &str, scale: Scale, outcome: Outcome| bench_row(rig, drive, washout, scale, outcome, &bounds);
    let at_rest = at_rest(&recording, &Setup { parameters: unscaled, ..setup.clone() }).about(of)?;
    let mut rows = vec![row("at rest", Scale::One, at_rest)];
    let search = Search::new(&recording.manoeuvre, 0.0, Aims::default());
    for &strategy in strategies {
        let parameters = recording.parameters(&self::with_unit_scale(&setup.parameters, strategy));
        let simulated = |parameters: &Parameters| {
            let setup = Setup { parameters: *parameters, ..setup.clone() };
            Outcome::of(&recording, &setup, None, || ()).about(of)
        };
        let name = strategy.name();
        rows.push(row(name, Scale::One, simulated(&parameters)?));
        let found = search.fit(&parameters).about(of)?;
        let scale = Scale::Fit { factor: found.best.factors.scale, fits: found.fits };
        rows.push(row(name, scale, simulated(&found.best.factors.applied(&parameters))?));
        let mut automatic = parameters;
        automatic.automatic_scale.automatic = AutomaticScale::On;
        let outcome = simulated(&automatic)?;
        let outputs = &outcome.simulation.outputs;
        let factor = outputs.iter().map(|output| output.scale_factor).sum::<f64>() / outputs.len() as f64;
        rows.push(row(name, Scale::Automatic { factor }, outcome));
    }
    for other in foreign {
        let Some(file) = other.file(rig, drive) else { continue };
        let judge = || {
            let (motion, notes) = other.motion(&file, &recording)?;
            let setup = Setup { parameters: unscaled, ..setup.clone() };
            let outcome = Outcome::foreign(&recording, &setup, &other.name, &motion, notes);
            outcome.about(|| file.display().to_string())
        };
        let judged = judge().about(of)?;
        rows.push(row(&other.name, Scale::Own, judged));
    }
    let least = |name: &str| rows.iter().filter_map(|row| row.value(name)).reduce(f64::min);
    let best = ERROR_MEASURES.map(least);
    rows.iter_mut().for_each(|row| row.best = best);
    Ok(rows)
}

/// A strategy with the force as the vehicle's. The rates keep the scale of the rig's parameters.
fn with_unit_scale(parameters: &Parameters, strategy: StrategyKind) -> Parameters {
    let mut unscaled = *parameters;
    unscaled.structure.strategy = strategy;
    unscaled.conditioning.force_scale.fill(1.0);
    unscaled
}

/// The platform at rest at neutral.
fn at_rest(recording: &Recording, setup: &Setup) -> Result<Outcome> {
    let position = Pose::neutral(&setup.parameters.rig).position;
    let pose = vec![[position.x, position.y, position.z, 0.0, 0.0, 0.0]; recording.inputs().len()];
    let motion = ForeignMotion { pose: Some(pose), ..ForeignMotion::default() };
    Outcome::foreign(recording, setup, "at rest", &motion, Vec::new())
}

fn bench_row(
    rig: &'static str,
    drive: &'static Drive,
    washout: &str,
    scale: Scale,
    mut outcome: Outcome,
    bounds: &Axes<Option<AxisBound>>,
) -> Row {
    outcome.bounds.clone_from(bounds);
    let remarks = outcome.simulation.foreign.iter().flat_map(|foreign| foreign.remarks()).map(str::to_owned).collect();
    let values = BENCH_COLUMNS.iter().map(|column| (column.value)(&outcome.evaluated())).collect();
    Row { drive: &drive.name, rig, washout: washout.to_owned(), scale, values, best: [None; 3], remarks }
}
