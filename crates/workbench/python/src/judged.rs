//! Motion that another washout computed, from arrays, tables and files.

use std::path::PathBuf;

use moris_analysis::recording::Recording;
use moris_analysis::recording::felt::{FELT_FORCE, FELT_RATE, FeltTable, LEG_LENGTHS, Names, PLATFORM_POSE};
use moris_simulation::foreign::ForeignMotion;
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::arrays::{columns, numbers, wrong_shape};
use crate::error;
use crate::setup::Given;
use crate::words::argument;

/// The motion of `felt_force`, `felt_rate`, `pose` and `legs`, and sentences about interpolations.
///
/// # Errors
/// `RecordingError`: a part has another shape than the recording needs, or no such columns.
pub fn motion(parts: &[Option<Bound<PyAny>>; 4], recording: &Recording) -> PyResult<(ForeignMotion, Vec<String>)> {
    let [force, rate, pose, legs] = parts.each_ref().map(Option::as_ref);
    let mut notes = Vec::new();
    let motion = ForeignMotion {
        force: motion_part(force, &FELT_FORCE, recording, &mut notes)?,
        rate: motion_part(rate, &FELT_RATE, recording, &mut notes)?,
        pose: motion_part(pose, &PLATFORM_POSE, recording, &mut notes)?,
        legs: motion_part(legs, &LEG_LENGTHS, recording, &mut notes)?,
    };
    Ok((motion, notes))
}

/// One quantity of the motion: from a file, a table of columns, or an array with a row a sample.
fn motion_part<const N: usize>(
    given: Given,
    names: &Names<N>,
    recording: &Recording,
    notes: &mut Vec<String>,
) -> PyResult<Option<Vec<[f64; N]>>> {
    let Some(given) = given else { return Ok(None) };
    let refused = |reason: String| error::recording(given.py(), reason);
    let table = if given.hasattr("__fspath__")? {
        let file: PathBuf = given.extract()?;
        FeltTable::read(&file).map_err(|reason| refused(reason.worded(argument)))?
    } else if is_table(given)? {
        FeltTable::of_columns("", &columns(given.extract()?)?).map_err(|reason| refused(reason.worded(argument)))?
    } else {
        return array_rows(given, names.argument, recording.inputs().len()).map(Some);
    };
    let prefix = if table.name.is_empty() { String::new() } else { format!("{}: ", table.name) };
    table.part(names, recording, notes).map(Some).map_err(|reason| refused(format!("{prefix}{reason}")))
}

/// True for a list of pairs of name and array.
fn is_table(given: &Bound<PyAny>) -> PyResult<bool> {
    let Ok(list) = given.cast::<PyList>() else { return Ok(false) };
    Ok(list.iter().all(|pair| pair.extract::<(String, Bound<PyAny>)>().is_ok()))
}

/// The rows of an array with `N` columns, and as many rows as the recording has samples, or a whole
/// number of rows to each of its steps.
fn array_rows<const N: usize>(given: &Bound<PyAny>, name: &str, samples: usize) -> PyResult<Vec<[f64; N]>> {
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
