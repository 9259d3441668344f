//! Variables by name: single ones (`actuator[1].length`) and vectors (`actuator.length`,
//! `platform.position`).

use std::collections::HashMap;
use std::ops::Range;

use moris_interface::{Kind, Row};
use moris_setup::nearest;
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// The variables of a group.
pub struct Variables {
    /// Names of the scalar variables, in the order of the slots.
    pub names: Vec<String>,
    kinds: Vec<Kind>,
    slots: HashMap<String, Range<usize>>,
}

impl Variables {
    /// The variables of these rows.
    pub fn of(rows: &[Row]) -> Self {
        let (mut names, mut kinds, mut slots) = (Vec::new(), Vec::new(), HashMap::new());
        for row in rows {
            let first = names.len();
            for element in 0..row.slots() {
                slots.insert(row.variable_name(element), first + element..first + element + 1);
                names.push(row.variable_name(element));
                kinds.push(row.kind);
            }
            if row.slots() > 1 {
                slots.insert(row.array_name(), first..first + row.slots());
            }
        }
        Variables { names, kinds, slots }
    }

    /// The slots of a name.
    ///
    /// # Errors
    /// There is no variable of this name. The message lists the most similar names.
    pub fn slots(&self, name: &str) -> PyResult<Range<usize>> {
        self.slots.get(name).cloned().ok_or_else(|| {
            let near = nearest(name, self.slots.keys().map(String::as_str));
            let remedy = if near.is_empty() {
                format!("there are {}", self.names.join(", "))
            } else {
                format!("did you mean {}?", near.join(" or "))
            };
            PyKeyError::new_err(format!("there is no variable {name}; {remedy}"))
        })
    }

    /// The value of a name: a number, a truth value, an item's name, or a tuple for a vector.
    ///
    /// # Errors
    /// As [`Variables::slots`].
    pub fn value<'py>(&self, py: Python<'py>, name: &str, slots: &[f64]) -> PyResult<Bound<'py, PyAny>> {
        let range = self.slots(name)?;
        if range.len() == 1 {
            return self.scalar(py, range.start, slots[range.start]);
        }
        Ok(PyTuple::new(py, &slots[range])?.into_any())
    }

    /// The value of a scalar variable.
    ///
    /// # Errors
    /// Python is out of memory.
    pub fn scalar<'py>(&self, py: Python<'py>, slot: usize, value: f64) -> PyResult<Bound<'py, PyAny>> {
        match self.kinds[slot] {
            Kind::Real(_) => value.into_bound_py_any(py),
            Kind::Integer => (value as i64).into_bound_py_any(py),
            Kind::Boolean => (value != 0.0).into_bound_py_any(py),
            Kind::Enumeration(enumeration) => {
                let item = (value as usize).saturating_sub(1).min(enumeration.items.len() - 1);
                enumeration.items[item].name.into_bound_py_any(py)
            }
        }
    }
}
