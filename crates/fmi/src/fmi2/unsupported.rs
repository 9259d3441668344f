//! A function that has to be there and cannot be used. Those that are never allowed are
//! [`abi::lifecycle::unsupported`](crate::abi::lifecycle::unsupported).

use moris_interface::Model;

use super::types::*;
use super::{Component, calling_sequence as function};
use crate::CallError;
use crate::abi::call;

/// `fmi2GetDirectionalDerivative`
pub unsafe fn get_directional_derivative<M: Model>(component: fmi2Component) -> fmi2Status {
    let body = |_: &mut Component<M>| {
        Err(CallError::error("not provided, as providesDirectionalDerivative in modelDescription.xml says"))
    };
    // SAFETY: the host's component.
    unsafe { call(component, &function::GET_DIRECTIONAL_DERIVATIVE, body) }
}
