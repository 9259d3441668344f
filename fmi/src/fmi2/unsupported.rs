//! Functions that have to be there and cannot be used.

use model_interface::Model;

use super::calling_sequence::{self as function, Function};
use super::component::{Component, call};
use super::types::*;
use crate::Complaint;

/// `fmi2GetDirectionalDerivative`
pub unsafe fn get_directional_derivative<M: Model>(component: fmi2Component) -> fmi2Status {
    let body = |_: &mut Component<M>| {
        Err(Complaint::error("not provided, as providesDirectionalDerivative in modelDescription.xml says"))
    };
    // SAFETY: the host's component.
    unsafe { call(component, &function::GET_DIRECTIONAL_DERIVATIVE, body) }
}

/// A function of model exchange, or fmi2CancelStep: allowed in no state.
pub unsafe fn never<M: Model>(component: fmi2Component, function: &Function) -> fmi2Status {
    // SAFETY: the host's component.
    unsafe { call(component, function, |_: &mut Component<M>| Ok(())) }
}
