//! The small model's library, and instances of it in every state.

use std::ffi::{CStr, CString, c_int, c_void};
use std::path::PathBuf;
use std::ptr::{null, null_mut};
use std::sync::Mutex;

use moris_fmi::fmi3::Layout;
use moris_fmu_host::fmi3::{self, Api, FmuState, Library, Text};
use moris_interface::{Identity, Model};

use crate::model::Lags;

pub const IDENTITY: Identity = Lags::IDENTITY;

pub const OK: c_int = 0;
pub const WARNING: c_int = 1;
pub const DISCARD: c_int = 2;
pub const ERROR: c_int = 3;

/// The library, which `cargo test` has put beside the test.
pub fn library() -> PathBuf {
    moris_fmu_host::example_library("lags")
}

pub fn open() -> Library {
    Library::open(&library()).unwrap()
}

/// The token of the description with arrays.
pub fn token() -> CString {
    token_of(Layout::Arrays)
}

pub fn token_of(layout: Layout) -> CString {
    CString::new(layout.token(&moris_interface::guid::<Lags>())).unwrap()
}

/// The value reference of the variable, or array, of this name.
pub fn reference(name: &str) -> u32 {
    let is_it = |&slot: &usize| IDENTITY.row(slot).array_name() == name;
    (0..IDENTITY.slots.len()).find(is_it).unwrap_or_else(|| panic!("no {name}")) as u32
}

/// A message of the FMU: status, category, text.
pub type Entry = (c_int, String, String);
type Messages = Mutex<Vec<Entry>>;

pub unsafe extern "C" fn log(environment: *mut c_void, status: c_int, category: Text, message: Text) {
    // SAFETY: the environment is the one passed with this function.
    let messages = unsafe { &*environment.cast::<Messages>() };
    messages.lock().unwrap().push((status, text(category), text(message)));
}

pub fn environment(messages: &Messages) -> *mut c_void {
    (&raw const *messages).cast_mut().cast()
}

/// Converts a C string that lives.
pub fn text(pointer: Text) -> String {
    // SAFETY: the library passed it.
    unsafe { CStr::from_ptr(pointer) }.to_str().unwrap().into()
}

/// An instance, freed when it is dropped.
pub struct Instance {
    pub pointer: fmi3::Instance,
    messages: Box<Messages>,
    library: Library,
}

impl Instance {
    /// An instance with array variables.
    pub fn new() -> Self {
        Self::with(Layout::Arrays)
    }

    pub fn with(layout: Layout) -> Self {
        let library = open();
        let messages = Box::new(Messages::default());
        // SAFETY: strings live during the call, the messages longer than the instance.
        let pointer = unsafe {
            let environment = environment(&messages);
            let (name, token) = (c"test".as_ptr(), token_of(layout));
            let instantiate = library.api().instantiate_co_simulation;
            instantiate(name, token.as_ptr(), null(), 0, 1, 0, 0, null(), 0, environment, Some(log), None)
        };
        assert!(!pointer.is_null(), "{messages:?}");
        Instance { pointer, messages, library }
    }

    pub fn api(&self) -> &Api {
        self.library.api()
    }

    pub fn messages(&self) -> Vec<Entry> {
        self.messages.lock().unwrap().clone()
    }

    pub fn last_message(&self) -> Entry {
        self.messages().pop().expect("no message was logged")
    }

    /// Asserts that the call failed with this status, and that the last message
    /// has all of these parts.
    #[track_caller]
    pub fn assert_call_error(&self, status: c_int, expected: c_int, parts: &[&str]) {
        let (said_status, category, text) = self.last_message();
        assert_eq!((status, said_status), (expected, expected), "{text}");
        assert_eq!(category, if expected == DISCARD { "logStatusDiscard" } else { "logStatusError" });
        parts.iter().for_each(|part| assert!(text.contains(part), "'{part}' is not in '{text}'"));
    }

    pub fn enter_initialization_mode(&self, start: f64, stop: Option<f64>) -> c_int {
        let (defined, stop) = (u8::from(stop.is_some()), stop.unwrap_or(0.0));
        // SAFETY: the instance is alive.
        unsafe { (self.api().enter_initialization_mode)(self.pointer, 0, 0.0, start, defined, stop) }
    }

    pub fn exit_initialization_mode(&self) -> c_int {
        // SAFETY: the instance is alive.
        unsafe { (self.api().exit_initialization_mode)(self.pointer) }
    }

    pub fn reset(&self) -> c_int {
        // SAFETY: the instance is alive.
        unsafe { (self.api().reset)(self.pointer) }
    }

    /// The status and the last successful time.
    pub fn do_step(&self, time: f64, step: f64) -> (c_int, f64) {
        let (mut event, mut terminate, mut early, mut last) = (7, 7, 7, f64::NAN);
        // SAFETY: the instance is alive, and there is room for the answers.
        let status = unsafe {
            (self.api().do_step)(self.pointer, time, step, 1, &mut event, &mut terminate, &mut early, &mut last)
        };
        if status == OK {
            assert_eq!((event, terminate, early), (0, 0, 0));
        }
        (status, last)
    }

    pub fn get(&self, references: &[u32], values: &mut [f64]) -> c_int {
        let (count, size) = (references.len(), values.len());
        // SAFETY: the instance is alive, and the arrays are as long as said.
        unsafe { (self.api().get_float64)(self.pointer, references.as_ptr(), count, values.as_mut_ptr(), size) }
    }

    pub fn set(&self, references: &[u32], values: &[f64]) -> c_int {
        let (count, size) = (references.len(), values.len());
        // SAFETY: the instance is alive, and the arrays are as long as said.
        unsafe { (self.api().set_float64)(self.pointer, references.as_ptr(), count, values.as_ptr(), size) }
    }

    /// The values of the reals of this name.
    #[track_caller]
    pub fn real<const N: usize>(&self, name: &str) -> [f64; N] {
        let mut values = [f64::NAN; N];
        assert_eq!(self.get(&[reference(name)], &mut values), OK, "{name}");
        values
    }

    #[track_caller]
    pub fn set_real(&self, name: &str, values: &[f64]) {
        assert_eq!(self.set(&[reference(name)], values), OK, "{name}");
    }

    #[track_caller]
    pub fn set_boolean(&self, name: &str, value: bool) {
        // SAFETY: the instance is alive, and the arrays have one element.
        let status = unsafe { (self.api().set_boolean)(self.pointer, &reference(name), 1, &u8::from(value), 1) };
        assert_eq!(status, OK, "{name}");
    }

    pub fn get_state(&self) -> FmuState {
        let mut state = null_mut();
        // SAFETY: the instance is alive.
        assert_eq!(unsafe { (self.api().get_fmu_state)(self.pointer, &mut state) }, OK);
        state
    }

    pub fn set_state(&self, state: FmuState) -> c_int {
        // SAFETY: the instance is alive, and so is the state.
        unsafe { (self.api().set_fmu_state)(self.pointer, state) }
    }

    pub fn free_state(&self, mut state: FmuState) {
        // SAFETY: the instance is alive, and so is the state.
        assert_eq!(unsafe { (self.api().free_fmu_state)(self.pointer, &mut state) }, OK);
        assert!(state.is_null());
    }

    pub fn serialize(&self, state: FmuState) -> Vec<u8> {
        let mut size = 0;
        // SAFETY: the instance is alive, so is the state, and there is room for as many bytes as wanted.
        unsafe {
            assert_eq!((self.api().serialized_fmu_state_size)(self.pointer, state, &mut size), OK);
            let mut bytes = vec![0; size];
            assert_eq!((self.api().serialize_fmu_state)(self.pointer, state, bytes.as_mut_ptr(), size), OK);
            bytes
        }
    }

    /// The state that the bytes are, or how the call ended.
    pub fn deserialize(&self, bytes: &[u8]) -> Result<FmuState, c_int> {
        let mut state = null_mut();
        // SAFETY: the instance is alive.
        match unsafe { (self.api().deserialize_fmu_state)(self.pointer, bytes.as_ptr(), bytes.len(), &mut state) } {
            OK => Ok(state),
            status => Err(status),
        }
    }

    /// Everything about the instance, as bytes.
    pub fn bytes(&self) -> Vec<u8> {
        let state = self.get_state();
        let bytes = self.serialize(state);
        self.free_state(state);
        bytes
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: the instance is alive, and nobody uses it from here on.
        unsafe { (self.api().free_instance)(self.pointer) }
    }
}

pub fn initializing() -> Instance {
    let instance = Instance::new();
    assert_eq!(instance.enter_initialization_mode(0.0, None), OK);
    instance
}

pub fn stepping() -> Instance {
    let instance = initializing();
    assert_eq!(instance.exit_initialization_mode(), OK);
    instance
}

pub fn terminated() -> Instance {
    let instance = stepping();
    // SAFETY: the instance is alive.
    assert_eq!(unsafe { (instance.api().terminate)(instance.pointer) }, OK);
    instance
}

/// An instance whose model has panicked.
pub fn failed() -> Instance {
    let instance = stepping();
    instance.set_boolean("trap", true);
    assert_eq!(instance.do_step(0.0, 0.1).0, ERROR);
    instance
}
