//! Keeps panics inside the library: none unwinds into the host, and none writes
//! to its standard error.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook};
use std::sync::Once;

use crate::CallError;

/// Makes panics silent, which by default are printed; their text goes to the host's logger instead.
///
/// A panic hook belongs to a copy of the standard library. A `cdylib` has one of its own, so that
/// the hook of a host that is itself written in Rust stays as it is.
pub fn silence() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| set_hook(Box::new(|_| ())));
}

/// Runs `body`; a panic becomes the text that it carries. What `body` was changing may
/// then be half changed.
#[inline]
pub fn contain<R>(body: impl FnOnce() -> R) -> Result<R, CallError> {
    catch_unwind(AssertUnwindSafe(body)).map_err(|payload| panic_error(payload.as_ref()))
}

#[cold]
fn panic_error(payload: &(dyn Any + Send)) -> CallError {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no reason given");
    CallError::error(format!("internal error, please report it: {text}"))
}
