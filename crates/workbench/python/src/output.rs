//! The outputs after a step, by name.

use std::sync::LazyLock;

use moris_interface::{Group, slot_count, slots_of};
use moris_washout::Output;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::variables::Variables;

/// Number of scalar outputs.
pub const OUTPUT_COUNT: usize = slot_count(Output::ROWS);

/// The outputs' names.
pub static VARIABLES: LazyLock<Variables> = LazyLock::new(|| Variables::of(Output::ROWS));

/// The outputs after a step, a mapping from the names of the FMU's variables to their values.
///
/// Single variables are numbers: `output["actuator[1].length"]` [m]. A vector is a tuple under the
/// name without its index or component: `output["actuator.length"]`, `output["platform.position"]`.
#[pyclass(frozen, mapping, module = "moris", name = "Output")]
pub struct PyOutput {
    slots: Vec<f64>,
}

impl From<&Output> for PyOutput {
    fn from(output: &Output) -> Self {
        PyOutput { slots: slots_of(output) }
    }
}

#[pymethods]
impl PyOutput {
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        VARIABLES.value(py, name, &self.slots)
    }

    fn __len__(&self) -> usize {
        OUTPUT_COUNT
    }

    fn __contains__(&self, name: &str) -> bool {
        VARIABLES.slots(name).is_ok()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        PyList::new(py, &VARIABLES.names)?.call_method0("__iter__")
    }

    /// The names of the single variables.
    fn keys(&self) -> Vec<&str> {
        VARIABLES.names.iter().map(String::as_str).collect()
    }

    /// The values of the single variables.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        (0..OUTPUT_COUNT).map(|slot| VARIABLES.scalar(py, slot, self.slots[slot])).collect()
    }

    /// Pairs of name and value of the single variables.
    fn items<'py>(&self, py: Python<'py>) -> PyResult<Vec<(&str, Bound<'py, PyAny>)>> {
        Ok(self.keys().into_iter().zip(self.values(py)?).collect())
    }

    fn __repr__(&self, py: Python) -> PyResult<String> {
        let pairs = PyDict::new(py);
        for (name, value) in self.items(py)? {
            pairs.set_item(name, value)?;
        }
        Ok(format!("Output({})", pairs.repr()?))
    }
}
