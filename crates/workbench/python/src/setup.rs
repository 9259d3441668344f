//! Rig and parameters from what Python gives: names of files and presets,
//! dictionaries, and lists of them.

use std::path::PathBuf;

use moris_interface::Group;
use moris_setup::rig_file::{self, RigFile};
use moris_setup::{NamedValues, Setup, all, load_rig, load_set, parameter_file, set_name};
use moris_washout::{Parameters, check};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyList, PyMapping, PyString, PyTuple};
use toml::{Table, Value};

use crate::error;

/// An argument that may be left out.
pub type Given<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// The rig, parameters and strategy, put together and checked. The strategy sets the parameter of
/// this name alone.
///
/// # Errors
/// `ParameterError`: a name, a value or the combination cannot be used.
pub fn load(py: Python, rig: Given, parameters: Given, strategy: Option<&str>) -> PyResult<Setup> {
    let rig = rig.map(rig_of).transpose()?;
    let mut sets = parameters.map(sets_of).transpose()?.unwrap_or_default();
    if let Some(strategy) = strategy {
        let values = Table::from_iter([("strategy".to_owned(), Value::from(strategy))]);
        sets.push((strategy.to_owned(), values_of(py, &values)?));
    }
    let setup = Setup::unchecked(rig, &sets);
    check(&setup.parameters).map_err(|error| error::refused(py, &error, &all(&setup.parameters)))?;
    Ok(setup)
}

/// The parameter sets that a Python object gives, a name, a dictionary or a list of them: names and
/// values.
///
/// # Errors
/// As [`load`].
pub fn sets_of(parameters: &Bound<PyAny>) -> PyResult<Vec<(String, NamedValues)>> {
    let py = parameters.py();
    if let Some(path) = path_of(parameters)? {
        let set = path.to_string_lossy();
        let values = load_set(&set, Parameters::ROWS).map_err(|error| error::setup(py, &error))?;
        Ok(vec![(set_name(&set), values)])
    } else if parameters.cast::<PyMapping>().is_ok() {
        Ok(vec![("given".to_owned(), values_of(py, &table(parameters)?)?)])
    } else if parameters.cast::<PyList>().is_ok() || parameters.cast::<PyTuple>().is_ok() {
        let sets = parameters.try_iter()?.map(|set| sets_of(&set?)).collect::<PyResult<Vec<_>>>()?;
        Ok(sets.concat())
    } else {
        Err(PyTypeError::new_err(format!(
            "parameters must be a preset's name, a parameter file, a dict of values by name, or a list of these, not {}",
            parameters.get_type().name()?
        )))
    }
}

/// The values of a table, by the rules of a parameter file.
fn values_of(py: Python, values: &Table) -> PyResult<NamedValues> {
    let read = parameter_file::read(&values.to_string(), "parameters", Parameters::ROWS);
    read.map_err(|error| error::setup(py, &error))
}

/// The rig of a rig file or of a dictionary with its keys.
///
/// # Errors
/// As [`load`].
pub fn rig_of(rig: &Bound<PyAny>) -> PyResult<RigFile> {
    let py = rig.py();
    let refused = |error| error::setup(py, &error);
    if let Some(path) = path_of(rig)? {
        return load_rig(&path).map_err(refused);
    }
    if rig.cast::<PyMapping>().is_err() {
        let name = rig.get_type().name()?;
        return Err(PyTypeError::new_err(format!("rig must be a rig file or a dict with its keys, not {name}")));
    }
    let mut keys = table(rig)?;
    keys.entry("name").or_insert_with(|| Value::from("rig"));
    rig_file::read(&keys.to_string(), "rig").map_err(refused)
}

/// A text or a path.
fn path_of(object: &Bound<PyAny>) -> PyResult<Option<PathBuf>> {
    if object.cast::<PyString>().is_ok() || object.hasattr("__fspath__")? {
        return object.extract().map(Some);
    }
    Ok(None)
}

/// A mapping as TOML.
///
/// # Errors
/// `TypeError`: a key is no text, or a value is of no type that TOML has.
pub fn table(mapping: &Bound<PyAny>) -> PyResult<Table> {
    let mut table = Table::new();
    for item in mapping.call_method0("items")?.try_iter()? {
        let (key, value): (String, Bound<PyAny>) = item?.extract()?;
        let value = value_of(&value).map_err(|_| {
            PyTypeError::new_err(format!("{key} is {value}, which is no number, text, truth value, list or dict"))
        })?;
        table.insert(key, value);
    }
    Ok(table)
}

fn value_of(object: &Bound<PyAny>) -> PyResult<Value> {
    if object.cast::<PyBool>().is_ok() {
        return Ok(Value::Boolean(object.extract()?));
    }
    if let Ok(text) = object.cast::<PyString>() {
        return Ok(Value::String(text.extract()?));
    }
    if object.cast::<PyDict>().is_ok() {
        return Ok(Value::Table(table(object)?));
    }
    if let Ok(number) = object.extract::<i64>() {
        return Ok(Value::Integer(number));
    }
    if let Ok(number) = object.extract::<f64>() {
        return Ok(Value::Float(number));
    }
    if object.get_type().name()? == "bool" {
        return Ok(Value::Boolean(object.is_truthy()?)); // numpy's
    }
    object.try_iter()?.map(|item| value_of(&item?)).collect::<PyResult<Vec<_>>>().map(Value::Array)
}
