//! Getting and setting variables.

use moris_interface::Model;

use super::Component;
use super::types::*;
use crate::abi::pointers::{buffer, slice};
use crate::abi::{Function, call};
use crate::{Scalar, Scalars};

/// `fmi2GetReal`, `fmi2GetInteger`, `fmi2GetBoolean`
#[inline]
pub unsafe fn get<M: Model, S: Scalar>(
    component: fmi2Component,
    function: &Function,
    references: *const fmi2ValueReference,
    count: usize,
    values: *mut S,
) -> fmi2Status {
    let body = |component: &mut Component<M>| {
        // SAFETY: the host's arrays have `count` elements.
        let (references, values) = unsafe { (slice(references, count)?, buffer(values, count)?) };
        component.instance.get(Scalars(references), values)
    };
    // SAFETY: the host's component.
    unsafe { call(component, function, body) }
}

/// `fmi2SetReal`, `fmi2SetInteger`, `fmi2SetBoolean`
#[inline]
pub unsafe fn set<M: Model, S: Scalar>(
    component: fmi2Component,
    function: &Function,
    references: *const fmi2ValueReference,
    count: usize,
    values: *const S,
) -> fmi2Status {
    let body = |component: &mut Component<M>| {
        // SAFETY: the host's arrays have `count` elements.
        let (references, values) = unsafe { (slice(references, count)?, slice(values, count)?) };
        component.instance.set(Scalars(references), values)?;
        if let Some(warning) = component.instance.take_warning() {
            component.warn(function, warning);
        }
        Ok(())
    };
    // SAFETY: the host's component.
    unsafe { call(component, function, body) }
}

/// `fmi2SetRealInputDerivatives`
pub unsafe fn set_real_input_derivatives<M: Model>(
    component: fmi2Component,
    function: &Function,
    references: *const fmi2ValueReference,
    count: usize,
    orders: *const fmi2Integer,
    values: *const fmi2Real,
) -> fmi2Status {
    let body = |component: &mut Component<M>| {
        // SAFETY: the host's arrays have `count` elements.
        let (references, orders, values) =
            unsafe { (slice(references, count)?, slice(orders, count)?, slice(values, count)?) };
        component.instance.set_input_derivatives(references, orders, values)
    };
    // SAFETY: the host's component.
    unsafe { call(component, function, body) }
}

/// `fmi2GetRealOutputDerivatives`
pub unsafe fn get_real_output_derivatives<M: Model>(
    component: fmi2Component,
    function: &Function,
    references: *const fmi2ValueReference,
    count: usize,
    orders: *const fmi2Integer,
    values: *mut fmi2Real,
) -> fmi2Status {
    let body = |component: &mut Component<M>| {
        // SAFETY: the host's arrays have `count` elements.
        let (references, orders, values) =
            unsafe { (slice(references, count)?, slice(orders, count)?, buffer(values, count)?) };
        let requests = references.iter().copied().zip(orders.iter().copied());
        component.instance.get_output_derivatives(requests, values)
    };
    // SAFETY: the host's component.
    unsafe { call(component, function, body) }
}
