//! An own FMU from an existing one.

use std::path::PathBuf;

use moris_build_fmu::{FormOptions, OwnFmu, StartOptions};
use pyo3::prelude::*;

/// Packs the FMU `base` with the parameters of a file as start values into the directory `output`;
/// returns the FMU's file.
#[pyfunction]
pub fn pack_fmu(py: Python, base: PathBuf, parameters: String, output: PathBuf) -> PyResult<PathBuf> {
    let options = StartOptions { parameters: vec![parameters], ..StartOptions::default() };
    let packed = py.detach(|| OwnFmu::new(&base, &options, FormOptions::default())?.write(&output));
    packed.map_err(|error| crate::error::plain(py, "BuildError", &error))
}
