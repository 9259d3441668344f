//! The target of a host's pointer to an instance, and the only access to it.

use std::ffi::c_void;

use moris_interface::{Identity, Model};

use super::{Function, with_default_arithmetic};
use crate::{CallError, Instance, Mode, Severity, panics};

/// The host of an instance, as one version of FMI has it: takes messages and reports of how calls
/// end.
pub trait Host {
    /// Status of a call.
    type Status;
    /// The call has done what was asked.
    const OK: Self::Status;
    /// Status of a call with a pointer to no instance.
    const ERROR: Self::Status;
    /// The version's name of a mode.
    fn mode_name(mode: Mode) -> &'static str;
    /// Replaces the names of scalar variables in a message by those of the model description
    /// that the host has read.
    fn rename(&self, _identity: &Identity, text: String) -> String {
        text
    }
    /// Reports a stage of the instance's life to a host that logs events.
    fn event(&self, text: &str);
    /// Tells the host why a call does not do what was asked; gives back how the call ends.
    fn failure(&self, severity: Severity, text: &str) -> Self::Status;
}

/// Mark at the beginning of every component until it is freed; unlikely elsewhere.
const MARK: u64 = u64::from_le_bytes(*b"instance");

/// An instance, and where its messages go.
#[repr(C)]
pub struct Component<M, H> {
    /// Looked at before the rest is believed.
    mark: u64,
    pub instance: Instance<M>,
    pub logger: H,
}

impl<M, H> Component<M, H> {
    /// The pointer that the host gets.
    pub fn into_pointer(instance: Instance<M>, logger: H) -> *mut c_void {
        Box::into_raw(Box::new(Component { mark: MARK, instance, logger })).cast()
    }

    /// The component that `pointer` leads to. `None` if it is null or leads to something else, a
    /// freed component for one, as far as that is visible.
    ///
    /// # Safety
    /// `pointer` is null or leads to memory that can be read; if it is a component, it is one of
    /// the model `M` and the host `H`, and nothing else uses it during `'a`.
    #[inline]
    pub unsafe fn at<'a>(pointer: *mut c_void) -> Option<&'a mut Self> {
        let pointer = pointer.cast::<Self>();
        // SAFETY: not null and aligned where it is read; for the rest the caller vouches, and all bits make a mark.
        let marked = !pointer.is_null() && pointer.is_aligned() && unsafe { pointer.cast::<u64>().read() } == MARK;
        // SAFETY: it has the mark, so that `into_pointer` made it.
        marked.then(|| unsafe { &mut *pointer })
    }

    /// Ends the component, so that its memory is no longer taken for one.
    ///
    /// # Safety
    /// The component comes from [`Component::at`], and nobody uses it from here on.
    pub unsafe fn free(component: *mut Self) {
        // SAFETY: the field is there; volatile, for nobody is seen to read it again.
        unsafe { (&raw mut (*component).mark).write_volatile(0) };
        // SAFETY: `into_pointer` made it.
        drop(unsafe { Box::from_raw(component) });
    }
}

/// Runs a function of the interface on the component: checks that the function is allowed now,
/// computes with the default arithmetic, tells the host what went wrong, and lets no panic out.
///
/// # Safety
/// `component` is null, or a component of the model `M` and the host `H` that is not freed yet and
/// that nothing else is using.
#[inline]
pub unsafe fn call<M: Model, H: Host>(
    component: *mut c_void,
    function: &Function,
    body: impl FnOnce(&mut Component<M, H>) -> Result<(), CallError>,
) -> H::Status {
    // SAFETY: the caller vouches for it.
    let Some(component) = (unsafe { Component::<M, H>::at(component) }) else { return H::ERROR };
    if !function.allowed.contains(component.instance.mode()) {
        return component.not_allowed(function);
    }
    match with_default_arithmetic(|| panics::contain(|| body(component))) {
        Ok(Ok(())) => H::OK,
        Ok(Err(error)) => component.report(function, error),
        Err(error) => component.fail(function, error),
    }
}

impl<M: Model, H: Host> Component<M, H> {
    #[cold]
    #[inline(never)]
    fn report(&self, function: &Function, error: CallError) -> H::Status {
        let text = self.logger.rename(&M::IDENTITY, error.text);
        self.logger.failure(error.severity, &format!("{}: {text}", function.name))
    }

    /// Complains of a panic, after which the instance cannot be used.
    #[cold]
    #[inline(never)]
    fn fail(&mut self, function: &Function, error: CallError) -> H::Status {
        self.instance.fail();
        self.report(function, error)
    }

    #[cold]
    #[inline(never)]
    fn not_allowed(&self, function: &Function) -> H::Status {
        let allowed: Vec<_> =
            Mode::ALL.into_iter().filter(|&mode| function.allowed.contains(mode)).map(H::mode_name).collect();
        let allowed = if allowed.is_empty() { "none".into() } else { allowed.join(", ") };
        let state = H::mode_name(self.instance.mode());
        let text = format!("not allowed in state '{state}'; the states in which it is: {allowed}");
        self.report(function, CallError::error(text))
    }
}
