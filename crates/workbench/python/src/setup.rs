//! Rig and parameters from what Python gives: names of files and presets,
//! dictionaries, and lists of them.

use std::path::PathBuf;

use moris_interface::Group;
use moris_setup::rig_file::{self, RigFile};
use moris_setup::{Error, NamedValues, Setup, all, load_rig, load_set, overlaid, parameter_file};
use moris_washout::{Parameters, check};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyList, PyMapping, PyString, PyTuple};
use toml::{Table, Value};

use crate::error;

/// The rig, parameters and strategy, put together and checked.
///
/// # Errors
/// `ParameterError`: a name, a value or the combination cannot be used.
pub fn load(
    py: Python,
    rig: Option<&Bound<PyAny>>,
    parameters: Option<&Bound<PyAny>>,
    strategy: Option<&str>,
) -> PyResult<Setup> {
    let mut setup = unchecked(rig, parameters, strategy)?;
    check(&setup.parameters).map_err(|error| error::refused(py, &error, &all(&setup.parameters)))?;
    if setup.parameters_name.is_empty() {
        setup.parameters_name = "default".to_owned();
    }
    Ok(setup)
}

fn unchecked(rig: Option<&Bound<PyAny>>, parameters: Option<&Bound<PyAny>>, strategy: Option<&str>) -> PyResult<Setup> {
    let rig = rig.map(rig_of).transpose()?;
    let rig_alone = rig.as_ref().map_or_else(Parameters::default, RigFile::parameters);
    let mut setup = Setup {
        rig_name: rig.as_ref().map_or_else(|| "default rig".to_owned(), |rig| rig.name.clone()),
        parameters_name: String::new(),
        parameters: rig_alone,
        rig_alone,
        actuator_diameter: rig.as_ref().and_then(|rig| rig.actuator.diameter),
    };
    if let Some(parameters) = parameters {
        overlay(&mut setup, parameters)?;
    }
    if let Some(strategy) = strategy {
        let values = Table::from_iter([("strategy".to_owned(), Value::from(strategy))]);
        lay_over(&mut setup, strategy, &values_of(parameters.map(Bound::py), &values)?);
    }
    Ok(setup)
}

/// The values that a Python object gives: a name, a dictionary, or a list of them.
///
/// # Errors
/// As [`load`].
pub fn values(parameters: &Bound<PyAny>) -> PyResult<NamedValues> {
    let mut setup = Setup {
        rig_name: String::new(),
        parameters_name: String::new(),
        parameters: Parameters::default(),
        rig_alone: Parameters::default(),
        actuator_diameter: None,
    };
    let mut given = NamedValues::new();
    each(parameters, &mut |_, values| given.extend(values))?;
    lay_over(&mut setup, "", &given);
    Ok(given)
}

fn overlay(setup: &mut Setup, parameters: &Bound<PyAny>) -> PyResult<()> {
    each(parameters, &mut |name, values| lay_over(setup, name, &values))
}

fn lay_over(setup: &mut Setup, name: &str, values: &NamedValues) {
    setup.parameters = overlaid(&setup.parameters, values);
    if !setup.parameters_name.is_empty() {
        setup.parameters_name.push_str(" + ");
    }
    setup.parameters_name.push_str(name);
}

/// Calls `act` with the name and the values of every set.
fn each(parameters: &Bound<PyAny>, act: &mut dyn FnMut(&str, NamedValues)) -> PyResult<()> {
    let py = parameters.py();
    let refused = |error: &Error| error::setup(py, error, &NamedValues::new());
    if let Some(path) = path_of(parameters)? {
        let text = path.to_string_lossy();
        let stem = path.file_stem().map_or_else(|| text.clone(), |stem| stem.to_string_lossy());
        act(&stem, load_set(&text, Parameters::ROWS).map_err(|error| refused(&error))?);
    } else if parameters.cast::<PyMapping>().is_ok() {
        act("given", values_of(Some(py), &table(parameters)?)?);
    } else if parameters.cast::<PyList>().is_ok() || parameters.cast::<PyTuple>().is_ok() {
        for set in parameters.try_iter()? {
            each(&set?, act)?;
        }
    } else {
        return Err(PyTypeError::new_err(format!(
            "parameters must be a preset's name, a parameter file, a dict of values by name, or a list of these, not {}",
            parameters.get_type().name()?
        )));
    }
    Ok(())
}

/// The values of a table, by the rules of a parameter file.
fn values_of(py: Option<Python>, values: &Table) -> PyResult<NamedValues> {
    let read = parameter_file::read(&values.to_string(), "parameters", Parameters::ROWS);
    read.map_err(|error| match py {
        Some(py) => error::setup(py, &error, &NamedValues::new()),
        None => Python::attach(|py| error::setup(py, &error, &NamedValues::new())),
    })
}

/// The rig of a rig file or of a dictionary with its keys.
///
/// # Errors
/// As [`load`].
pub fn rig_of(rig: &Bound<PyAny>) -> PyResult<RigFile> {
    let py = rig.py();
    let refused = |error: Error| error::setup(py, &error, &NamedValues::new());
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
