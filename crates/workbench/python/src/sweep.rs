//! Many parameter sets on many recordings: the part that runs without Python.

use std::sync::{Arc, LazyLock};

use moris_analysis::host::Host;
use moris_analysis::recording::Recording;
use moris_setup::Setup;
use moris_simulation::measures;
use numpy::{PyArray1, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::parallel::on_all_cores;
use crate::recording::PyRecording;
use crate::setup::{self, Given};
use crate::simulation::{check_preview, host};
use crate::words::argument;

/// All measures of a sweep, on every axis: subject, name and unit.
static MEASURES: LazyLock<Vec<(String, &'static str, &'static str)>> =
    LazyLock::new(|| measures::all_rows().into_iter().map(|row| (row.subject, row.name, row.unit)).collect());

/// The measures of a sweep: subject, name and unit.
#[pyfunction]
pub fn sweep_measures() -> Vec<(String, &'static str, &'static str)> {
    MEASURES.clone()
}

/// Simulates recordings with parameter sets and measures them.
///
/// Returns the measures (sets, recordings, measures), NaN where one is not defined, and for each
/// set the message of its error or None. `preview` is the length of the preview [s]. `threads` = 1
/// uses this thread only, any other number all cores.
///
/// # Errors
/// `TypeError`: a set is not of a type that parameters can have. `ValueError`:
/// the preview is too long.
#[pyfunction]
#[allow(clippy::type_complexity, clippy::too_many_arguments)]
pub fn sweep_chunk<'py>(
    py: Python<'py>,
    recordings: Vec<PyRef<PyRecording>>,
    rig: Given,
    sets: Vec<Bound<PyAny>>,
    strategy: Option<&str>,
    preview: f64,
    threads: usize,
) -> PyResult<(Bound<'py, PyArray3<f64>>, Vec<Option<String>>)> {
    let host = host(preview)?;
    let refused = py.import("moris._errors")?.getattr("ParameterError")?;
    let mut errors = Vec::with_capacity(sets.len());
    let mut setups = Vec::with_capacity(sets.len());
    for set in &sets {
        let loaded = match setup::load(py, rig, Some(set), strategy) {
            Ok(setup) => check_preview(&setup, preview).map(|()| setup).map_err(|reason| reason.worded(argument)),
            Err(error) if error.is_instance(py, &refused) => Err(error.value(py).to_string()),
            Err(error) => return Err(error),
        };
        errors.push(loaded.as_ref().err().cloned());
        setups.push(loaded.ok());
    }
    let recordings: Vec<Arc<Recording>> = recordings.iter().map(|recording| Arc::clone(&recording.inner)).collect();
    let count = recordings.len() * MEASURES.len();
    let mut rows = vec![f64::NAN; sets.len() * count];
    let pairs = setups.iter().flat_map(|setup| recordings.iter().map(move |recording| (setup.as_ref(), &**recording)));
    let tasks: Vec<_> = pairs.zip(rows.chunks_exact_mut(MEASURES.len())).collect();
    let act = |((setup, recording), row): ((Option<&Setup>, &Recording), &mut [f64])| {
        if let Some(setup) = setup {
            write_measures(&host, setup, recording, row);
        }
    };
    if threads == 1 {
        py.detach(|| tasks.into_iter().for_each(act));
    } else {
        on_all_cores(py, || tasks.into_par_iter().for_each(act))?;
    }
    let rows = PyArray1::from_vec(py, rows).reshape([sets.len(), recordings.len(), MEASURES.len()])?;
    Ok((rows, errors))
}

/// Writes the measures of a simulation into a row; those that are not defined stay what they are.
fn write_measures(host: &Host, setup: &Setup, recording: &Recording, row: &mut [f64]) {
    let parameters = recording.parameters(&setup.parameters);
    // The setup is checked, and a recording has samples: neither fails.
    let Ok(simulation) = host.replay(recording, &parameters, None) else { return };
    let Ok(measures) = measures(&simulation) else { return };
    for (value, measure) in row.iter_mut().zip(measures.values()) {
        *value = measure.unwrap_or(*value);
    }
}
