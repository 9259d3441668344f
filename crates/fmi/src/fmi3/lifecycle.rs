//! From fmi3InstantiateCoSimulation to fmi3EnterInitializationMode; what follows is
//! [`abi::lifecycle`](crate::abi::lifecycle).

use std::ffi::CStr;
use std::ptr::null_mut;

use moris_interface::Model;

use super::types::*;
use super::{Component, LOG_CATEGORIES, Layout, Logger};
use crate::abi::pointers::{slice, string};
use crate::abi::{Host, with_default_arithmetic};
use crate::{CallError, Guid, Instance, Severity, SharedTables, panics};

/// Options of instantiation.
pub struct Request {
    pub instance_name: fmi3String,
    pub instantiation_token: fmi3String,
    pub event_mode_used: fmi3Boolean,
    /// Number of variables to get or set within a step.
    pub intermediate_variable_count: usize,
}

/// `fmi3InstantiateCoSimulation`; the resources' path and visibility make no difference, and a
/// step never ends early.
pub unsafe fn instantiate<M: Model, const N: usize>(
    tables: &'static SharedTables<N>,
    request: &Request,
    mut logger: Logger,
) -> fmi3Instance {
    panics::silence();
    let new = || {
        let tables = tables.get::<M>()?;
        // SAFETY: the host's strings live during the call.
        let layout = unsafe { check_request(request, tables.guid) }?;
        Ok((Instance::<M>::new(tables), layout))
    };
    match with_default_arithmetic(|| panics::contain(new)).and_then(|made| made) {
        Ok((instance, layout)) => {
            logger.layout = layout;
            logger.event(&format!("{} {} instantiated", M::IDENTITY.name, M::IDENTITY.version));
            Component::into_pointer(instance, logger)
        }
        Err(error) => {
            logger.failure(Severity::Error, &format!("fmi3InstantiateCoSimulation: {}", error.text));
            null_mut()
        }
    }
}

/// Refuses unsupported options. Returns the layout of the host's description.
///
/// # Safety
/// The request's strings are null, or ended by a zero.
unsafe fn check_request(request: &Request, guid: &Guid) -> Result<Layout, CallError> {
    // SAFETY: guaranteed by the caller.
    let (name, token) = unsafe { (string(request.instance_name), string(request.instantiation_token)) };
    if name.is_none_or(|name| name.to_bytes().trim_ascii().is_empty()) {
        return Err(CallError::error("instanceName is null or empty; pass a name"));
    }
    let Some(layout) = token.and_then(|token| Layout::of_token(token.to_bytes(), guid)) else {
        let given = token.map_or("none".into(), CStr::to_string_lossy);
        let expected = String::from_utf8_lossy(guid);
        return Err(CallError::error(format!(
            "the instantiation token is {given}, not {expected}: \
             modelDescription.xml and the shared library do not belong together; unpack the FMU again"
        )));
    };
    if request.event_mode_used.is_true() {
        return Err(CallError::error(
            "this FMU has no event mode (hasEventMode in modelDescription.xml); pass eventModeUsed = false",
        ));
    }
    if request.intermediate_variable_count > 0 {
        return Err(CallError::error(
            "this FMU has no intermediate update (providesIntermediateUpdate in modelDescription.xml); pass none of \
             requiredIntermediateVariables",
        ));
    }
    Ok(layout)
}

/// `fmi3InstantiateModelExchange`, `fmi3InstantiateScheduledExecution`
pub fn refuse_to_instantiate(function: &str, logger: &Logger) -> fmi3Instance {
    logger.failure(
        Severity::Error,
        &format!("{function}: this FMU is for co-simulation only; use fmi3InstantiateCoSimulation"),
    );
    null_mut()
}

/// `fmi3SetDebugLogging`: switches the categories named, or all. Errors are
/// switched off by name only.
pub unsafe fn set_debug_logging<M: Model>(
    component: &mut Component<M>,
    logging_on: fmi3Boolean,
    count: usize,
    categories: *const fmi3String,
) -> Result<(), CallError> {
    let on = logging_on.is_true();
    let mut chosen = Vec::new();
    // SAFETY: the host's array and its strings live during the call.
    for &category in unsafe { slice(categories, count) }? {
        // SAFETY: as above.
        let name = unsafe { string(category) }.map_or("NULL".into(), CStr::to_string_lossy);
        let known = LOG_CATEGORIES.iter().map(|&(category, _)| category).find(|category| category.name() == name);
        let unknown =
            || CallError::error(format!("unknown log category '{name}'; modelDescription.xml lists the categories"));
        chosen.push(known.ok_or_else(unknown)?);
    }
    if count == 0 {
        component.logger.switch_all(on);
    }
    chosen.into_iter().for_each(|category| component.logger.switch(category, on));
    Ok(())
}

/// `fmi3EnterInitializationMode`
pub fn enter_initialization_mode<M: Model>(
    component: &mut Component<M>,
    tolerance_defined: fmi3Boolean,
    tolerance: f64,
    start_time: f64,
    stop_time_defined: fmi3Boolean,
    stop_time: f64,
) -> Result<(), CallError> {
    let tolerance = tolerance_defined.is_true().then_some(tolerance);
    let stop_time = stop_time_defined.is_true().then_some(stop_time);
    component.instance.define_experiment(start_time, stop_time, tolerance)?;
    component.instance.enter_initialization()
}
