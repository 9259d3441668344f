//! Communication steps and their status. A step is complete when fmi2DoStep returns, so most of the
//! functions that return its status report an error.

use std::ffi::c_int;

use moris_interface::Model;

use super::Component;
use super::types::*;
use crate::CallError;
use crate::abi::pointers::answer;

/// `fmi2DoStep`
#[inline]
pub fn do_step<M: Model>(
    component: &mut Component<M>,
    time: fmi2Real,
    step: fmi2Real,
    _no_going_back: fmi2Boolean,
) -> Result<(), CallError> {
    component.instance.step(time, step)
}

/// `fmi2GetRealStatus`: only the time of the last successful step is known.
pub unsafe fn get_real_status<M: Model>(
    component: &mut Component<M>,
    kind: c_int,
    value: *mut fmi2Real,
) -> Result<(), CallError> {
    if kind != LAST_SUCCESSFUL_TIME {
        return Err(not_known(kind));
    }
    // SAFETY: the host's memory for the answer.
    unsafe { answer(value, component.instance.time()) }?;
    Ok(())
}

/// `fmi2GetBooleanStatus`: no simulation terminates by itself.
pub unsafe fn get_boolean_status<M: Model>(
    _: &mut Component<M>,
    kind: c_int,
    value: *mut fmi2Boolean,
) -> Result<(), CallError> {
    if kind != TERMINATED {
        return Err(not_known(kind));
    }
    // SAFETY: the host's memory for the answer.
    unsafe { answer(value, fmi2Boolean(0)) }?;
    Ok(())
}

/// `fmi2GetStatus`, `fmi2GetIntegerStatus`, `fmi2GetStringStatus`: no step is pending.
pub fn nothing_pending<M: Model, V>(_: &mut Component<M>, kind: c_int, _value: *mut V) -> Result<(), CallError> {
    Err(not_known(kind))
}

fn not_known(kind: c_int) -> CallError {
    CallError::discard(format!("status kind {kind} is not supported: a step is complete when fmi2DoStep returns"))
}
