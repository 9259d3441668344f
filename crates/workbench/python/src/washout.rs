//! The class `Washout`.

use std::ffi::CString;

use moris_interface::{Group, Writer, guid, slot_count, slots_of};
use moris_setup::{all, overlaid};
use moris_washout::interface::{GravityRemoval, RollPitchYaw, STANDARD_GRAVITY};
use moris_washout::nalgebra::Vector3;
use moris_washout::{Input, MOST_INTERNAL_STEPS, Washout, input_warnings, warnings};
use pyo3::exceptions::{PyTypeError, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};

use crate::arrays::{INPUT_FIELDS, NAN_REMEDY, samples, series};
use crate::output::{OUTPUT_COUNT, PyOutput, VARIABLES};
use crate::preview::{self, Previews};
use crate::setup::Given;
use crate::variables::Variables;
use crate::{error, setup};

/// The washout filter on its platform: from the motion of a vehicle's rider to the
/// motion of a platform.
///
/// Frames: x forward, y left, z up. Roll, pitch and yaw are about x, y and z. All units are SI.
///
/// - rig: name of a shipped rig, path of a rig file, or a dict with its keys. None is the default
///   rig.
/// - parameters: name of a preset, path of a parameter file, dict of values by the names of the
///   FMU's variables, or a list of these. In a list, later ones override earlier ones.
/// - strategy: "classical", "adaptive", "optimal", "robust" or "predictive". The argument
///   sets the parameter `strategy` and no other. None is the parameters' strategy, by
///   default the predictive one.
///
/// Raises ParameterError for a name or a value that cannot be used. Doubtful ones, also in `retune`
/// and in the first input, are a UserWarning.
#[pyclass(module = "moris", name = "Washout", eq)]
#[derive(Clone, PartialEq)]
pub struct PyWashout {
    /// In a box, as Python aligns its objects to 16 bytes and a vector of four numbers needs 32.
    washout: Box<Washout>,
    /// False before the first step. There the input's lean and engagement apply at once.
    started: bool,
}

#[pymethods]
impl PyWashout {
    #[new]
    #[pyo3(signature = (rig=None, parameters=None, strategy=None))]
    fn new(py: Python, rig: Given, parameters: Given, strategy: Option<&str>) -> PyResult<Self> {
        let setup = setup::load(py, rig, parameters, strategy)?;
        let washout =
            Washout::new(&setup.parameters).map_err(|error| error::refused(py, &error, &all(&setup.parameters)))?;
        warn(py, warnings(&setup.parameters))?;
        Ok(PyWashout { washout: Box::new(washout), started: false })
    }

    /// Advances by `dt` seconds with one sample of input, and returns the outputs
    /// at the end of the step.
    ///
    /// - dt: length of the step [s].
    /// - specific_force: x, y, z at the rider's head, in head axes [m/s2]; (0, 0, 9.80665) at rest.
    /// - angular_velocity: x, y, z of the vehicle [rad/s], in the axes given by
    ///   `angularVelocityFrame`.
    /// - orientation: roll, pitch, yaw of the vehicle [rad]; positive pitch is nose down.
    /// - speed: forward [m/s].
    /// - lean: of the rider's torso, to the right [rad].
    /// - engaged: False returns the platform to neutral.
    /// - preview: (K, 2), the future x and y of specific_force [m/s2], with K at most 20. Element k
    ///   is that at k + 1 times preview_step after the step's start. Only the strategy "predictive"
    ///   uses it. The preview ends before the first element that is NaN.
    /// - preview_step: time between the elements of the preview, from 0.01 to 10 [s], by default
    ///   0.2.
    ///
    /// - nan: "error" raises ValueError where an input is NaN, before the step. "rest" takes NaN as
    ///   the value at rest.
    ///
    /// Within the step the input is interpolated from the last one to this one, or held, as
    /// `input.reconstruction` specifies. A value outside its range counts as the range's end.
    #[pyo3(signature = (dt, specific_force=None, angular_velocity=None, orientation=None, speed=0.0, lean=0.0, engaged=true, *, preview=None, preview_step=None, nan="error"))]
    #[allow(clippy::too_many_arguments)]
    fn step(
        &mut self,
        py: Python,
        dt: f64,
        specific_force: Given,
        angular_velocity: Given,
        orientation: Given,
        speed: f64,
        lean: f64,
        engaged: bool,
        preview: Given,
        preview_step: Option<f64>,
        nan: &str,
    ) -> PyResult<PyOutput> {
        self.check_step(dt)?;
        let nan_is_rest = is_second("nan", nan, ["error", "rest"])?;
        let input = Input {
            specific_force: vector_of(specific_force, "specific_force", [0.0, 0.0, STANDARD_GRAVITY])?,
            angular_velocity: vector_of(angular_velocity, "angular_velocity", [0.0; 3])?,
            orientation: RollPitchYaw::from_vector(vector_of(orientation, "orientation", [0.0; 3])?),
            speed,
            lean,
            engaged,
        };
        if !nan_is_rest {
            check_numbers(&input)?;
        }
        let preview = preview.map(|array| Previews::of(array, None, preview_step)).transpose()?;
        self.warn_of_first(py, &input)?;
        self.start(&input);
        self.washout.preview(&preview.map_or(preview::NO_PREVIEW, |preview| preview.at(0)));
        self.washout.step(&input, dt);
        Ok(PyOutput::from(&self.washout.output()))
    }

    /// Steps through arrays of N samples, and returns the outputs at each: Outputs
    /// with arrays of N rows.
    ///
    /// - time: (N,) [s], increasing.
    /// - specific_force: (N, 3) [m/s2].
    /// - angular_velocity: (N, 3) [rad/s].
    /// - orientation: (N, 3), roll, pitch, yaw [rad].
    /// - speed: (N,) [m/s].
    /// - lean: (N,) [rad].
    /// - engaged: (N,) bool.
    /// - preview: (N, K, 2), the future x and y of specific_force at each sample, as for step.
    /// - preview_step: time between the elements of the preview [s], by default 0.2.
    /// - inputs: "slopes" interpolates linearly between samples, as a host that sets input
    ///   derivatives. "values" sets each sample at the start of its step, as a host that sets none.
    /// - nan: "error" raises RecordingError with the first sample that is NaN, before any step.
    ///   "rest" takes NaN as the value at rest.
    ///
    /// The first row is the output before the first step. A further call continues from there; its
    /// first sample is the last one of the previous call. Other Python threads can run meanwhile.
    /// Raises RecordingError for arrays whose shapes do not match, and for a first call whose
    /// specific force is that of free fall most of the time: gravity belongs to it.
    #[pyo3(signature = (time, specific_force, angular_velocity=None, orientation=None, speed=None, lean=None, engaged=None, *, preview=None, preview_step=None, inputs="slopes", nan="error"))]
    #[allow(clippy::too_many_arguments)]
    fn run<'py>(
        &mut self,
        py: Python<'py>,
        time: &Bound<'py, PyAny>,
        specific_force: &Bound<'py, PyAny>,
        angular_velocity: Given<'_, 'py>,
        orientation: Given<'_, 'py>,
        speed: Given<'_, 'py>,
        lean: Given<'_, 'py>,
        engaged: Given<'_, 'py>,
        preview: Given<'_, 'py>,
        preview_step: Option<f64>,
        inputs: &str,
        nan: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let holds = is_second("inputs", inputs, ["slopes", "values"])?;
        let nan_is_rest = is_second("nan", nan, ["error", "rest"])?;
        let arrays = [Some(specific_force), angular_velocity, orientation, speed, lean, engaged];
        let (times, time, samples) = samples(time, arrays, nan_is_rest)?;
        let previews = preview.map(|array| Previews::of(array, Some(samples.len()), preview_step)).transpose()?;
        for k in 1..samples.len() {
            self.check_step(time.step(k - 1))?;
        }
        if !self.started {
            self.check_gravity(py, &samples)?;
        }
        self.warn_of_first(py, &samples[0])?;
        let rows = py.detach(|| {
            let mut rows = vec![0.0; samples.len() * OUTPUT_COUNT];
            let mut next = rows.chunks_exact_mut(OUTPUT_COUNT);
            let mut write = |washout: &Washout| {
                if let Some(row) = next.next() {
                    washout.output().write(&mut Writer::new(row));
                }
            };
            self.start(&samples[0]);
            write(&self.washout);
            self.washout.preview(&preview::NO_PREVIEW);
            for (k, pair) in samples.windows(2).enumerate() {
                if let Some(previews) = &previews {
                    self.washout.preview(&previews.at(k));
                }
                if holds {
                    self.washout.step(&pair[0], time.step(k));
                } else {
                    self.washout.step_between(&pair[0], &pair[1], time.step(k));
                }
                write(&self.washout);
            }
            rows
        });
        py.import("moris._outputs")?.getattr("Outputs")?.call1(series(py, times, rows, VARIABLES.names.clone())?)
    }

    /// Changes parameters in motion. The platform does not jump; the effect of the
    /// new parameters fades in.
    ///
    /// parameters: as for the constructor. Raises ParameterError for a name or a value that cannot
    /// be used, or if a fixed parameter would change. No parameter has then changed.
    fn retune(&mut self, py: Python, parameters: &Bound<PyAny>) -> PyResult<()> {
        let sets = setup::sets_of(parameters)?;
        let changed = sets.iter().fold(*self.washout.parameters(), |changed, (_, values)| overlaid(&changed, values));
        let before = warnings(self.washout.parameters());
        self.washout.retune(&changed).map_err(|error| error::refused(py, &error, &all(&changed)))?;
        warn(py, warnings(&changed).into_iter().filter(|text| !before.contains(text)))
    }

    /// The outputs now.
    #[getter]
    fn output(&self) -> PyOutput {
        PyOutput::from(&self.washout.output())
    }

    /// Every parameter by name, a dict. Enumerations are the names of their items.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        parameter_dict(py, self.washout.parameters())
    }

    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        VARIABLES.value(py, name, &slots_of(&self.washout.output()))
    }

    /// A washout in the same state.
    fn copy(&self) -> Self {
        self.clone()
    }

    fn __copy__(&self) -> Self {
        self.clone()
    }

    fn __deepcopy__(&self, _memo: &Bound<PyAny>) -> Self {
        self.clone()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let body = postcard::to_allocvec(&(guid::<Washout>(), self.started, &self.washout))
            .map_err(|reason| PyValueError::new_err(format!("the state cannot be written: {reason}")))?;
        Ok((py.get_type::<PyWashout>().getattr("_from_state")?, (PyBytes::new(py, &body),)))
    }

    #[staticmethod]
    fn _from_state(state: &[u8]) -> PyResult<Self> {
        let refused = |reason: &str| PyValueError::new_err(format!("the state of a washout is rejected: {reason}"));
        let (version, body) = postcard::take_from_bytes::<String>(state).map_err(|_| refused("it is damaged"))?;
        if version != guid::<Washout>() {
            return Err(refused("another version of moris wrote it; write it again with this one"));
        }
        let (started, washout) = postcard::from_bytes(body).map_err(|_| refused("it is damaged"))?;
        Ok(PyWashout { washout, started })
    }

    fn __repr__(&self) -> String {
        let parameters = self.washout.parameters();
        let started = if self.started { "True" } else { "False" };
        format!("Washout(strategy='{}', started={started})", parameters.structure.strategy.name())
    }
}

impl PyWashout {
    fn start(&mut self, input: &Input) {
        if !self.started {
            // The washout is cloned once: it is built anew from itself.
            *self.washout = self.washout.as_ref().clone().starting_with(input);
            self.started = true;
        }
    }

    /// Warns of doubts about the first input. One that is not engaged is meant so.
    fn warn_of_first(&self, py: Python, input: &Input) -> PyResult<()> {
        if self.started {
            return Ok(());
        }
        warn(py, input_warnings(self.washout.parameters(), &Input { engaged: true, ..*input }))
    }

    /// Refuses the specific force of a vehicle in free fall, unless it is an acceleration by the
    /// parameters.
    fn check_gravity(&self, py: Python, samples: &[Input]) -> PyResult<()> {
        // Medians of the specific force below this contain no gravity [m/s2]: a recording's, too.
        const NO_GRAVITY: f64 = 3.0;
        if self.washout.parameters().conditioning.gravity_removal == GravityRemoval::None {
            return Ok(());
        }
        let mut sizes: Vec<f64> = samples.iter().map(|sample| sample.specific_force.norm()).collect();
        let middle = sizes.len() / 2;
        let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
        if *median >= NO_GRAVITY {
            return Ok(());
        }
        let reason = format!(
            "specific_force is {median:.2} m/s2 most of the time, as in free fall: gravity has been taken out; add \
             (0, 0, {STANDARD_GRAVITY}), or set gravityRemoval to \"none\""
        );
        Err(error::recording(py, reason))
    }

    fn check_step(&self, dt: f64) -> PyResult<()> {
        let longest = MOST_INTERNAL_STEPS * self.washout.parameters().structure.max_step;
        if dt > 0.0 && dt <= longest {
            return Ok(());
        }
        Err(PyValueError::new_err(format!("dt is {dt} s, but must be above 0 and not above {longest} s")))
    }
}

/// Gives sentences as Python's warnings.
fn warn(py: Python, texts: impl IntoIterator<Item = String>) -> PyResult<()> {
    texts.into_iter().try_for_each(|text| PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(text)?, 1))
}

/// True if an argument is the second of the two words that it can be.
fn is_second(argument: &str, given: &str, words: [&str; 2]) -> PyResult<bool> {
    let place = words.iter().position(|word| *word == given);
    let [first, second] = words;
    let wrong = || PyValueError::new_err(format!("{argument} is {given:?}, but must be \"{first}\" or \"{second}\""));
    Ok(place.ok_or_else(wrong)? == 1)
}

/// Checks that no number of an input is NaN.
fn check_numbers(input: &Input) -> PyResult<()> {
    let mut slots = [0.0; slot_count(Input::ROWS)];
    input.write(&mut Writer::new(&mut slots));
    let of_field = |(name, columns): (&'static str, Option<usize>)| {
        (0..columns.unwrap_or(1)).map(move |k| (name, columns.map(|_| k)))
    };
    let mut places = INPUT_FIELDS.into_iter().flat_map(of_field).zip(slots);
    let Some(((name, place), _)) = places.find(|(_, value)| value.is_nan()) else { return Ok(()) };
    let place = place.map_or_else(String::new, |k| format!("[{k}]"));
    Err(PyValueError::new_err(format!("{name}{place} is NaN{NAN_REMEDY}")))
}

/// The vector of a sequence of three numbers.
fn vector_of(object: Given, name: &str, default: [f64; 3]) -> PyResult<Vector3<f64>> {
    let Some(object) = object else { return Ok(Vector3::from(default)) };
    let wrong = |_| PyTypeError::new_err(format!("{name} is {object}, but must be three numbers"));
    if let Ok(tuple) = object.cast::<PyTuple>()
        && tuple.len() == 3
    {
        let item = |k| tuple.get_borrowed_item(k)?.extract::<f64>().map_err(wrong);
        return Ok(Vector3::new(item(0)?, item(1)?, item(2)?));
    }
    object.extract::<[f64; 3]>().map(Vector3::from).map_err(wrong)
}

/// Parameters as a dict by name.
///
/// # Errors
/// Python is out of memory.
pub fn parameter_dict<'py, G: Group>(py: Python<'py>, parameters: &G) -> PyResult<Bound<'py, PyDict>> {
    let variables = Variables::of(G::ROWS);
    let dict = PyDict::new(py);
    for (slot, value) in slots_of(parameters).into_iter().enumerate() {
        dict.set_item(&variables.names[slot], variables.scalar(py, slot, value)?)?;
    }
    Ok(dict)
}
