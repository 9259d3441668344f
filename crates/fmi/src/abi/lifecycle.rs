//! The parts of an instance's life that every version of FMI has alike.

use std::ffi::c_void;

use moris_interface::Model;

use super::{Component, Host};
use crate::{CallError, Mode, panics};

/// `fmi2FreeInstance`, `fmi3FreeInstance`; what is no instance is ignored.
pub unsafe fn free_instance<M: Model, H: Host>(component: *mut c_void) {
    // SAFETY: the host hands back what the version's `instantiate` made.
    let Some(component) = (unsafe { Component::<M, H>::at(component) }) else { return };
    // A panic now cannot be reported.
    // SAFETY: as above.
    let _ = panics::contain(|| unsafe { Component::free(component) });
}

/// `fmi2ExitInitializationMode`, `fmi3ExitInitializationMode`
pub fn exit_initialization_mode<M: Model, H: Host>(component: &mut Component<M, H>) -> Result<(), CallError> {
    component.instance.exit_initialization()?;
    component.logger.event("initialized");
    Ok(())
}

/// `fmi2Terminate`, `fmi3Terminate`
pub fn terminate<M: Model, H: Host>(component: &mut Component<M, H>) -> Result<(), CallError> {
    component.instance.state.mode = Mode::Terminated;
    component.logger.event("terminated");
    Ok(())
}

/// `fmi2Reset`, `fmi3Reset`
pub fn reset<M: Model, H: Host>(component: &mut Component<M, H>) -> Result<(), CallError> {
    component.instance.reset();
    component.logger.event("reset");
    Ok(())
}
