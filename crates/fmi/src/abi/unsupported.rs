//! Functions that have to be there and cannot be used.

use std::ffi::c_void;

use moris_interface::Model;

use super::{Component, Function, Host, call};
use crate::CallError;

/// A function that is allowed in no state.
pub unsafe fn never_allowed<M: Model, H: Host>(component: *mut c_void, function: &Function) -> H::Status {
    // SAFETY: the host's component.
    unsafe { call(component, function, |_: &mut Component<M, H>| Ok(())) }
}

/// A function for what the FMU does not offer, as the attribute `capability` of its
/// model description says.
pub unsafe fn not_provided<M: Model, H: Host>(
    component: *mut c_void,
    function: &Function,
    capability: &str,
) -> H::Status {
    let body = |_: &mut Component<M, H>| {
        Err(CallError::error(format!("not provided, as {capability} in modelDescription.xml says")))
    };
    // SAFETY: the host's component.
    unsafe { call(component, function, body) }
}

/// A get or set function of a type that no variable has. It succeeds for no variables.
pub unsafe fn none_of_this_type<M: Model, H: Host>(
    component: *mut c_void,
    function: &Function,
    count: usize,
) -> H::Status {
    let body = |_: &mut Component<M, H>| match count {
        0 => Ok(()),
        _ => Err(CallError::error("the model has no variables of this type")),
    };
    // SAFETY: the host's component.
    unsafe { call(component, function, body) }
}
