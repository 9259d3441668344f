//! The host's logger, which keeps an instance's messages until they are read.

use std::ffi::{CStr, c_int, c_void};

use moris_fmu_host::api::Text;

/// Arguments of one call of the logger.
#[derive(Debug)]
pub struct Message {
    pub status: c_int,
    pub category: String,
    pub text: String,
}

/// Messages to one instance's logger; its address is the instance's environment.
#[derive(Debug, Default)]
pub struct Log {
    pub name: String,
    pub messages: Vec<Message>,
}

impl Log {
    fn say(&mut self, status: c_int, category: Text, text: Text) {
        self.messages.push(Message { status, category: string(category), text: string(text) });
    }
}

/// fmi2CallbackLogger. The library calls it with one string for the format's one `%s`.
pub unsafe extern "C" fn log2(
    environment: *mut c_void,
    instance_name: Text,
    status: c_int,
    category: Text,
    message: Text,
    argument: Text,
) {
    // SAFETY: the environment is the log that `instantiate` was given, which nobody uses during a call.
    let log = unsafe { &mut *environment.cast::<Log>() };
    assert_eq!(string(instance_name), log.name);
    assert_eq!(string(message), "%s", "a text must never be a format");
    log.say(status, category, argument);
}

/// fmi3LogMessageCallback
pub unsafe extern "C" fn log3(environment: *mut c_void, status: c_int, category: Text, message: Text) {
    // SAFETY: as above.
    let log = unsafe { &mut *environment.cast::<Log>() };
    log.say(status, category, message);
}

fn string(text: Text) -> String {
    assert!(!text.is_null());
    // SAFETY: the library passes strings ended by a zero.
    unsafe { CStr::from_ptr(text) }.to_str().expect("UTF-8").into()
}
