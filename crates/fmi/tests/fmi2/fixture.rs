//! The small model's library, and instances of it in every state.

use std::ffi::CString;
use std::path::PathBuf;

use moris_fmu_host::{Fmu, Instance, Message, Status, variables_of};
use moris_interface::{Identity, Model};

use crate::model::FirstOrder;

pub const IDENTITY: Identity = FirstOrder::IDENTITY;

/// The library, which `cargo test` has put beside the test.
pub fn library() -> PathBuf {
    moris_fmu_host::example_library("first_order")
}

pub fn guid() -> String {
    moris_interface::guid::<FirstOrder>()
}

pub fn open() -> Fmu {
    Fmu::with_variables(&library(), &guid(), variables_of(&IDENTITY)).unwrap()
}

/// The value reference of the variable of this name.
pub fn reference(name: &str) -> u32 {
    IDENTITY.slot(name).unwrap() as u32
}

pub fn instantiated() -> Instance {
    open().instantiate("test").unwrap()
}

pub fn initializing() -> Instance {
    let mut instance = instantiated();
    assert_eq!(instance.setup_experiment(0.0, None), Status::Ok);
    assert_eq!(instance.enter_initialization_mode(), Status::Ok);
    instance
}

pub fn stepping(parameters: &[(&str, f64)]) -> Instance {
    let mut instance = instantiated();
    instance.initialize(parameters, None).unwrap();
    instance
}

pub fn terminated() -> Instance {
    let mut instance = stepping(&[]);
    assert_eq!(instance.terminate(), Status::Ok);
    instance
}

/// An instance whose model has panicked.
pub fn failed() -> Instance {
    let mut instance = stepping(&[("trap", 3.0)]);
    assert_eq!(instance.do_step(0.0, 0.1), Status::Error);
    instance
}

/// The last message of the instance.
pub fn last_message(instance: &Instance) -> Message {
    instance.messages().pop().expect("no message was logged")
}

/// Asserts that the call failed with this status, and that the last message has all of these parts.
#[track_caller]
pub fn assert_call_error(instance: &Instance, status: Status, expected: Status, parts: &[&str]) {
    assert_eq!(status, expected);
    let message = last_message(instance);
    assert_eq!(message.status, expected, "{message:?}");
    let category = if expected == Status::Discard { "logStatusDiscard" } else { "logStatusError" };
    assert_eq!(message.category, category);
    for part in parts {
        assert!(message.text.contains(part), "'{part}' is not in '{}'", message.text);
    }
    assert!(!message.text.ends_with('\n'));
}

/// Everything about an instance, as bytes.
pub fn bytes(instance: &mut Instance) -> Vec<u8> {
    let state = instance.get_state().unwrap();
    let bytes = instance.serialize(&state).unwrap();
    assert_eq!(instance.free_state(state), Status::Ok);
    bytes
}

/// Converts a C string that the library owns.
pub fn text(pointer: *const std::ffi::c_char) -> String {
    // SAFETY: the library returned it.
    unsafe { std::ffi::CStr::from_ptr(pointer) }.to_str().unwrap().into()
}

pub fn c_string(text: &str) -> CString {
    CString::new(text).unwrap()
}
