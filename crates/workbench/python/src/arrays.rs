//! Arrays from Python: converted to 64-bit floats, their shapes checked.

use moris_interface::{Group, Reader, slots_of};
use moris_washout::Input;
use numpy::{PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::error;
use crate::setup::Given;

/// The times of samples.
pub enum Time {
    /// At equal steps \[s\].
    Equal(f64),
    /// The step after each sample \[s\].
    Steps(Vec<f64>),
}

impl Time {
    /// The times of an array that increases from sample to sample.
    fn of(py: Python, times: &[f64]) -> PyResult<Self> {
        // Steps of time that differ by less than this count as equal [fraction of a step].
        const STEP_TOLERANCE: f64 = 1e-6;
        let refused = |message: String| error::recording(py, message);
        if times.len() < 2 {
            return Err(refused(format!("time has {} samples; at least 2 are needed", times.len())));
        }
        let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if let Some(k) = steps.iter().position(|step| step.is_nan() || *step <= 0.0 || step.is_infinite()) {
            let (before, after) = (times[k], times[k + 1]);
            return Err(refused(format!("time[{}] is {after} s after {before} s; time must increase", k + 1)));
        }
        let mean = (times[times.len() - 1] - times[0]) / steps.len() as f64;
        let is_equal = |step: f64| {
            times.iter().enumerate().all(|(k, time)| (time - times[0] - k as f64 * step).abs() <= STEP_TOLERANCE * step)
        };
        // Times are mostly multiples of a step with few decimals: 0.01 and not 0.010000000000000002.
        let short = format!("{mean:.12e}").parse().unwrap_or(mean);
        Ok([short, mean].into_iter().find(|step| is_equal(*step)).map_or(Time::Steps(steps), Time::Equal))
    }

    /// The step after sample `k` \[s\].
    pub fn step(&self, k: usize) -> f64 {
        match self {
            Time::Equal(step) => *step,
            Time::Steps(steps) => steps[k],
        }
    }
}

/// The fields of [`Input`]: name, and number of elements of a vector.
pub const INPUT_FIELDS: [(&str, Option<usize>); 6] = [
    ("specific_force", Some(3)),
    ("angular_velocity", Some(3)),
    ("orientation", Some(3)),
    ("speed", None),
    ("lean", None),
    ("engaged", None),
];

/// End of the message of an input that is NaN.
pub const NAN_REMEDY: &str = "; fill the gap, or take NaN as rest with nan=\"rest\"";

/// The samples' times and inputs, of an array for each of [`INPUT_FIELDS`].
///
/// # Errors
/// `RecordingError`: an array has another shape or holds NaN that does not count as rest, or time
/// does not increase.
pub fn samples(time: &Bound<PyAny>, arrays: [Given; 6], nan_is_rest: bool) -> PyResult<(Vec<f64>, Time, Vec<Input>)> {
    let times = values(time, "time", None, None)?;
    let steps = Time::of(time.py(), &times)?;
    let rest = slots_of(&Input::default());
    let mut rows = rest.repeat(times.len());
    let mut first = 0;
    for ((name, columns), array) in INPUT_FIELDS.into_iter().zip(arrays) {
        let slots = first..first + columns.unwrap_or(1);
        first = slots.end;
        let Some(array) = array else { continue };
        let values = values(array, name, Some(times.len()), columns)?;
        if !nan_is_rest {
            check_numbers(array.py(), &values, name, columns)?;
        }
        for (row, sample) in rows.chunks_exact_mut(rest.len()).zip(values.chunks_exact(slots.len())) {
            row[slots.clone()].copy_from_slice(sample);
        }
    }
    let inputs = rows.chunks_exact(rest.len()).map(|row| Input::read(&mut Reader::new(row))).collect();
    Ok((times, steps, inputs))
}

/// Checks that no value is NaN.
fn check_numbers(py: Python, values: &[f64], name: &str, columns: Option<usize>) -> PyResult<()> {
    let Some(place) = values.iter().position(|value| value.is_nan()) else { return Ok(()) };
    let place = columns.map_or_else(|| place.to_string(), |count| format!("{}, {}", place / count, place % count));
    Err(error::recording(py, format!("{name}[{place}] is NaN{NAN_REMEDY}")))
}

/// Times, values row by row, and the names of the columns.
pub type Series<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>, Vec<String>);

/// A row of values for each time.
///
/// # Errors
/// There are not as many values.
pub fn series(py: Python, times: Vec<f64>, values: Vec<f64>, names: Vec<String>) -> PyResult<Series> {
    let shape = [times.len(), names.len()];
    Ok((PyArray1::from_vec(py, times), PyArray1::from_vec(py, values).reshape(shape)?, names))
}

/// Columns with their names, whose arrays have one dimension.
///
/// # Errors
/// As [`values`].
pub fn columns(given: Vec<(String, Bound<PyAny>)>) -> PyResult<Vec<(String, Vec<f64>)>> {
    let column = |(title, array): (String, Bound<PyAny>)| {
        let values = values(&array, &title, None, None)?;
        Ok((title, values))
    };
    given.into_iter().map(column).collect()
}

/// The values of an array of shape (`rows`,) or (`rows`, `columns`), row by row.
///
/// # Errors
/// `RecordingError`: no array of numbers, or of another shape.
pub fn values(array: &Bound<PyAny>, name: &str, rows: Option<usize>, columns: Option<usize>) -> PyResult<Vec<f64>> {
    let py = array.py();
    let array = numbers(array, name)?;
    let shape = array.shape();
    let fits = match columns {
        None => shape.len() == 1,
        Some(columns) => shape.len() == 2 && shape[1] == columns,
    };
    if !fits || rows.is_some_and(|rows| shape[0] != rows) {
        let rows = rows.map_or("N".to_owned(), |rows| rows.to_string());
        let expected = columns.map_or_else(|| format!("({rows},)"), |columns| format!("({rows}, {columns})"));
        let transposed = columns.is_some_and(|columns| shape.len() == 2 && shape[0] == columns && shape[1] != columns);
        let remedy = if transposed { "; transpose it: a row a sample" } else { "" };
        return Err(wrong_shape(py, name, shape, &format!("{expected}{remedy}")));
    }
    Ok(array.as_slice()?.to_vec())
}

/// A contiguous array of 64-bit floats with the object's numbers.
///
/// # Errors
/// `RecordingError`: no array of numbers.
pub fn numbers<'py>(object: &Bound<'py, PyAny>, name: &str) -> PyResult<PyReadonlyArrayDyn<'py, f64>> {
    let py = object.py();
    let numpy = py.import("numpy")?;
    let converted = numpy.call_method1("ascontiguousarray", (object, numpy.getattr("float64")?));
    let array = converted.map_err(|reason| error::recording(py, format!("{name} is no array of numbers: {reason}")))?;
    Ok(array.cast::<PyArrayDyn<f64>>()?.try_readonly()?)
}

/// The error of an array of another shape than the expected one.
pub fn wrong_shape(py: Python, name: &str, shape: &[usize], expected: &str) -> PyErr {
    let shape: Vec<String> = shape.iter().map(usize::to_string).collect();
    // A tuple of one has a comma in Python.
    let comma = if shape.len() == 1 { "," } else { "" };
    error::recording(py, format!("{name} has the shape ({}{comma}), but must have {expected}", shape.join(", ")))
}
