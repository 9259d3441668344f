//! Getting and setting variables.

use std::ops::RangeInclusive;

use moris_interface::Model;

use super::arrays::Arrays;
use super::types::*;
use super::{Component, Layout};
use crate::abi::pointers::{buffer, slice};
use crate::{CallError, Scalar, Scalars, VariableInfo};

/// `fmi3GetFloat64`, `fmi3GetInt32`, `fmi3GetInt64`, `fmi3GetBoolean`
#[inline]
pub unsafe fn get<M: Model, S: Scalar>(
    component: &mut Component<M>,
    references: *const fmi3ValueReference,
    count: usize,
    values: *mut S,
    value_count: usize,
) -> Result<(), CallError> {
    // SAFETY: the host's arrays have `count` and `value_count` elements.
    let (references, values) = unsafe { (slice(references, count)?, buffer(values, value_count)?) };
    let infos = component.instance.tables().infos;
    check_length::<M>(component.logger.layout, infos, references, value_count)?;
    // A value each: there is no array among them.
    if references.len() == value_count {
        return component.instance.get(Scalars(references), values);
    }
    component.instance.get(Arrays { infos, references }, values)
}

/// `fmi3SetFloat64`, `fmi3SetInt32`, `fmi3SetInt64`, `fmi3SetBoolean`
#[inline]
pub unsafe fn set<M: Model, S: Scalar>(
    component: &mut Component<M>,
    references: *const fmi3ValueReference,
    count: usize,
    values: *const S,
    value_count: usize,
) -> Result<(), CallError> {
    // SAFETY: the host's arrays have `count` and `value_count` elements.
    let (references, values) = unsafe { (slice(references, count)?, slice(values, value_count)?) };
    let infos = component.instance.tables().infos;
    check_length::<M>(component.logger.layout, infos, references, value_count)?;
    // A value each: there is no array among them.
    if references.len() == value_count {
        return component.instance.set(Scalars(references), values);
    }
    component.instance.set(Arrays { infos, references }, values)
}

/// `fmi3GetOutputDerivatives`
pub unsafe fn get_output_derivatives<M: Model>(
    component: &mut Component<M>,
    references: *const fmi3ValueReference,
    count: usize,
    orders: *const i32,
    values: *mut f64,
    value_count: usize,
) -> Result<(), CallError> {
    // SAFETY: the host's arrays have `count` and `value_count` elements.
    let (references, orders, values) =
        unsafe { (slice(references, count)?, slice(orders, count)?, buffer(values, value_count)?) };
    let infos = component.instance.tables().infos;
    let layout = component.logger.layout;
    check_length::<M>(layout, infos, references, value_count)?;
    let pairs = references.iter().zip(orders);
    let requests = pairs
        .flat_map(move |(&reference, &order)| variable_slots(layout, infos, reference).map(move |slot| (slot, order)));
    component.instance.get_output_derivatives(requests, values)
}

/// Checks that the host has as many values as the variables; with arrays, that the
/// references are variables', too.
#[inline]
fn check_length<M: Model>(
    layout: Layout,
    infos: &[VariableInfo],
    references: &[fmi3ValueReference],
    value_count: usize,
) -> Result<(), CallError> {
    let expected = match layout {
        Layout::Scalars => references.len(),
        Layout::Arrays => total_length::<M>(infos, references)?,
    };
    if expected == value_count { Ok(()) } else { Err(wrong_length::<M>(layout, references, expected, value_count)) }
}

/// Number of values that array variables have together.
#[inline]
fn total_length<M: Model>(infos: &[VariableInfo], references: &[fmi3ValueReference]) -> Result<usize, CallError> {
    let mut total = 0;
    for &reference in references {
        match infos.get(reference as usize) {
            Some(info) if info.row_slots > 0 => total += info.row_slots as usize,
            _ => return Err(no_such_variable::<M>(reference)),
        }
    }
    Ok(total)
}

/// The slots of a variable. With arrays, the variable has to be there.
fn variable_slots(layout: Layout, infos: &[VariableInfo], reference: fmi3ValueReference) -> RangeInclusive<u32> {
    let others = match layout {
        Layout::Scalars => 0,
        Layout::Arrays => infos[reference as usize].row_slots - 1,
    };
    reference..=reference + others
}

#[cold]
fn no_such_variable<M: Model>(reference: fmi3ValueReference) -> CallError {
    let identity = M::IDENTITY;
    let slot = reference as usize;
    CallError::error(match identity.slots.get(slot) {
        None => format!("no variable has the value reference {reference}"),
        Some(place) => format!(
            "no variable has the value reference {reference}: the array '{}' has {}",
            identity.row(slot).array_name(),
            slot - usize::from(place.element)
        ),
    })
}

#[cold]
fn wrong_length<M: Model>(
    layout: Layout,
    references: &[fmi3ValueReference],
    expected: usize,
    value_count: usize,
) -> CallError {
    let identity = M::IDENTITY;
    if let Some(unknown) = references.iter().find(|&&reference| reference as usize >= identity.slots.len()) {
        return no_such_variable::<M>(*unknown);
    }
    let name = |&reference: &u32| format!("'{}'", layout.variable_name(&identity, reference as usize));
    let names: Vec<_> = references.iter().take(5).map(name).collect();
    let who = match (references.len(), names.join(", ")) {
        (0, _) => "no variables have".to_owned(),
        (1, names) => format!("{names} has"),
        (2..=5, names) => format!("{names} together have"),
        (_, names) => format!("{names} and others together have"),
    };
    CallError::error(format!("{who} {expected} values, and the call comes with {value_count}"))
}
