//! Functions that have to be there and cannot be used. Those that are never allowed are
//! [`abi::lifecycle::unsupported`](crate::abi::lifecycle::unsupported).

use moris_interface::Model;

use super::Component;
use super::types::*;
use crate::CallError;
use crate::abi::{Function, call};

/// A function for what the FMU does not offer, as the attribute `capability` of its
/// model description says.
pub unsafe fn not_provided<M: Model>(instance: fmi3Instance, function: &Function, capability: &str) -> fmi3Status {
    let body = |_: &mut Component<M>| {
        Err(CallError::error(format!("not provided, as {capability} in modelDescription.xml says")))
    };
    // SAFETY: the host's component.
    unsafe { call(instance, function, body) }
}
