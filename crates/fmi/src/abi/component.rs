//! The target of a host's pointer to an instance, and the only access to it.

use std::ffi::c_void;

use moris_interface::{Identity, Model};

use super::{Function, with_default_arithmetic};
use crate::{CallError, Instance, Mode, Severity, panics};

/// The host of an instance in one version of FMI. The host receives messages and
/// the status of each call.
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
    /// Logs a warning about values that can be used.
    fn warning(&self, text: &str);
    /// Logs why a call failed. Returns the call's status.
    fn failure(&self, severity: Severity, text: &str) -> Self::Status;
}

/// Mark at the beginning of every component until it is freed. Other memory is unlikely to hold it.
const LIVE_INSTANCE_MARK: u64 = u64::from_le_bytes(*b"instance");

/// An instance and its host's logger.
#[repr(C)]
pub struct Component<M, H> {
    /// Checked before any other field is read.
    mark: u64,
    pub instance: Instance<M>,
    pub logger: H,
}

impl<M, H> Component<M, H> {
    /// The pointer that the host gets.
    pub fn into_pointer(instance: Instance<M>, logger: H) -> *mut c_void {
        Box::into_raw(Box::new(Component { mark: LIVE_INSTANCE_MARK, instance, logger })).cast()
    }

    /// The component that `pointer` points to. `None` if the pointer is null or misaligned, or if
    /// the memory does not hold the mark, as after the component was freed.
    ///
    /// # Safety
    /// `pointer` is null or points to readable memory. If it points to a component, that component
    /// is one of the model `M` and the host `H`, and nothing else uses it during `'a`.
    #[inline]
    pub unsafe fn at<'a>(pointer: *mut c_void) -> Option<&'a mut Self> {
        let pointer = pointer.cast::<Self>();
        // SAFETY: the pointer is not null and is aligned where it is read. The caller guarantees
        // readable memory, and any bits are a valid `u64`.
        let marked =
            !pointer.is_null() && pointer.is_aligned() && unsafe { pointer.cast::<u64>().read() } == LIVE_INSTANCE_MARK;
        // SAFETY: the memory has the mark, so `into_pointer` made the component.
        marked.then(|| unsafe { &mut *pointer })
    }

    /// Clears the mark, so that the memory is no longer taken for a component, and frees it.
    ///
    /// # Safety
    /// The component comes from [`Component::at`], and nothing uses it afterwards.
    pub unsafe fn free(component: *mut Self) {
        // SAFETY: the field is valid. The write is volatile, because the compiler sees no later
        // read and would omit it.
        unsafe { (&raw mut (*component).mark).write_volatile(0) };
        // SAFETY: `into_pointer` made it.
        drop(unsafe { Box::from_raw(component) });
    }
}

/// Runs a function of the interface on the component.
///
/// Checks that the function is allowed now, computes with the default arithmetic, reports errors to
/// the host and catches panics.
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
    // SAFETY: guaranteed by the caller.
    let Some(component) = (unsafe { Component::<M, H>::at(component) }) else { return H::ERROR };
    if !function.allowed.contains(component.instance.mode()) {
        return component.not_allowed(function);
    }
    let run = || {
        body(component)?;
        if !component.instance.warnings.is_empty() {
            component.warn(function);
        }
        Ok(())
    };
    match with_default_arithmetic(|| panics::contain(run)) {
        Ok(Ok(())) => H::OK,
        Ok(Err(error)) => component.report(function, error),
        Err(error) => component.fail(function, error),
    }
}

impl<M: Model, H: Host> Component<M, H> {
    /// Sends the warnings that have come up in this function.
    #[cold]
    #[inline(never)]
    fn warn(&mut self, function: &Function) {
        for text in std::mem::take(&mut self.instance.warnings) {
            let text = self.logger.rename(&M::IDENTITY, text);
            self.logger.warning(&format!("{}: {text}", function.name));
        }
    }

    #[cold]
    #[inline(never)]
    fn report(&self, function: &Function, error: CallError) -> H::Status {
        let text = self.logger.rename(&M::IDENTITY, error.text);
        self.logger.failure(error.severity, &format!("{}: {text}", function.name))
    }

    /// Reports a panic and puts the instance into the mode [`Mode::Error`].
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
        let text = format!("not allowed in state '{state}'; allowed in: {allowed}");
        self.report(function, CallError::error(text))
    }
}
