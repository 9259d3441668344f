//! The frequency response.

use moris_analysis::frequency_response::Measured;
use moris_simulation::frequency_response::Response;
use moris_simulation::frequency_response::channel::{CHANNEL_COUNT, Channel, name};
use moris_simulation::frequency_response::excitation::{Amplitudes, frequencies};
use numpy::{Complex64, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error;
use crate::parallel::on_all_cores;
use crate::setup::{self, Given};

/// Names of the channels, frequencies \[rad/s\], and the responses with the test's amplitudes
/// and to small signals.
type FrequencyResponse<'py> = (Vec<&'static str>, Bound<'py, PyArray1<f64>>, Responses<'py>, Responses<'py>);

/// Ratios (inputs, frequencies, outputs) in SI units, distortion of the same shape, fractions of
/// time limited (inputs, frequencies, 3), and whether each has settled (inputs, frequencies).
type Responses<'py> =
    (Bound<'py, PyArray3<Complex64>>, Bound<'py, PyArray3<f64>>, Bound<'py, PyArray3<f64>>, Bound<'py, PyArray2<bool>>);

/// Measures the frequency response.
///
/// # Errors
/// `ParameterError`: the parameters cannot be used; `ValueError`: an amplitude is not positive.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn frequency_response<'py>(
    py: Python<'py>,
    rig: Given,
    parameters: Given,
    strategy: Option<&str>,
    force: f64,
    rate: f64,
    gravity_turns: bool,
    platform: bool,
) -> PyResult<FrequencyResponse<'py>> {
    let setup = setup::load(py, rig, parameters, strategy)?;
    for (name, value) in [("force", force), ("rate", rate)] {
        if !(value.is_finite() && value > 0.0) {
            return Err(PyValueError::new_err(format!("{name} is {value}, but must be a positive number")));
        }
    }
    let default = Amplitudes::default();
    let amplitudes = Amplitudes { force, ..default.scaled(rate / default.rate) };
    let measured = on_all_cores(py, || Measured::of(&setup.parameters, amplitudes, gravity_turns, platform, || ()))?;
    let measured = measured.map_err(|reason| error::plain(py, "ParameterError", &reason))?;
    let names = Channel::ALL.iter().map(|&channel| name(channel)).collect();
    let frequencies = PyArray1::from_slice(py, &frequencies());
    Ok((names, frequencies, response_arrays(py, &measured.test)?, response_arrays(py, &measured.small)?))
}

fn response_arrays<'py>(py: Python<'py>, responses: &[Response]) -> PyResult<Responses<'py>> {
    let count = frequencies().len();
    let shape = |last: usize| [CHANNEL_COUNT, count, last];
    let ratios = responses.iter().flat_map(|response| response.ratios);
    let ratios = ratios.map(|ratio| Complex64::new(ratio.re, ratio.im)).collect();
    let distortion = responses.iter().flat_map(|response| response.distortion).collect();
    let limited = responses.iter().flat_map(|response| response.limited).collect();
    let settled = responses.iter().map(|response| response.settled).collect();
    Ok((
        PyArray1::from_vec(py, ratios).reshape(shape(CHANNEL_COUNT))?,
        PyArray1::from_vec(py, distortion).reshape(shape(CHANNEL_COUNT))?,
        PyArray1::from_vec(py, limited).reshape(shape(3))?,
        PyArray1::from_vec(py, settled).reshape([CHANNEL_COUNT, count])?,
    ))
}
