//! Errors as the exceptions of `moris`.

use std::fmt::Display;

use moris_interface::ParameterError;
use moris_setup::{Error, NamedValues};
use pyo3::prelude::*;

/// An exception of `moris._errors` with these arguments.
fn new_exception<'py>(py: Python<'py>, class: &str, arguments: impl pyo3::call::PyCallArgs<'py>) -> PyErr {
    let made = py.import("moris._errors").and_then(|module| module.getattr(class)?.call1(arguments));
    made.map_or_else(|error| error, PyErr::from_value)
}

/// Parameters that cannot be used together, with the value of the one that is refused.
pub fn refused(py: Python, error: &ParameterError, values: &NamedValues) -> PyErr {
    let ParameterError { variable, reason } = error;
    let value = values.iter().find(|(name, _)| name == variable).map(|(_, value)| *value);
    new_exception(py, "ParameterError", (format!("{variable} {reason}"), variable, value))
}

/// A rig or parameters that cannot be used.
pub fn setup(py: Python, error: &Error) -> PyErr {
    match error {
        Error::Refused(error) => refused(py, error, &NamedValues::new()),
        Error::UnknownName { what, name, nearest, .. } => {
            let remedy = match nearest.as_slice() {
                [] if *what == "parameter" => "moris.parameters() lists them".to_owned(),
                [] => "docs/rig.md lists the keys of a rig".to_owned(),
                near => format!("did you mean {}?", near.join(" or ")),
            };
            let message = format!("there is no {what} {name}; {remedy}");
            new_exception(py, "ParameterError", (message, name, None::<f64>, nearest.clone()))
        }
        Error::WrongValue { name, reason, .. } => {
            new_exception(py, "ParameterError", (format!("{name} {reason}"), name))
        }
        Error::NoSuchSet { name, nearest } | Error::NoSuchRig { name, nearest } => {
            new_exception(py, "ParameterError", (error.to_string(), name, None::<f64>, nearest.clone()))
        }
        Error::Read { .. } | Error::Toml { .. } => plain(py, "ParameterError", error),
    }
}

/// A recording or an argument that cannot be used.
pub fn recording(py: Python, message: String) -> PyErr {
    new_exception(py, "RecordingError", (message,))
}

/// A bound that cannot be computed.
pub fn bound(py: Python, reason: &dyn Display) -> PyErr {
    new_exception(py, "BoundError", (format!("cannot compute the bound: {reason}"),))
}

/// An exception of `moris._errors` whose message is the reason alone.
pub fn plain(py: Python, class: &str, reason: &dyn Display) -> PyErr {
    new_exception(py, class, (reason.to_string(),))
}
