//! Tuning: the workbench's search, with progress and evaluations that may go to Python.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use moris_analysis::tune::cost::{Aim, Cost, Objective};
use moris_analysis::tune::error::TuneError;
use moris_analysis::tune::folds;
use moris_analysis::tune::search::{Budget, Evaluate, evaluate_here};
use moris_analysis::tune::space::{Space, group_named};
use moris_analysis::tune::summary::{self, Verdict};
use moris_analysis::tune::tested::{Tested, tune_tested};
use moris_analysis::tune::tuner::Tuner;
use moris_setup::{NamedValues, Setup, all, overlaid};
use moris_washout::Parameters;
use moris_washout::interface::TuningGroup;
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error;
use crate::recording::PyRecording;
use crate::setup::{self, Given};
use crate::washout::parameter_dict;
use crate::words::argument;

/// Result of a tuning: parameters, sets tried, summary, the first line, is it worse, was it
/// interrupted, and for each recording its name and errors before, tuned and unseen.
type Tuned<'py> = (Bound<'py, PyDict>, String, String, bool, bool, Vec<(String, f64, Option<f64>, Option<f64>)>);

/// Progress of a search: its name, the sets tried, and the least error.
type Progress = (String, usize, Option<f64>);

/// The fixed part of a tuning.
#[pyclass(frozen, module = "moris._moris", name = "Tuning")]
pub struct PyTuning {
    before: Setup,
    objectives: Vec<Objective>,
    held_out: usize,
    groups: Vec<TuningGroup>,
}

/// A cost as it is sent between machines: error of each channel, total error, fraction of the time
/// in violation, shake, jolt and peak, and their excess.
type Sent = ([f64; 6], f64, f64, [f64; 3], f64);

#[pymethods]
impl PyTuning {
    /// Prepares the search over `recordings`, of which the last `held_out` are not tuned on.
    #[new]
    #[allow(clippy::too_many_arguments)]
    fn new(
        py: Python,
        recordings: Vec<PyRef<PyRecording>>,
        held_out: usize,
        rig: Given,
        parameters: Given,
        strategy: Option<&str>,
        groups: Vec<String>,
        weights: [f64; 6],
        stroke_reserve: f64,
        comfort: [f64; 3],
        objective: &str,
    ) -> PyResult<Self> {
        let before = setup::load(py, rig, parameters, strategy)?;
        if !weights.iter().all(|weight| (0.0..=1e6).contains(weight)) || weights.iter().sum::<f64>() <= 0.0 {
            return Err(PyValueError::new_err(format!(
                "weights are {weights:?}, but must be six numbers, none below 0 and not all 0"
            )));
        }
        if !(stroke_reserve.is_finite() && stroke_reserve >= 0.0) {
            return Err(PyValueError::new_err(format!(
                "stroke_reserve is {stroke_reserve} m, but must not be below 0"
            )));
        }
        if !comfort.iter().all(|bound| *bound > 0.0) {
            return Err(PyValueError::new_err(format!(
                "comfort is {comfort:?}, but must be bounds of shake, jolt and peak above 0 m/s2"
            )));
        }
        let Some(aim) = Aim::named(objective) else {
            return Err(PyValueError::new_err(format!("objective is {objective}, but must be shape or error")));
        };
        let groups = groups.iter().map(|name| tuning_group(name)).collect::<PyResult<_>>()?;
        let objective = |recording: &PyRef<PyRecording>| {
            let objective = Objective::new((*recording.inner).clone(), &before.parameters, &weights, stroke_reserve);
            let objective = objective.map(|objective| objective.with_comfort_bounds(comfort).with_aim(aim));
            objective.map_err(|error| error::refused(py, &error, &all(&before.parameters)))
        };
        let objectives = recordings.iter().map(objective).collect::<PyResult<_>>()?;
        Ok(PyTuning { before, objectives, held_out, groups })
    }

    /// The costs of the recordings of these names with these parameters, or None if the
    /// parameters cannot be used.
    fn costs(&self, py: Python, names: Vec<String>, values: NamedValues) -> Option<Vec<Sent>> {
        let parameters = overlaid(&self.before.parameters, &values);
        let named = |name: &String| self.objectives.iter().find(|objective| objective.name() == name);
        let objectives: Vec<&Objective> = names.iter().filter_map(named).collect();
        let cost = |objective: &&Objective| objective.coarse_cost(&parameters).ok();
        let costs: Option<Vec<Cost>> = py.detach(|| objectives.iter().map(cost).collect());
        let sent = |cost: Cost| (cost.channels, cost.error, cost.violated, cost.comfort, cost.excess);
        Some(costs?.into_iter().map(sent).collect())
    }

    /// Searches. `observe(name, tried, error)` returns False to end it with the best so far.
    /// `patience` ends a search after this number of sets without a smaller error.
    /// `evaluate(names, values)` computes costs elsewhere, `parallel` of them at a time; without it
    /// they are computed here.
    #[allow(clippy::too_many_arguments)]
    fn run<'py>(
        &self,
        py: Python<'py>,
        evaluations: usize,
        seed: u64,
        folds: usize,
        patience: Option<usize>,
        observe: &Bound<PyAny>,
        evaluate: Option<Py<PyAny>>,
        parallel: usize,
    ) -> PyResult<Tuned<'py>> {
        // Time between two checks of progress and signals.
        const POLL_INTERVAL: Duration = Duration::from_millis(50);
        let interrupted = Arc::new(AtomicBool::new(false));
        let progress: Mutex<Option<Progress>> = Mutex::new(None);
        let failure: Mutex<Option<PyErr>> = Mutex::new(None);
        let elsewhere = evaluate.map(|function| remote_evaluation(function, &interrupted, &failure));
        let least_of: Mutex<(f64, usize)> = Mutex::new((f64::INFINITY, 0));
        let note = |name: &str, tried: usize, least: Option<f64>| {
            *lock_contents(&progress) = Some((name.to_owned(), tried, least));
            let mut best = lock_contents(&least_of);
            // A search that begins counts from the start again.
            if tried < best.1 || least.is_some_and(|least| least < best.0) {
                *best = (least.unwrap_or(f64::INFINITY), tried);
            }
            best.0.is_infinite() || patience.is_none_or(|patience| tried - best.1 < patience)
        };
        let observe: Py<PyAny> = observe.clone().unbind();
        let (tuned_on, _) = self.objectives.split_at(self.objectives.len() - self.held_out);
        let search = || {
            let tuner = Tuner {
                setup: &self.before,
                space: Space::of_recordings(&self.before.parameters, &self.groups, tuned_on),
                budget: Budget { evaluations, seed },
                evaluate: elsewhere.as_deref().unwrap_or(&evaluate_here),
                observe: &note,
                interrupted: Arc::clone(&interrupted),
                tried: AtomicUsize::new(0),
                show: &|_, _| (),
                so_far: Arc::default(),
            };
            self.tune(&tuner, folds)
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(parallel).build();
        let pool = pool.map_err(|reason| PyValueError::new_err(format!("no threads for the search: {reason}")))?;
        let mut keyboard = false;
        let done = py.detach(|| {
            thread::scope(|scope| {
                let searching = scope.spawn(|| pool.install(search));
                while !searching.is_finished() {
                    thread::park_timeout(POLL_INTERVAL);
                    let looked = Python::attach(|py| report_progress(py, &observe, lock_contents(&progress).take()));
                    match looked {
                        Ok(true) => (),
                        Ok(false) => interrupted.store(true, Ordering::Relaxed),
                        Err(error) => {
                            // Ctrl-C ends the search and keeps the best so far; any other error is the caller's.
                            keyboard |= Python::attach(|py| error.is_instance_of::<PyKeyboardInterrupt>(py));
                            if !keyboard {
                                lock_contents(&failure).get_or_insert(error);
                            }
                            interrupted.store(true, Ordering::Relaxed);
                        }
                    }
                }
                searching.join()
            })
        });
        if let Some(error) = lock_contents(&failure).take() {
            return Err(error);
        }
        let done = done.map_err(|_| PyValueError::new_err("the search ended in a panic; this is a defect of moris"))?;
        let Tested { setup: tuned, results, fraction } = done.map_err(|reason| {
            let is_infeasible = matches!(reason, TuneError::Infeasible(_));
            let class = if is_infeasible { "NoFeasibleParameters" } else { "ParameterError" };
            error::plain(py, class, &reason.worded(argument))
        })?;
        let was_interrupted = interrupted.load(Ordering::Relaxed);
        let text = summary::text(&self.before, &tuned, &results, fraction, was_interrupted, argument);
        let error = |cost: Option<Cost>| cost.map(|cost| cost.error);
        let errors = results
            .iter()
            .map(|result| (result.name.clone(), result.before.error, error(result.tuned), error(result.unseen)));
        Ok((
            parameter_dict(py, &tuned.parameters)?,
            text,
            summary::first_line(&results, fraction, argument),
            Verdict::of(&results, fraction) == Verdict::Worse,
            was_interrupted,
            errors.collect(),
        ))
    }
}

impl PyTuning {
    fn tune(&self, tuner: &Tuner, groups: usize) -> Result<Tested, TuneError> {
        let (tuned_on, held_out) = self.objectives.split_at(self.objectives.len() - self.held_out);
        let tuned_on: Vec<&Objective> = tuned_on.iter().collect();
        let held_out: Vec<&Objective> = held_out.iter().collect();
        tune_tested(tuner, &tuned_on, &held_out, &folds::folds(tuned_on.len(), groups))
    }
}

/// Evaluations by a function of Python. Its first exception ends the search.
fn remote_evaluation<'a>(
    function: Py<PyAny>,
    interrupted: &'a AtomicBool,
    failure: &'a Mutex<Option<PyErr>>,
) -> Box<Evaluate<'a>> {
    Box::new(move |objectives: &[&Objective], parameters: &Parameters| {
        let names: Vec<&str> = objectives.iter().map(|objective| objective.name()).collect();
        let sent = Python::attach(|py| -> PyResult<Option<Vec<Sent>>> {
            function.call1(py, (names, all(parameters)))?.extract(py)
        });
        match sent {
            Ok(Some(costs)) => Ok(costs.into_iter().map(received_cost).collect()),
            Ok(None) => Err(TuneError::Evaluation("the parameters cannot be used")),
            Err(error) => {
                lock_contents(failure).get_or_insert(error);
                interrupted.store(true, Ordering::Relaxed);
                Err(TuneError::Evaluation("the evaluation failed"))
            }
        }
    })
}

fn received_cost((channels, error, violated, comfort, excess): Sent) -> Cost {
    Cost { channels, error, violated, comfort, excess, ..Cost::default() }
}

/// Reports progress to Python and checks for signals. Returns false if the search is to end.
fn report_progress(py: Python, observe: &Py<PyAny>, progress: Option<Progress>) -> PyResult<bool> {
    py.check_signals()?;
    match progress {
        Some(progress) => observe.call1(py, progress)?.is_truthy(py),
        None => Ok(true),
    }
}

fn tuning_group(name: &str) -> PyResult<TuningGroup> {
    group_named(name).ok_or_else(|| {
        let names: Vec<_> = TuningGroup::ALL.iter().map(|group| group.name()).collect();
        let names = names.join(", ");
        PyValueError::new_err(format!("there is no group {name}; there are {names}"))
    })
}

/// The contents of a lock, also after a panic elsewhere.
fn lock_contents<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}
