//! Previews of the specific force, from arrays.

use moris_interface::Group;
use moris_washout::Preview;
use moris_washout::interface::PREVIEW_SAMPLES;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{numbers, wrong_shape};

/// The preview of a step without one.
pub const NO_PREVIEW: Preview = Preview::START;

/// Previews as of each sample.
pub struct Previews {
    /// Specific force along x and y, element by element, sample by sample \[m/s2\].
    forces: Vec<f64>,
    /// Elements of a preview.
    count: usize,
    /// Time from one element to the next \[s\].
    step: f64,
}

impl Previews {
    /// The previews of an array of shape (`rows`, K, 2), or (K, 2) for one sample. K is 20 at most.
    ///
    /// # Errors
    /// `RecordingError`: an array of another shape. `ValueError`: a step outside its range.
    pub fn of(array: &Bound<PyAny>, rows: Option<usize>, step: Option<f64>) -> PyResult<Self> {
        let step = step.unwrap_or(NO_PREVIEW.step);
        let (least, greatest) = step_range();
        if !(least..=greatest).contains(&step) {
            return Err(PyValueError::new_err(format!(
                "preview_step is {step} s, but must be from {least} to {greatest} s"
            )));
        }
        let py = array.py();
        let array = numbers(array, "preview")?;
        let shape = numpy::PyUntypedArrayMethods::shape(&*array);
        let count = match (rows, shape) {
            (None, [count, 2]) => Some(*count),
            (Some(rows), [found, count, 2]) if *found == rows => Some(*count),
            _ => None,
        };
        let Some(count) = count.filter(|count| *count <= PREVIEW_SAMPLES) else {
            let rows = rows.map_or(String::new(), |rows| format!("{rows}, "));
            let expected = format!("({rows}K, 2), K at most {PREVIEW_SAMPLES}: elements, each along x and y");
            return Err(wrong_shape(py, "preview", shape, &expected));
        };
        Ok(Previews { forces: array.as_slice()?.to_vec(), count, step })
    }

    /// The preview as of a sample.
    pub fn at(&self, sample: usize) -> Preview {
        let mut preview = Preview { count: self.count as i32, step: self.step, ..NO_PREVIEW };
        let first = 2 * self.count * sample;
        for (k, force) in self.forces[first..first + 2 * self.count].chunks_exact(2).enumerate() {
            [preview.surge[k], preview.sway[k]] = [force[0], force[1]];
        }
        preview
    }
}

/// The range of the time between elements \[s\].
fn step_range() -> (f64, f64) {
    let row = Preview::ROWS.iter().find(|row| row.array_name() == "vehicle.preview.step");
    row.map_or((0.0, f64::INFINITY), moris_interface::Row::bounds)
}
