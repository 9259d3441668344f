//! A model's library, and instances of it by either version of FMI.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::{Path, PathBuf};
use std::ptr::null;

use moris_fmu_host::{Fmu, api, fmi3};
use moris_interface::{Identity, Kind, Model, SlotModel};
use moris_motorcycle::Motorcycle;
use moris_stewart_platform::StewartPlatform;
use moris_washout::Washout;

/// A model whose library the tests load.
#[derive(Clone, Copy)]
pub struct TestedModel {
    pub identity: Identity,
    library: &'static str,
    guid: fn() -> String,
    start: fn(&mut [f64]),
}

impl TestedModel {
    const fn of<M: Model>(library: &'static str) -> Self {
        TestedModel { identity: M::IDENTITY, library, guid: moris_interface::guid::<M>, start: M::start_slots }
    }

    /// The library, which `cargo test` has put beside the test.
    pub fn library(&self) -> PathBuf {
        moris_fmu_host::example_library(self.library)
    }

    /// The start value of each slot.
    pub fn start(&self) -> Vec<f64> {
        let mut slots = vec![0.0; self.identity.slots.len()];
        (self.start)(&mut slots);
        slots
    }

    pub fn slots(&self) -> impl Iterator<Item = usize> {
        0..self.identity.slots.len()
    }
}

/// Every model.
pub const MODELS: [TestedModel; 3] = [
    TestedModel::of::<Washout>("washout_library"),
    TestedModel::of::<Motorcycle>("motorcycle_library"),
    TestedModel::of::<StewartPlatform>("stewart_platform_library"),
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    Fmi2,
    Fmi3,
}

pub const VERSIONS: [Version; 2] = [Version::Fmi2, Version::Fmi3];

/// Statuses of a call, in both versions.
pub const OK: c_int = 0;
pub const DISCARD: c_int = 2;

/// Messages logged by an instance.
pub type Messages = RefCell<Vec<String>>;

/// An open library.
pub struct Library {
    model: TestedModel,
    guid: CString,
    functions: Functions,
}

#[expect(clippy::large_enum_variant, reason = "a test has two of them")]
enum Functions {
    Fmi2(Fmu),
    Fmi3(fmi3::Library),
}

impl Library {
    /// Opens the model's library, or a copy of it.
    pub fn open(model: TestedModel, version: Version, file: &Path) -> Self {
        let functions = match version {
            Version::Fmi2 => Functions::Fmi2(Fmu::from_library(file, "").unwrap()),
            Version::Fmi3 => Functions::Fmi3(fmi3::Library::open(file).unwrap()),
        };
        Library { model, guid: CString::new((model.guid)()).unwrap(), functions }
    }

    /// An instance, which logs to `messages`; `None` where the library refuses to make one.
    pub fn instantiate<'a>(&'a self, messages: &'a Messages) -> Option<Instance<'a>> {
        let environment: *mut c_void = std::ptr::from_ref(messages).cast_mut().cast();
        let (name, guid) = (c"instance".as_ptr(), self.guid.as_ptr());
        let pointer = match &self.functions {
            Functions::Fmi2(fmu) => {
                let callbacks = api::Callbacks {
                    logger: Some(log_fmi2),
                    allocate_memory: None,
                    free_memory: None,
                    step_finished: None,
                    environment,
                };
                // SAFETY: the strings and the callbacks live during the call, and the messages as long as the instance.
                unsafe { (fmu.api().instantiate)(name, api::CO_SIMULATION, guid, null(), &callbacks, 0, 1) }
            }
            // SAFETY: the strings live during the call, and the messages as long as the instance.
            Functions::Fmi3(library) => unsafe {
                let instantiate = library.api().instantiate_co_simulation;
                instantiate(name, guid, null(), 0, 1, 0, 0, null(), 0, environment, Some(log_fmi3), None)
            },
        };
        (!pointer.is_null()).then_some(Instance { library: self, pointer })
    }
}

unsafe extern "C" fn log_fmi2(
    environment: *mut c_void,
    _: *const c_char,
    _: c_int,
    _: *const c_char,
    _: *const c_char,
    text: *const c_char,
) {
    // SAFETY: the message is "%s" and its argument a string; the environment is the test's.
    unsafe { log(environment, text) }
}

unsafe extern "C" fn log_fmi3(environment: *mut c_void, _: c_int, _: *const c_char, text: *const c_char) {
    // SAFETY: the environment is the test's.
    unsafe { log(environment, text) }
}

unsafe fn log(environment: *mut c_void, text: *const c_char) {
    // SAFETY: the caller vouches for it.
    let (messages, text) = unsafe { (&*environment.cast::<Messages>(), CStr::from_ptr(text)) };
    messages.borrow_mut().push(text.to_string_lossy().into_owned());
}

/// An instance, freed when it is dropped. Its methods compute nothing with floating-point numbers.
pub struct Instance<'a> {
    library: &'a Library,
    pointer: *mut c_void,
}

impl Instance<'_> {
    /// Goes to initialization mode; the start time is 0.
    pub fn enter_initialization_mode(&mut self) -> c_int {
        // SAFETY: the instance is alive.
        unsafe {
            match &self.library.functions {
                Functions::Fmi2(fmu) => {
                    let status = (fmu.api().setup_experiment)(self.pointer, 0, 0.0, 0.0, 0, 0.0);
                    status.max((fmu.api().enter_initialization_mode)(self.pointer))
                }
                Functions::Fmi3(library) => {
                    (library.api().enter_initialization_mode)(self.pointer, 0, 0.0, 0.0, 0, 0.0)
                }
            }
        }
    }

    /// Goes on to the first step.
    pub fn exit_initialization_mode(&mut self) -> c_int {
        // SAFETY: the instance is alive.
        unsafe {
            match &self.library.functions {
                Functions::Fmi2(fmu) => (fmu.api().exit_initialization_mode)(self.pointer),
                Functions::Fmi3(library) => (library.api().exit_initialization_mode)(self.pointer),
            }
        }
    }

    /// Makes the instance as it was when it was new.
    pub fn reset(&mut self) -> c_int {
        // SAFETY: the instance is alive.
        unsafe {
            match &self.library.functions {
                Functions::Fmi2(fmu) => (fmu.api().reset)(self.pointer),
                Functions::Fmi3(library) => (library.api().reset)(self.pointer),
            }
        }
    }

    /// Sets the variable of this slot.
    pub fn set(&mut self, slot: usize, value: f64) -> c_int {
        let (reference, pointer) = (&(slot as u32), self.pointer);
        let kind = self.library.model.identity.row(slot).kind;
        // SAFETY: the instance is alive, and there is one value of each type.
        unsafe {
            match (&self.library.functions, kind) {
                (Functions::Fmi2(fmu), Kind::Real(_)) => (fmu.api().set_real)(pointer, reference, 1, &value),
                (Functions::Fmi2(fmu), Kind::Boolean) => {
                    (fmu.api().set_boolean)(pointer, reference, 1, &(value as i32))
                }
                (Functions::Fmi2(fmu), _) => (fmu.api().set_integer)(pointer, reference, 1, &(value as i32)),
                (Functions::Fmi3(library), Kind::Real(_)) => {
                    (library.api().set_float64)(pointer, reference, 1, &value, 1)
                }
                (Functions::Fmi3(library), Kind::Boolean) => {
                    (library.api().set_boolean)(pointer, reference, 1, &(value as u8), 1)
                }
                (Functions::Fmi3(library), Kind::Integer) => {
                    (library.api().set_int32)(pointer, reference, 1, &(value as i32), 1)
                }
                (Functions::Fmi3(library), Kind::Enumeration(_)) => {
                    (library.api().set_int64)(pointer, reference, 1, &(value as i64), 1)
                }
            }
        }
    }

    /// Sets real variables in one call.
    pub fn set_reals(&mut self, slots: &[u32], values: &[f64]) -> c_int {
        assert_eq!(slots.len(), values.len());
        let (count, first) = (slots.len(), values.as_ptr());
        // SAFETY: the instance is alive, and the arrays are as long as said.
        unsafe {
            match &self.library.functions {
                Functions::Fmi2(fmu) => (fmu.api().set_real)(self.pointer, slots.as_ptr(), count, first),
                Functions::Fmi3(library) => {
                    (library.api().set_float64)(self.pointer, slots.as_ptr(), count, first, count)
                }
            }
        }
    }

    /// Reads real variables.
    pub fn get_reals(&mut self, slots: &[u32], values: &mut [f64]) -> c_int {
        assert_eq!(slots.len(), values.len());
        let (count, room) = (slots.len(), values.as_mut_ptr());
        // SAFETY: the instance is alive, and the arrays are as long as said.
        unsafe {
            match &self.library.functions {
                Functions::Fmi2(fmu) => (fmu.api().get_real)(self.pointer, slots.as_ptr(), count, room),
                Functions::Fmi3(library) => {
                    (library.api().get_float64)(self.pointer, slots.as_ptr(), count, room, count)
                }
            }
        }
    }

    /// Reads a real variable.
    pub fn get(&mut self, slot: usize) -> f64 {
        let mut value = [f64::NAN];
        assert_eq!(self.get_reals(&[slot as u32], &mut value), OK);
        value[0]
    }

    /// Makes a communication step.
    pub fn step(&mut self, time: f64, step: f64) -> c_int {
        // SAFETY: the instance is alive, and there is room for the answers.
        unsafe {
            match &self.library.functions {
                Functions::Fmi2(fmu) => (fmu.api().do_step)(self.pointer, time, step, 1),
                Functions::Fmi3(library) => {
                    let (mut event, mut terminate, mut early, mut last) = (0, 0, 0, 0.0);
                    let do_step = library.api().do_step;
                    do_step(self.pointer, time, step, 1, &mut event, &mut terminate, &mut early, &mut last)
                }
            }
        }
    }
}

impl Drop for Instance<'_> {
    fn drop(&mut self) {
        // SAFETY: the instance is alive, and used no more.
        unsafe {
            match &self.library.functions {
                Functions::Fmi2(fmu) => (fmu.api().free_instance)(self.pointer),
                Functions::Fmi3(library) => (library.api().free_instance)(self.pointer),
            }
        }
    }
}
