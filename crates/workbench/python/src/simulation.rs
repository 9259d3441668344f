//! Simulations of recordings, their measures and bounds.

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use moris_analysis::bounds::{self, AxisBound};
use moris_analysis::error::{Result, worded};
use moris_analysis::host::{Host, check_predictive};
use moris_analysis::learned_road::Kept;
use moris_analysis::message::Message;
use moris_analysis::outcome::Outcome;
use moris_analysis::page;
use moris_analysis::recording::Recording;
use moris_analysis::recording::preview::{LONGEST_PREVIEW, Previewer};
use moris_analysis::washout_fmu::WashoutFmu;
use moris_interface::{Group, guid, slots_of};
use moris_setup::Setup;
use moris_simulation::advice::Advice;
use moris_simulation::findings::fit;
use moris_simulation::foreign::ForeignMotion;
use moris_simulation::measures::{Axes, Row};
use moris_simulation::{Evaluated, Simulation};
use moris_washout::{Input, Output, Parameters, Washout};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arrays::{Series, series};
use crate::error;
use crate::judged;
use crate::parallel::on_all_cores;
use crate::recording::PyRecording;
use crate::setup::{self, Given};
use crate::variables::Variables;
use crate::washout::parameter_dict;
use crate::words::argument;

/// A measure for Python: subject, name, value, unit, definition, source.
type Measure = (String, &'static str, Option<f64>, &'static str, &'static str, &'static str);

/// A simulation as it is pickled beside its recording, behind the version:
///
/// - names of rig and parameters; the parameters, and those of the rig alone;
/// - step, inputs, outputs, and felt force within steps;
/// - whether the bound was computed;
/// - the motion of another washout, and the sentences about its reading;
/// - the length of the preview.
type State = (
    [String; 2],
    [Parameters; 2],
    f64,
    Vec<Input>,
    Vec<Output>,
    Vec<[f64; 3]>,
    bool,
    Option<(ForeignMotion, Vec<String>)>,
    f64,
);

/// A simulated recording.
#[pyclass(frozen, module = "moris._moris", name = "Simulation")]
pub struct PySimulation {
    recording: Arc<Recording>,
    outcome: Outcome,
    /// Motion of another washout in place of a simulation, and sentences about its reading.
    judged: Option<(ForeignMotion, Vec<String>)>,
    /// Length of the recording's own future that was previewed \[s\].
    preview: f64,
    /// What the verdict recommends, simulated when it is first asked for.
    advice: OnceLock<Option<Advice>>,
}

#[pymethods]
impl PySimulation {
    /// Simulates a recording with `preview` seconds of its own future, or with a preview that is
    /// learned by its position, and measures it.
    #[new]
    #[allow(clippy::too_many_arguments)]
    fn new(
        py: Python,
        recording: &PyRecording,
        rig: Given,
        parameters: Given,
        strategy: Option<&str>,
        bound: bool,
        preview: f64,
        learn: bool,
        road: Option<PathBuf>,
    ) -> PyResult<Self> {
        let setup = setup::load(py, rig, parameters, strategy)?;
        let host = host(preview)?;
        let refused = |reason: Message| PyValueError::new_err(reason.worded(argument));
        check_preview(&setup, preview).map_err(refused)?;
        check_learning(&setup, &recording.inner, preview, learn).map_err(refused)?;
        let recording = Arc::clone(&recording.inner);
        let learned = learn.then(|| py.detach(|| learned_preview(&recording, road.as_deref()))).transpose();
        let learned = learned.map_err(|reason| PyValueError::new_err(reason.with_sources(argument)))?;
        let outcome = py.detach(|| {
            let simulated = host.replay(&recording, &recording.parameters(&setup.parameters), learned)?;
            Outcome::measured(simulated, &setup)
        });
        let mut outcome = outcome.map_err(|reason| error::plain(py, "ParameterError", &worded(&reason, argument)))?;
        if bound {
            outcome.bounds = bounds_of(py, &outcome.simulation)?;
        }
        Ok(PySimulation { recording, outcome, judged: None, preview, advice: OnceLock::new() })
    }

    /// Judges the motion that another washout computed, or computes as an FMU with a map, with the
    /// bound if it is asked for.
    #[staticmethod]
    #[allow(clippy::too_many_arguments)]
    fn judged(
        py: Python,
        recording: &PyRecording,
        rig: Given,
        parameters: Given,
        name: &str,
        bound: bool,
        parts: [Option<Bound<PyAny>>; 4],
        washout: Option<[PathBuf; 2]>,
    ) -> PyResult<Self> {
        let setup = setup::load(py, rig, parameters, None)?;
        let recording = Arc::clone(&recording.inner);
        let (motion, notes) = match washout {
            Some([file, map]) => {
                py.detach(|| WashoutFmu::with_map(&file, &map)?.motion(&recording)).map_err(|reason| {
                    error::recording(py, format!("{}: {}", file.display(), reason.with_sources(argument)))
                })?
            }
            None => judged::motion(&parts, &recording)?,
        };
        let outcome = py.detach(|| Outcome::foreign(&recording, &setup, name, &motion, notes.clone()));
        let mut outcome = outcome.map_err(|reason| error::recording(py, worded(&reason, argument)))?;
        if bound {
            outcome.bounds = bounds_of(py, &outcome.simulation)?;
        }
        Ok(PySimulation { recording, outcome, judged: Some((motion, notes)), preview: 0.0, advice: OnceLock::new() })
    }

    /// The rig's and the parameters' names, the parameters, true if it fits; the measures, with the
    /// bound's where it was computed.
    #[allow(clippy::type_complexity)]
    fn judgement<'py>(&self, py: Python<'py>) -> PyResult<([&str; 2], Bound<'py, PyDict>, Option<bool>, Vec<Measure>)> {
        let setup = &self.outcome.setup;
        let evaluated = self.outcome.evaluated();
        let measure = |row: Row| (row.subject, row.name, row.value, row.unit, row.definition, row.source);
        let measures = evaluated.rows().into_iter().map(measure).collect();
        let names = [setup.rig_name.as_str(), &setup.parameters_name];
        let parameters = parameter_dict(py, &setup.parameters)?;
        Ok((names, parameters, fit(&evaluated), measures))
    }

    /// Verdict and findings, and all parameters that the verdict recommends.
    #[allow(clippy::type_complexity)]
    fn verdict<'py>(&self, py: Python<'py>) -> PyResult<(String, Vec<String>, Option<Bound<'py, PyDict>>)> {
        let advice = self.advice(py);
        let evaluated = Evaluated { advice, ..self.outcome.evaluated() };
        let findings = evaluated.findings().into_iter().map(|finding| finding.text).collect();
        let recommended = advice.and_then(Advice::recommended);
        let parameters = recommended.map(|one| parameter_dict(py, &one.parameters)).transpose()?;
        Ok((evaluated.verdict().text, findings, parameters))
    }

    /// The samples' times, the inputs and outputs row by row, and the names of the columns.
    fn samples<'py>(&self, py: Python<'py>) -> PyResult<Series<'py>> {
        let Simulation { inputs, outputs, .. } = &self.outcome.simulation;
        let slots = |(input, output)| slots_of::<Input>(input).into_iter().chain(slots_of::<Output>(output));
        let rows = inputs.iter().zip(outputs).flat_map(slots).collect();
        let names = [Input::ROWS, Output::ROWS].into_iter().flat_map(|rows| Variables::of(rows).names).collect();
        series(py, self.outcome.simulation.times(), rows, names)
    }

    /// Angular velocity that the vehicle's rider feels, in head axes.
    fn desired_rates<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rates = self.outcome.simulation.desired_rates();
        let flat = rates.iter().flat_map(|rate| [rate.x, rate.y, rate.z]).collect();
        PyArray1::from_vec(py, flat).reshape([rates.len(), 3])
    }

    #[allow(clippy::type_complexity)]
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (PyRecording, Bound<'py, PyBytes>))> {
        let Outcome { setup, simulation, bounds, .. } = &self.outcome;
        let state: State = (
            [setup.rig_name.clone(), setup.parameters_name.clone()],
            [setup.parameters, setup.rig_alone],
            simulation.step,
            simulation.inputs.to_vec(),
            simulation.outputs.clone(),
            simulation.felt_within_steps.iter().map(|felt| (*felt).into()).collect(),
            bounds.iter().any(Option::is_some),
            self.judged.clone(),
            self.preview,
        );
        let bytes = postcard::to_allocvec(&(guid::<Washout>(), state))
            .map_err(|reason| PyValueError::new_err(reason.to_string()))?;
        let recording = PyRecording { inner: Arc::clone(&self.recording) };
        Ok((py.get_type::<PySimulation>().getattr("_from_state")?, (recording, PyBytes::new(py, &bytes))))
    }

    #[staticmethod]
    fn _from_state(py: Python, recording: &PyRecording, state: &[u8]) -> PyResult<Self> {
        let refused = || PyValueError::new_err("the pickled simulation is damaged, or of another version of moris");
        let (version, body) = postcard::take_from_bytes::<String>(state).map_err(|_| refused())?;
        if version != guid::<Washout>() {
            return Err(refused());
        }
        let (names, parameters, step, inputs, outputs, felt, has_bounds, judged, preview): State =
            postcard::from_bytes(body).map_err(|_| refused())?;
        let [rig_name, parameters_name] = names;
        let [parameters, rig_alone] = parameters;
        let felt_within_steps = felt.into_iter().map(Into::into).collect();
        let setup = Setup { rig_name, parameters_name, parameters, rig_alone, actuator_diameter: None };
        let outcome = match &judged {
            Some((motion, notes)) => {
                Outcome::foreign(&recording.inner, &setup, &setup.parameters_name, motion, notes.clone())
            }
            None => {
                let inputs = inputs.into();
                let simulation = Simulation { step, parameters, inputs, outputs, felt_within_steps, foreign: None };
                Outcome::measured(simulation, &setup)
            }
        };
        let mut outcome = outcome.map_err(|_| refused())?;
        if has_bounds {
            outcome.bounds = bounds_of(py, &outcome.simulation)?;
        }
        Ok(PySimulation { recording: Arc::clone(&recording.inner), outcome, judged, preview, advice: OnceLock::new() })
    }

    /// The report's page, with other simulations of the same recording for comparison.
    fn html(&self, py: Python, others: Vec<PyRef<PySimulation>>) -> String {
        let advised = |one: &PySimulation| Outcome { advice: one.advice(py).cloned(), ..one.outcome.clone() };
        let outcomes: Vec<Outcome> =
            std::iter::once(advised(self)).chain(others.iter().map(|other| advised(other))).collect();
        let command = format!("cargo moris simulate {}.csv --parameters", self.recording.name);
        page::html(&self.recording, &outcomes, &command, argument)
    }
}

impl PySimulation {
    /// The simulated alternatives; none where nothing is wrong.
    fn advice(&self, py: Python) -> Option<&Advice> {
        // The parameters have been simulated already.
        let simulated = || self.outcome.alternatives(&self.recording, self.preview).ok().flatten();
        py.detach(|| self.advice.get_or_init(simulated)).as_ref()
    }
}

/// A host with a preview of the recording of this length \[s\].
///
/// # Errors
/// `ValueError`: longer than a preview can be.
pub fn host(preview: f64) -> PyResult<Host> {
    if !(0.0..=LONGEST_PREVIEW).contains(&preview) {
        return Err(PyValueError::new_err(format!(
            "preview is {preview} s, but must be from 0 to {LONGEST_PREVIEW} s"
        )));
    }
    Ok(Host { preview, ..Host::default() })
}

/// Checks that these parameters use a preview, where there is one.
///
/// # Errors
/// Why not, and the argument that helps.
pub fn check_preview(setup: &Setup, preview: f64) -> Result<(), Message> {
    if preview > 0.0 { check_predictive("preview", setup.parameters.structure.strategy) } else { Ok(()) }
}

/// The preview that a recording learns, and keeps in a file if there is one.
fn learned_preview(recording: &Recording, file: Option<&Path>) -> Result<Previewer> {
    let mut road = Kept::open(file)?;
    let learned = road.learn(recording)?;
    road.save()?;
    Ok(learned)
}

/// Checks that a preview can be learned, where one is asked for.
///
/// # Errors
/// Why not, and the argument that helps.
fn check_learning(setup: &Setup, recording: &Recording, preview: f64, learn: bool) -> Result<(), Message> {
    match learn {
        false => Ok(()),
        true if preview > 0.0 => Err("preview and learn exclude each other".into()),
        true if recording.road.is_none() => Err("the recording has no position; read it with position=True".into()),
        true => check_predictive("learn", setup.parameters.structure.strategy),
    }
}

fn bounds_of(py: Python, simulation: &Simulation) -> PyResult<Axes<Option<AxisBound>>> {
    on_all_cores(py, || bounds::bounds(simulation))?.map_err(|reason| error::bound(py, &reason))
}

/// The bound on surge, sway and heave: least RMS error, RMS of the desired signal, and felt
/// specific force of the best trajectory. None on an axis with no desired motion.
///
/// # Errors
/// `BoundError`: the recording is too short, or the solver fails.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn bound<'py>(
    py: Python<'py>,
    recording: &PyRecording,
    rig: Given,
    parameters: Given,
) -> PyResult<Vec<Option<(f64, f64, Bound<'py, PyArray1<f64>>)>>> {
    let Setup { parameters, .. } = setup::load(py, rig, parameters, None)?;
    let recording = &recording.inner;
    let simulation = Simulation::without_outputs(&recording.manoeuvre, &recording.parameters(&parameters));
    let bounds = bounds_of(py, &simulation)?;
    let times = simulation.times();
    let of = |bound: &Option<AxisBound>| {
        let bound = bound.as_ref()?;
        let felt = times.iter().map(|time| bound.bound.trajectory.felt(*time)).collect();
        Some((bound.bound.rms_error, bound.desired_rms(), PyArray1::from_vec(py, felt)))
    };
    Ok(bounds.iter().map(of).collect())
}

/// Every parameter by name, of a rig, presets and files put together.
///
/// # Errors
/// `ParameterError`: a name or a value cannot be used.
#[pyfunction]
pub fn parameter_values<'py>(
    py: Python<'py>,
    rig: Given,
    parameters: Given,
    strategy: Option<&str>,
) -> PyResult<Bound<'py, PyDict>> {
    parameter_dict(py, &setup::load(py, rig, parameters, strategy)?.parameters)
}

/// The text of a parameter file with these values over a rig's.
///
/// # Errors
/// As [`parameter_values`].
#[pyfunction]
pub fn parameter_file(py: Python, heading: &str, rig: Given, parameters: Given) -> PyResult<String> {
    Ok(setup::load(py, rig, parameters, None)?.parameter_file(heading))
}
