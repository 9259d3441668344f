//! The largest scale that a rig gives the right way round.

use moris_simulation::fit::{Aims, Candidate, Search};
use moris_simulation::measures::shape::Shape;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error;
use crate::recording::PyRecording;
use crate::setup::{self, Given};
use crate::simulation::host;
use crate::washout::parameter_dict;

/// A candidate. Factors on scale, break frequencies and heave; the shape error; shape, inverted
/// time and size of surge and of sway. An axis without motion has none.
type Fitted = ([f64; 3], Option<f64>, [Option<[f64; 3]>; 2]);

/// Fits a recording. Returns the best candidate, true if it reaches the aims, the curve, and the
/// parameters.
///
/// # Errors
/// `ParameterError`: the parameters cannot be used. `ValueError`: an aim or the preview is out of
/// range.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn fit<'py>(
    py: Python<'py>,
    recording: &PyRecording,
    rig: Given,
    parameters: Given,
    strategy: Option<&str>,
    preview: f64,
    error: f64,
    inverted: f64,
) -> PyResult<(Fitted, bool, Vec<Fitted>, Bound<'py, PyDict>)> {
    host(preview)?;
    for (name, value) in [("error", error), ("inverted", inverted)] {
        if !(value > 0.0 && value <= 1.0) {
            return Err(PyValueError::new_err(format!("{name} is {value}, but must be a fraction above 0, at most 1")));
        }
    }
    let setup = setup::load(py, rig, parameters, strategy)?;
    let parameters = recording.inner.parameters(&setup.parameters);
    let manoeuvre = &recording.inner.manoeuvre;
    let found =
        py.detach(|| Search::new(manoeuvre, preview, Aims { error, inverted, ..Aims::default() }).fit(&parameters));
    let found = found.map_err(|reason| error::plain(py, "ParameterError", &reason))?;
    let chosen = parameter_dict(py, &found.best.factors.applied(&setup.parameters))?;
    Ok((fitted_candidate(&found.best), found.fits, found.curve.iter().map(fitted_candidate).collect(), chosen))
}

fn fitted_candidate(candidate: &Candidate) -> Fitted {
    let Candidate { factors, shape: Shape { error, axes, .. } } = candidate;
    let axes = axes.map(|axis| axis.map(|axis| [axis.shape, axis.inverted, axis.size]));
    ([factors.scale, factors.breaks, factors.heave], *error, axes)
}
