//! Getting and setting variables.

use moris_interface::Model;

use super::Component;
use super::types::*;
use crate::abi::pointers::{buffer, slice};
use crate::{CallError, Scalar, Scalars};

/// `fmi2GetReal`, `fmi2GetInteger`, `fmi2GetBoolean`
#[inline]
pub unsafe fn get<M: Model, S: Scalar>(
    component: &mut Component<M>,
    references: *const fmi2ValueReference,
    count: usize,
    values: *mut S,
) -> Result<(), CallError> {
    // SAFETY: the host's arrays have `count` elements.
    let (references, values) = unsafe { (slice(references, count)?, buffer(values, count)?) };
    component.instance.get(Scalars(references), values)
}

/// `fmi2SetReal`, `fmi2SetInteger`, `fmi2SetBoolean`
#[inline]
pub unsafe fn set<M: Model, S: Scalar>(
    component: &mut Component<M>,
    references: *const fmi2ValueReference,
    count: usize,
    values: *const S,
) -> Result<(), CallError> {
    // SAFETY: the host's arrays have `count` elements.
    let (references, values) = unsafe { (slice(references, count)?, slice(values, count)?) };
    component.instance.set(Scalars(references), values)
}

/// `fmi2SetRealInputDerivatives`
pub unsafe fn set_real_input_derivatives<M: Model>(
    component: &mut Component<M>,
    references: *const fmi2ValueReference,
    count: usize,
    orders: *const fmi2Integer,
    values: *const fmi2Real,
) -> Result<(), CallError> {
    // SAFETY: the host's arrays have `count` elements.
    let (references, orders, values) =
        unsafe { (slice(references, count)?, slice(orders, count)?, slice(values, count)?) };
    component.instance.set_input_derivatives(references, orders, values)
}

/// `fmi2GetRealOutputDerivatives`
pub unsafe fn get_real_output_derivatives<M: Model>(
    component: &mut Component<M>,
    references: *const fmi2ValueReference,
    count: usize,
    orders: *const fmi2Integer,
    values: *mut fmi2Real,
) -> Result<(), CallError> {
    // SAFETY: the host's arrays have `count` elements.
    let (references, orders, values) =
        unsafe { (slice(references, count)?, slice(orders, count)?, buffer(values, count)?) };
    let requests = references.iter().copied().zip(orders.iter().copied());
    component.instance.get_output_derivatives(requests, values)
}
