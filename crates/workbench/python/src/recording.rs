//! Recordings: read by the workbench's import code.

use std::path::PathBuf;
use std::sync::Arc;

use moris_analysis::recording::{ConventionOptions, Conventions, Recording, RecordingError, Road};
use moris_interface::{Group, slots_of};
use moris_simulation::Manoeuvre;
use moris_washout::Input;
use moris_washout::interface::AngularVelocityFrame;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use toml::{Table, Value};

use crate::arrays::{Series, columns, series};
use crate::error;
use crate::setup::table;
use crate::variables::Variables;
use crate::words::argument;

/// A recording in the washout's frames and units.
#[pyclass(frozen, module = "moris._moris", name = "Recording")]
pub struct PyRecording {
    pub inner: Arc<Recording>,
}

/// A recording's fields, as they are pickled.
type State = (String, f64, Vec<Input>, f64, AngularVelocityFrame, bool, Option<Road>, Vec<String>);

#[pymethods]
impl PyRecording {
    /// Reads a CSV file.
    #[staticmethod]
    fn read(py: Python, file: PathBuf, options: &Bound<PyDict>) -> PyResult<Self> {
        let conventions = parse_conventions(options)?;
        let recording = py.detach(|| Recording::read(&file, &conventions));
        Self::of(py, recording)
    }

    /// Reads columns, pairs of name and array.
    #[staticmethod]
    fn of_columns(
        py: Python,
        name: &str,
        columns: Vec<(String, Bound<PyAny>)>,
        options: &Bound<PyDict>,
    ) -> PyResult<Self> {
        let conventions = parse_conventions(options)?;
        let columns = self::columns(columns)?;
        let recording = py.detach(|| Recording::of_columns(name, &columns, &conventions));
        Self::of(py, recording)
    }

    /// Name, step and duration \[s\], and warnings.
    fn facts(&self) -> (&str, f64, f64, Vec<String>) {
        (&self.inner.name, self.inner.step(), self.inner.manoeuvre.duration(), self.worded_warnings())
    }

    /// The samples' times, their inputs row by row, and the names of the inputs.
    fn samples<'py>(&self, py: Python<'py>) -> PyResult<Series<'py>> {
        let rows = self.inner.inputs().iter().flat_map(slots_of).collect();
        series(py, self.inner.times().collect(), rows, Variables::of(Input::ROWS).names)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let Recording { name, manoeuvre, start, angular_velocity_frame, has_orientation, road, .. } = &*self.inner;
        let warnings = self.worded_warnings();
        let inputs = manoeuvre.inputs();
        let state = (name, manoeuvre.step(), inputs, start, angular_velocity_frame, has_orientation, road, warnings);
        let bytes = postcard::to_allocvec(&state).map_err(|reason| error::recording(py, reason.to_string()))?;
        Ok((py.get_type::<PyRecording>().getattr("_from_state")?, (PyBytes::new(py, &bytes),)))
    }

    #[staticmethod]
    fn _from_state(py: Python, state: &[u8]) -> PyResult<Self> {
        let refused = |_| error::recording(py, "the pickled recording is of another version of moris".to_owned());
        let state: State = postcard::from_bytes(state).map_err(refused)?;
        let (name, step, inputs, start, angular_velocity_frame, has_orientation, road, warnings) = state;
        let manoeuvre = Manoeuvre::new(step, inputs);
        let warnings = warnings.into_iter().map(Into::into).collect();
        let recording = Recording { name, manoeuvre, start, angular_velocity_frame, has_orientation, road, warnings };
        Ok(PyRecording { inner: Arc::new(recording) })
    }
}

impl PyRecording {
    fn of(py: Python, recording: Result<Recording, RecordingError>) -> PyResult<Self> {
        let recording = recording.map_err(|reason| error::recording(py, reason.worded(argument)))?;
        Ok(PyRecording { inner: Arc::new(recording) })
    }

    fn worded_warnings(&self) -> Vec<String> {
        self.inner.warnings.iter().map(|warning| warning.worded(argument)).collect()
    }
}

/// Names, units and axes by the options' names, with underscores for hyphens.
fn parse_conventions(options: &Bound<PyDict>) -> PyResult<Conventions> {
    let py = options.py();
    // All numbers among the options are real.
    let real = |value| if let Value::Integer(number) = value { Value::Float(number as f64) } else { value };
    let given: Table = table(options)?.into_iter().map(|(name, value)| (name.replace('_', "-"), real(value))).collect();
    let refused = |message: String| error::recording(py, message);
    let options: ConventionOptions =
        toml::from_str(&given.to_string()).map_err(|error| refused(error.message().to_owned()))?;
    options.load().map_err(|error| refused(error.worded(argument)))
}
