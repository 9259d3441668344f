//! The parts of an instance's life that every version of FMI has alike.

use std::ffi::c_void;

use moris_interface::Model;

use super::{Component, Function, Host, call};
use crate::{Mode, panics};

/// `fmi2FreeInstance`, `fmi3FreeInstance`; what is no instance is ignored.
pub unsafe fn free_instance<M: Model, H: Host>(component: *mut c_void) {
    // SAFETY: the host hands back what the version's `instantiate` made.
    let Some(component) = (unsafe { Component::<M, H>::at(component) }) else { return };
    // A panic now cannot be reported.
    // SAFETY: as above.
    let _ = panics::contain(|| unsafe { Component::free(component) });
}

/// `fmi2ExitInitializationMode`, `fmi3ExitInitializationMode`
pub unsafe fn exit_initialization_mode<M: Model, H: Host>(component: *mut c_void, function: &Function) -> H::Status {
    let body = |component: &mut Component<M, H>| {
        component.instance.exit_initialization()?;
        for warning in component.instance.warnings() {
            component.logger.warning(&component.logger.rename(&M::IDENTITY, warning));
        }
        component.logger.event("initialized");
        Ok(())
    };
    // SAFETY: the host's component.
    unsafe { call(component, function, body) }
}

/// `fmi2Terminate`, `fmi3Terminate`
pub unsafe fn terminate<M: Model, H: Host>(component: *mut c_void, function: &Function) -> H::Status {
    let body = |component: &mut Component<M, H>| {
        component.instance.state.mode = Mode::Terminated;
        component.logger.event("terminated");
        Ok(())
    };
    // SAFETY: the host's component.
    unsafe { call(component, function, body) }
}

/// `fmi2Reset`, `fmi3Reset`
pub unsafe fn reset<M: Model, H: Host>(component: *mut c_void, function: &Function) -> H::Status {
    let body = |component: &mut Component<M, H>| {
        component.instance.reset();
        component.logger.event("reset");
        Ok(())
    };
    // SAFETY: the host's component.
    unsafe { call(component, function, body) }
}
