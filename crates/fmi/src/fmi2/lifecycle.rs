//! From fmi2Instantiate to fmi2EnterInitializationMode; what follows is
//! [`abi::lifecycle`](crate::abi::lifecycle).

use std::ffi::{CStr, CString, c_int};
use std::ptr::null_mut;

use moris_interface::{Model, Types};

use super::types::*;
use super::{Component, Logger};
use crate::abi::pointers::{slice, string};
use crate::abi::{Host, with_default_arithmetic};
use crate::{CallError, Instance, LogCategory, Severity, SharedTables, panics};

/// `fmi2Instantiate`; the resources' location and visibility make no difference.
pub unsafe fn instantiate<M: Model, const N: usize>(
    tables: &'static SharedTables<N>,
    instance_name: fmi2String,
    fmu_type: c_int,
    guid: fmi2String,
    callbacks: *const fmi2CallbackFunctions,
    logging_on: fmi2Boolean,
) -> fmi2Component {
    panics::silence();
    // SAFETY: unless null, the host's struct and strings live during the call.
    let (name, guid, callbacks) = unsafe { (string(instance_name), string(guid), callbacks.as_ref()) };
    let Some(callbacks) = callbacks else { return null_mut() };
    let logger = Logger::new(name.map_or_else(CString::default, CStr::to_owned), callbacks, logging_on.0 != 0);
    let new = || {
        let tables = tables.get::<M>()?;
        let types = check_request(name, fmu_type, guid, &tables.guid[..])?;
        Ok(Instance::<M>::new(tables.of_types(types)))
    };
    match with_default_arithmetic(|| panics::contain(new)).and_then(|instance| instance) {
        Ok(instance) => {
            logger.event(&format!("{} {} instantiated", M::IDENTITY.name, M::IDENTITY.version));
            Component::into_pointer(instance, logger)
        }
        Err(error) => {
            logger.failure(Severity::Error, &format!("fmi2Instantiate: {}", error.text));
            null_mut()
        }
    }
}

/// Refuses unsupported options. Returns the types of the host's description.
fn check_request(
    name: Option<&CStr>,
    fmu_type: c_int,
    guid: Option<&CStr>,
    expected: &[u8],
) -> Result<Types, CallError> {
    if name.is_none_or(CStr::is_empty) {
        return Err(CallError::error("instanceName is null or empty; pass a name"));
    }
    if fmu_type != CO_SIMULATION {
        return Err(CallError::error("this FMU has no model exchange; instantiate it with fmi2CoSimulation"));
    }
    guid.and_then(|guid| Types::of_token(guid.to_bytes(), expected)).ok_or_else(|| {
        let given = guid.map_or("none".into(), CStr::to_string_lossy);
        let expected = String::from_utf8_lossy(expected);
        CallError::error(format!(
            "the GUID is {given}, not {expected}: modelDescription.xml and the shared library do not belong together; unpack the FMU again"
        ))
    })
}

/// `fmi2SetDebugLogging`: events are logged if it is on for all categories or for theirs.
pub unsafe fn set_debug_logging<M: Model>(
    component: &mut Component<M>,
    logging_on: fmi2Boolean,
    count: usize,
    categories: *const fmi2String,
) -> Result<(), CallError> {
    let mut events = count == 0;
    // SAFETY: the host's array and its strings live during the call.
    for &category in unsafe { slice(categories, count) }? {
        // SAFETY: as above.
        let name = unsafe { string(category) }.map_or("NULL".into(), CStr::to_string_lossy);
        let category = LogCategory::named(&name).ok_or_else(|| {
            CallError::error(format!("unknown log category '{name}'; modelDescription.xml lists the categories"))
        })?;
        events |= matches!(category, LogCategory::Events | LogCategory::All);
    }
    component.logger.log_events(events && logging_on.0 != 0);
    Ok(())
}

/// `fmi2SetupExperiment`
pub fn setup_experiment<M: Model>(
    component: &mut Component<M>,
    tolerance_defined: fmi2Boolean,
    tolerance: fmi2Real,
    start_time: fmi2Real,
    stop_time_defined: fmi2Boolean,
    stop_time: fmi2Real,
) -> Result<(), CallError> {
    let stop = (stop_time_defined.0 != 0).then_some(stop_time);
    let tolerance = (tolerance_defined.0 != 0).then_some(tolerance);
    component.instance.define_experiment(start_time, stop, tolerance)
}

/// `fmi2EnterInitializationMode`
pub fn enter_initialization_mode<M: Model>(component: &mut Component<M>) -> Result<(), CallError> {
    component
        .instance
        .enter_initialization()
        .map_err(|error| CallError::error(format!("{}: call fmi2SetupExperiment before", error.text)))
}
