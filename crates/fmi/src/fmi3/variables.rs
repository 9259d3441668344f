//! Getting and setting variables.

use std::ops::Range;

use moris_interface::Model;

use super::arrays::Arrays;
use super::types::*;
use super::{Component, calling_sequence as function};
use crate::abi::pointers::{room, slice};
use crate::abi::{Function, call};
use crate::{Complaint, Scalar, Scalars, VariableCheck};

/// `fmi3GetFloat64`, `fmi3GetInt32`, `fmi3GetInt64`, `fmi3GetBoolean`
#[inline]
pub unsafe fn get<M: Model, S: Scalar>(
    instance: fmi3Instance,
    function: &Function,
    references: *const fmi3ValueReference,
    count: usize,
    values: *mut S,
    value_count: usize,
) -> fmi3Status {
    let body = |component: &mut Component<M>| {
        // SAFETY: the host's arrays have `count` and `value_count` elements.
        let (references, values) = unsafe { (slice(references, count)?, room(values, value_count)?) };
        let checks = component.instance.tables().checks;
        check_length::<M>(checks, references, value_count)?;
        // A value each: there is no array among them.
        if references.len() == value_count {
            return component.instance.get(Scalars(references), values);
        }
        component.instance.get(Arrays { checks, references }, values)
    };
    // SAFETY: the host's component.
    unsafe { call(instance, function, body) }
}

/// `fmi3SetFloat64`, `fmi3SetInt32`, `fmi3SetInt64`, `fmi3SetBoolean`
#[inline]
pub unsafe fn set<M: Model, S: Scalar>(
    instance: fmi3Instance,
    function: &Function,
    references: *const fmi3ValueReference,
    count: usize,
    values: *const S,
    value_count: usize,
) -> fmi3Status {
    let body = |component: &mut Component<M>| {
        // SAFETY: the host's arrays have `count` and `value_count` elements.
        let (references, values) = unsafe { (slice(references, count)?, slice(values, value_count)?) };
        let checks = component.instance.tables().checks;
        check_length::<M>(checks, references, value_count)?;
        // A value each: there is no array among them.
        if references.len() == value_count {
            return component.instance.set(Scalars(references), values);
        }
        component.instance.set(Arrays { checks, references }, values)
    };
    // SAFETY: the host's component.
    unsafe { call(instance, function, body) }
}

/// The get and set functions of a type that no variable has: right for no variables.
pub unsafe fn none_of_this_type<M: Model>(instance: fmi3Instance, function: &Function, count: usize) -> fmi3Status {
    let body = |_: &mut Component<M>| match count {
        0 => Ok(()),
        _ => Err(Complaint::error("the model has no variables of this type")),
    };
    // SAFETY: the host's component.
    unsafe { call(instance, function, body) }
}

/// `fmi3GetOutputDerivatives`
pub unsafe fn get_output_derivatives<M: Model>(
    instance: fmi3Instance,
    references: *const fmi3ValueReference,
    count: usize,
    orders: *const i32,
    values: *mut f64,
    value_count: usize,
) -> fmi3Status {
    let body = |component: &mut Component<M>| {
        // SAFETY: the host's arrays have `count` and `value_count` elements.
        let (references, orders, values) =
            unsafe { (slice(references, count)?, slice(orders, count)?, room(values, value_count)?) };
        let checks = component.instance.tables().checks;
        check_length::<M>(checks, references, value_count)?;
        let pairs = references.iter().zip(orders);
        let requests =
            pairs.flat_map(move |(reference, &order)| row_slots(checks, *reference).map(move |slot| (slot, order)));
        component.instance.get_output_derivatives(requests, values)
    };
    // SAFETY: the host's component.
    unsafe { call(instance, &function::GET_OUTPUT_DERIVATIVES, body) }
}

/// Checks that the references are variables', and that these have as many values as the host.
#[inline]
fn check_length<M: Model>(
    checks: &[VariableCheck],
    references: &[fmi3ValueReference],
    value_count: usize,
) -> Result<(), Complaint> {
    let mut expected = 0;
    for &reference in references {
        match checks.get(reference as usize) {
            Some(check) if check.row_slots > 0 => expected += check.row_slots as usize,
            _ => return Err(no_such_variable::<M>(reference)),
        }
    }
    if expected == value_count { Ok(()) } else { Err(wrong_length::<M>(references, expected, value_count)) }
}

/// The slots of a variable that is there.
#[inline]
fn row_slots(checks: &[VariableCheck], reference: fmi3ValueReference) -> Range<u32> {
    reference..reference + checks[reference as usize].row_slots
}

#[cold]
fn no_such_variable<M: Model>(reference: fmi3ValueReference) -> Complaint {
    let identity = M::IDENTITY;
    let slot = reference as usize;
    Complaint::error(match identity.slots.get(slot) {
        None => format!("no variable has the value reference {reference}"),
        Some(place) => format!(
            "no variable has the value reference {reference}: the array '{}' has {}",
            identity.row(slot).array_name(),
            slot - usize::from(place.element)
        ),
    })
}

#[cold]
fn wrong_length<M: Model>(references: &[fmi3ValueReference], expected: usize, value_count: usize) -> Complaint {
    let name = |&reference: &u32| format!("'{}'", M::IDENTITY.row(reference as usize).array_name());
    let names: Vec<_> = references.iter().take(5).map(name).collect();
    let who = match (references.len(), names.join(", ")) {
        (0, _) => "no variables have".to_owned(),
        (1, names) => format!("{names} has"),
        (2..=5, names) => format!("{names} together have"),
        (_, names) => format!("{names} and others together have"),
    };
    Complaint::error(format!("{who} {expected} values, and the call comes with {value_count}"))
}
