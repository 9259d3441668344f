//! Messages of an FMU.

use std::ffi::{CStr, c_int, c_void};
use std::sync::Mutex;

use crate::api::{Status, Text};

/// A message of an FMU.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Status that the FMU gives with it.
    pub status: Status,
    /// One of the model description's log categories.
    pub category: String,
    pub text: String,
    /// The name of the instance, as the FMU returns it.
    pub instance_name: String,
}

/// The messages so far, oldest first. Its address is the environment that [`log`] gets.
pub(crate) type Messages = Mutex<Vec<Message>>;

/// The host's function for messages: keeps them.
pub(crate) unsafe extern "C" fn log(
    environment: *mut c_void,
    instance_name: Text,
    status: c_int,
    category: Text,
    message: Text,
    argument: Text,
) {
    // On these, arguments in the variable part are passed differently from others.
    const ARGUMENT_UNREADABLE: bool = cfg!(all(target_vendor = "apple", target_arch = "aarch64"));
    // SAFETY: the environment is the address that the host passed, and outlives the instance.
    let Some(messages) = (unsafe { environment.cast::<Messages>().as_ref() }) else { return };
    let string = |text: Text| {
        // SAFETY: the FMU passes strings.
        if text.is_null() { String::new() } else { unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned() }
    };
    let format = string(message);
    let text = if format == "%s" && !ARGUMENT_UNREADABLE { string(argument) } else { format };
    let (category, instance_name) = (string(category), string(instance_name));
    let message = Message { status: status.into(), category, text, instance_name };
    messages.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(message);
}

/// The same for FMI 3.0, whose messages have no arguments.
pub(crate) unsafe extern "C" fn log3(environment: *mut c_void, status: c_int, category: Text, message: Text) {
    // SAFETY: as in `log`.
    unsafe { log(environment, std::ptr::null(), status, category, message, std::ptr::null()) }
}

/// The last messages, as a clause of an error.
pub(crate) fn last(messages: &Messages) -> String {
    let messages = messages.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let last: Vec<_> = messages.iter().rev().take(3).rev().map(|message| message.text.as_str()).collect();
    last.join("; ")
}
