//! Motion that another washout computed, from arrays, tables and files.

use std::path::PathBuf;

use moris_analysis::recording::Recording;
use moris_analysis::recording::felt::{FeltTable, Part};
use moris_simulation::foreign::ForeignMotion;
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::arrays::{numbers, values, wrong_shape};
use crate::error;

/// The motion of `felt_force`, `felt_rate`, `pose` and `legs`, and sentences about interpolations.
///
/// # Errors
/// `RecordingError`: a part has another shape than the recording needs, or no such columns.
pub fn motion(
    py: Python,
    parts: &[Option<Bound<PyAny>>; 4],
    recording: &Recording,
) -> PyResult<(ForeignMotion, Vec<String>)> {
    let [force, rate, pose, legs] = parts;
    let mut notes = Vec::new();
    let mut of_table = |part: Part, given: &Bound<PyAny>| -> PyResult<Option<ForeignMotion>> {
        let refused = |reason: String| error::recording(py, reason);
        let table = if given.hasattr("__fspath__")? {
            let file: PathBuf = given.extract()?;
            FeltTable::read(&file).map_err(|reason| refused(reason.to_string()))?
        } else if is_table(given)? {
            let columns: Vec<(String, Bound<PyAny>)> = given.extract()?;
            let column =
                |(title, array): (String, Bound<PyAny>)| Ok((title.clone(), values(&array, &title, None, None)?));
            let columns = columns.into_iter().map(column).collect::<PyResult<Vec<_>>>()?;
            FeltTable::of_columns("", &columns).map_err(|reason| refused(reason.to_string()))?
        } else {
            return Ok(None);
        };
        let prefix = if table.name.is_empty() { String::new() } else { format!("{}: ", table.name) };
        let (motion, of_part) = table.part(part, recording).map_err(|reason| refused(format!("{prefix}{reason}")))?;
        notes.extend(of_part);
        Ok(Some(motion))
    };
    let samples = recording.inputs().len();
    let mut motion = ForeignMotion::default();
    if let Some(given) = force {
        motion.force = match of_table(Part::Force, given)? {
            Some(part) => part.force,
            None => Some(rows(given, "felt_force", samples)?),
        };
    }
    if let Some(given) = rate {
        motion.rate = match of_table(Part::Rate, given)? {
            Some(part) => part.rate,
            None => Some(rows(given, "felt_rate", samples)?),
        };
    }
    if let Some(given) = pose {
        motion.pose = match of_table(Part::Pose, given)? {
            Some(part) => part.pose,
            None => Some(rows(given, "pose", samples)?),
        };
    }
    if let Some(given) = legs {
        motion.legs = match of_table(Part::Legs, given)? {
            Some(part) => part.legs,
            None => Some(rows(given, "legs", samples)?),
        };
    }
    Ok((motion, notes))
}

/// True for a list of pairs of name and array.
fn is_table(given: &Bound<PyAny>) -> PyResult<bool> {
    let Ok(list) = given.cast::<PyList>() else { return Ok(false) };
    Ok(list.iter().all(|pair| pair.extract::<(String, Bound<PyAny>)>().is_ok()))
}

/// The rows of an array with `N` columns, and as many rows as the recording has samples, or a whole
/// number of rows to each of its steps.
fn rows<const N: usize>(given: &Bound<PyAny>, name: &str, samples: usize) -> PyResult<Vec<[f64; N]>> {
    let array = numbers(given, name)?;
    let shape = array.shape();
    let steps = samples - 1;
    let is_whole = |count: usize| count >= samples && (count - 1).is_multiple_of(steps);
    if shape.len() != 2 || shape[1] != N || !is_whole(shape[0]) {
        let transposed =
            if shape.len() == 2 && shape[0] == N && shape[1] != N { "; transpose it: a row a sample" } else { "" };
        let expected = format!(
            "({samples}, {N}), a row for each sample of the recording, or (n * {steps} + 1, {N}) for n rows a step; a table with a \
             column time is interpolated{transposed}"
        );
        return Err(wrong_shape(given.py(), name, shape, &expected));
    }
    let rows = array.as_slice()?.chunks_exact(N).map(|row| std::array::from_fn(|k| row[k]));
    Ok(rows.collect())
}
