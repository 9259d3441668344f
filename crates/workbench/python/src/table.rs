//! The table of variables.

use moris_interface::{Causality, Group, Kind, Row, slots_of};
use moris_setup::{PARAMETER_SETS, SHIPPED_RIGS};
use moris_washout::interface::Inputs;
use moris_washout::{Output, Parameters};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use crate::variables::Variables;

/// A variable as Python gets it: name, causality, kind, unit, least and greatest value, start
/// value, items, description. After them come its vector's name, the usual range, and the name of
/// the group with which it is tuned.
type Variable<'py> = (
    String,
    &'static str,
    &'static str,
    &'static str,
    f64,
    f64,
    Bound<'py, PyAny>,
    Vec<&'static str>,
    &'static str,
    String,
    Option<(f64, f64)>,
    Option<&'static str>,
);

/// The names of the parameter sets that are shipped; `parameters=` takes them.
#[pyfunction]
pub fn presets() -> Vec<&'static str> {
    PARAMETER_SETS.iter().map(|(name, _)| *name).collect()
}

/// The names of the rigs that are shipped, by stroke; `rig=` takes them.
#[pyfunction]
pub fn rigs() -> Vec<&'static str> {
    SHIPPED_RIGS.iter().map(|(name, _)| *name).collect()
}

/// Inputs, outputs and parameters, each a tuple.
///
/// # Errors
/// Python is out of memory.
#[pyfunction]
pub fn variable_rows(py: Python) -> PyResult<Vec<Variable>> {
    Ok([
        group_variables(py, &Inputs::default())?,
        group_variables(py, &Output::default())?,
        group_variables(py, &Parameters::default())?,
    ]
    .concat())
}

fn group_variables<'py, G: Group>(py: Python<'py>, start: &G) -> PyResult<Vec<Variable<'py>>> {
    let variables = Variables::of(G::ROWS);
    let values = slots_of(start);
    let mut rows = Vec::new();
    for row in G::ROWS {
        for _ in 0..row.slots() {
            let slot = rows.len();
            let (least, greatest) = row.bounds();
            let start = match row.causality {
                Causality::Output => py.None().into_bound_py_any(py)?,
                _ => variables.scalar(py, slot, values[slot])?,
            };
            let (name, causality) = (variables.names[slot].clone(), row.causality.name());
            let (kind, unit, items) = row_kind(row);
            let (of, usual, group) = (row.array_name(), row.usual, row.tuning_group);
            rows.push((name, causality, kind, unit, least, greatest, start, items, row.text(), of, usual, group));
        }
    }
    Ok(rows)
}

fn row_kind(row: &Row) -> (&'static str, &'static str, Vec<&'static str>) {
    match row.kind {
        Kind::Real(unit) => ("real", unit.name, Vec::new()),
        Kind::Integer => ("integer", "", Vec::new()),
        Kind::Boolean => ("boolean", "", Vec::new()),
        Kind::Enumeration(enumeration) => ("enumeration", "", enumeration.items.iter().map(|item| item.name).collect()),
    }
}
