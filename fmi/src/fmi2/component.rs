//! What an fmi2Component points to, and the one way into it.

use model_interface::Model;

use super::calling_sequence::Function;
use super::logger::Logger;
use super::types::{fmi2Component, fmi2Status};
use crate::{Complaint, Instance, Severity, panics};

/// An instance, and where its messages go.
pub struct Component<M> {
    pub instance: Instance<M>,
    pub logger: Logger,
}

/// Runs a function of the interface on the component: checks that the function is allowed now, tells the host what went
/// wrong, and lets no panic out.
///
/// # Safety
/// `component` is null, or a component of the model `M` that is not freed yet and that nothing else is using.
#[inline]
pub unsafe fn call<M: Model>(
    component: fmi2Component,
    function: &Function,
    body: impl FnOnce(&mut Component<M>) -> Result<(), Complaint>,
) -> fmi2Status {
    // SAFETY: the caller vouches for it.
    let Some(component) = (unsafe { component.cast::<Component<M>>().as_mut() }) else { return fmi2Status::fmi2Error };
    if !function.allowed.contains(component.instance.mode()) {
        return component.not_allowed(function);
    }
    match panics::contain(|| body(component)) {
        Ok(Ok(())) => fmi2Status::fmi2OK,
        Ok(Err(complaint)) => component.complain(function, &complaint),
        Err(complaint) => {
            component.instance.fail();
            component.complain(function, &complaint)
        }
    }
}

impl<M: Model> Component<M> {
    #[cold]
    #[inline(never)]
    fn complain(&self, function: &Function, complaint: &Complaint) -> fmi2Status {
        let status = match complaint.severity {
            Severity::Discard => fmi2Status::fmi2Discard,
            Severity::Error => fmi2Status::fmi2Error,
        };
        self.logger.failure(status, &format!("{}: {}", function.name, complaint.text));
        status
    }

    #[cold]
    #[inline(never)]
    fn not_allowed(&self, function: &Function) -> fmi2Status {
        let (state, allowed) = (self.instance.mode().name(), function.allowed.names());
        let text = format!("not allowed in state '{state}'; the states in which it is: {allowed}");
        self.complain(function, &Complaint::error(text))
    }
}
