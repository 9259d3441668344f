//! Communication steps.

use moris_interface::Model;

use super::types::*;
use super::{Component, calling_sequence as function};
use crate::abi::call;

/// `fmi2DoStep`
#[inline]
pub unsafe fn do_step<M: Model>(component: fmi2Component, time: fmi2Real, step: fmi2Real) -> fmi2Status {
    let body = |component: &mut Component<M>| component.instance.step(time, step);
    // SAFETY: the host's component.
    unsafe { call(component, &function::DO_STEP, body) }
}
