//! The C functions of either version of FMI, as far as both versions have them.

use std::ffi::c_int;
use std::ptr::{null, null_mut};

use moris_fmi::fmi3::Layout;
use moris_fmu_host::api::{self, Component, FmuState, Text};
use moris_fmu_host::fmi3;

use super::expected::{IDENTITY, Type};

/// The functions of a library by one version of FMI.
pub struct Functions {
    pub version: Version,
    /// The variables of each type.
    pub variables: Vec<Variables>,
}

#[expect(clippy::large_enum_variant, reason = "there are few of them")]
pub enum Version {
    Fmi2(api::Api),
    /// With the layout of the description that the host has read.
    Fmi3(fmi3::Api, Layout),
}

use Version::{Fmi2, Fmi3};

/// The variables of a type.
pub struct Variables {
    pub kind: Type,
    pub references: Vec<u32>,
    /// The slots of these variables, which for an array are several.
    pub slots: Vec<usize>,
}

/// A function's name and the status with which it ended.
pub(super) type Answer = (&'static str, c_int);

/// Defines methods that call a function with the same arguments in both versions, by its field and
/// its two names. The result is the name called, and what the function returned.
macro_rules! forward {
    ($($field:ident($($argument:ident: $type:ty),*) -> $answer:ty, $name2:literal, $name3:literal;)+) => { $(
        pub(super) unsafe fn $field(&self, $($argument: $type),*) -> (&'static str, $answer) {
            // SAFETY: the caller vouches for instance and pointers.
            unsafe {
                match &self.version {
                    Fmi2(api) => ($name2, (api.$field)($($argument),*)),
                    Fmi3(api, _) => ($name3, (api.$field)($($argument),*)),
                }
            }
        }
    )+ };
}

/// Host's arguments for variables of a type: references, and room for or source of their values.
pub(super) struct Access<'a> {
    pub kind: Type,
    /// Null, or `count` references.
    pub references: *const u32,
    pub count: usize,
    /// `None`: null.
    pub values: Option<&'a mut [f64]>,
    /// Number of values that FMI 3.0 is told, at most as many as there are.
    pub value_count: usize,
}

impl Functions {
    /// The functions of FMI 2.0.
    pub fn fmi2(api: &api::Api) -> Self {
        Self::new(Fmi2(*api))
    }

    /// The functions of FMI 3.0, for a host that has read the description with this layout.
    pub fn fmi3(api: &fmi3::Api, layout: Layout) -> Self {
        Self::new(Fmi3(*api, layout))
    }

    fn new(version: Version) -> Self {
        let mut functions = Functions { version, variables: Vec::new() };
        for kind in [Type::Real, Type::Integer, Type::Boolean, Type::Enumeration] {
            let is_of_type = |&reference: &u32| {
                functions.slots(reference).is_some() && functions.type_of(reference as usize) == kind
            };
            let references: Vec<u32> = (0..IDENTITY.slots.len() as u32).filter(is_of_type).collect();
            let slots: Vec<usize> = references.iter().filter_map(|&r| functions.slots(r)).flatten().collect();
            if !references.is_empty() {
                functions.variables.push(Variables { kind, references, slots });
            }
        }
        functions
    }
}

/// All unsafe ones of these need an instance that is alive, and pointers that are null or lead to
/// as many elements as are given.
impl Functions {
    /// The type by which a variable goes through the interface.
    pub fn type_of(&self, slot: usize) -> Type {
        match (&self.version, Type::of(slot)) {
            (Fmi2(_), Type::Enumeration) => Type::Integer,
            (_, kind) => kind,
        }
    }

    /// Slots of the variable with this reference; `None` where there is no such variable.
    pub fn slots(&self, reference: u32) -> Option<std::ops::Range<usize>> {
        let slot = reference as usize;
        let place = IDENTITY.slots.get(slot)?;
        match self.version {
            Fmi3(_, Layout::Arrays) if place.element > 0 => None,
            Fmi3(_, Layout::Arrays) => Some(slot..slot + IDENTITY.row(slot).slots()),
            _ => Some(slot..slot + 1),
        }
    }

    /// The value as the version stores it: a Boolean as 0 or 1.
    pub fn converted(&self, kind: Type, value: f64) -> f64 {
        match (&self.version, kind) {
            (Fmi2(_), Type::Boolean) => f64::from(value as c_int != 0),
            (Fmi3(..), Type::Boolean) => f64::from(value as c_int as u8 != 0),
            _ => value,
        }
    }

    forward! {
        free_instance(c: Component) -> (), "fmi2FreeInstance", "fmi3FreeInstance";
        exit_initialization_mode(c: Component) -> c_int, "fmi2ExitInitializationMode", "fmi3ExitInitializationMode";
        terminate(c: Component) -> c_int, "fmi2Terminate", "fmi3Terminate";
        reset(c: Component) -> c_int, "fmi2Reset", "fmi3Reset";
        get_fmu_state(c: Component, state: *mut FmuState) -> c_int, "fmi2GetFMUstate", "fmi3GetFMUState";
        set_fmu_state(c: Component, state: FmuState) -> c_int, "fmi2SetFMUstate", "fmi3SetFMUState";
        free_fmu_state(c: Component, state: *mut FmuState) -> c_int, "fmi2FreeFMUstate", "fmi3FreeFMUState";
        serialized_fmu_state_size(c: Component, state: FmuState, size: *mut usize) -> c_int,
            "fmi2SerializedFMUstateSize", "fmi3SerializedFMUStateSize";
        serialize_fmu_state(c: Component, state: FmuState, to: *mut u8, size: usize) -> c_int,
            "fmi2SerializeFMUstate", "fmi3SerializeFMUState";
        deserialize_fmu_state(c: Component, from: *const u8, size: usize, state: *mut FmuState) -> c_int,
            "fmi2DeSerializeFMUstate", "fmi3DeserializeFMUState";
    }

    pub(super) unsafe fn set_debug_logging(
        &self,
        c: Component,
        on: bool,
        count: usize,
        categories: *const Text,
    ) -> Answer {
        // SAFETY: the caller vouches for instance and pointer.
        unsafe {
            match &self.version {
                Fmi2(api) => ("fmi2SetDebugLogging", (api.set_debug_logging)(c, c_int::from(on), count, categories)),
                Fmi3(api, _) => ("fmi3SetDebugLogging", (api.set_debug_logging)(c, u8::from(on), count, categories)),
            }
        }
    }

    /// A step, with somewhere to tell of it.
    pub(super) unsafe fn do_step(&self, c: Component, time: f64, step: f64) -> Answer {
        let (mut event, mut terminate, mut early, mut last) = (0, 0, 0, f64::NAN);
        // SAFETY: the caller vouches for the instance.
        let answer = unsafe {
            match &self.version {
                Fmi2(api) => ("fmi2DoStep", (api.do_step)(c, time, step, 1)),
                Fmi3(api, _) => {
                    let answers = (&mut event, &mut terminate, &mut early, &mut last);
                    let status = (api.do_step)(c, time, step, 1, answers.0, answers.1, answers.2, answers.3);
                    ("fmi3DoStep", status)
                }
            }
        };
        assert_eq!((event, terminate, early), (0, 0, 0));
        if matches!(self.version, Fmi3(..)) && answer.1 == super::expected::OK {
            assert_eq!(last.to_bits(), (time + step).to_bits(), "last successful time");
        }
        answer
    }

    /// Reads variables. Values that the library does not write stay what they are.
    pub(super) unsafe fn get(&self, c: Component, access: Access) -> Answer {
        let Access { kind, references, count, values, value_count } = access;
        let Some(values) = values else {
            // SAFETY: the caller vouches for instance and references; there is nowhere to write to.
            return unsafe { self.get_to(c, kind, references, count, Room::default(), value_count) };
        };
        // What a library that writes must not leave.
        let mut integers = vec![c_int::MIN; values.len()];
        let mut longs = vec![i64::MIN; values.len()];
        let mut bytes = vec![u8::MAX; values.len()];
        let room = Room {
            reals: values.as_mut_ptr(),
            integers: integers.as_mut_ptr(),
            longs: longs.as_mut_ptr(),
            bytes: bytes.as_mut_ptr(),
        };
        // SAFETY: the caller vouches for instance and references, and there is room for all values.
        let answer = unsafe { self.get_to(c, kind, references, count, room, value_count) };
        for (k, value) in values.iter_mut().enumerate() {
            let written = (integers[k] != c_int::MIN).then(|| f64::from(integers[k]));
            let written = written.or((longs[k] != i64::MIN).then_some(longs[k] as f64));
            let written = written.or((bytes[k] != u8::MAX).then(|| f64::from(bytes[k])));
            *value = written.unwrap_or(*value);
        }
        answer
    }

    unsafe fn get_to(
        &self,
        c: Component,
        kind: Type,
        references: *const u32,
        count: usize,
        room: Room,
        n: usize,
    ) -> Answer {
        let r = references;
        // SAFETY: the caller vouches for everything.
        unsafe {
            match (&self.version, kind) {
                (Fmi2(api), Type::Real) => ("fmi2GetReal", (api.get_real)(c, r, count, room.reals)),
                (Fmi2(api), Type::Boolean) => ("fmi2GetBoolean", (api.get_boolean)(c, r, count, room.integers)),
                (Fmi2(api), _) => ("fmi2GetInteger", (api.get_integer)(c, r, count, room.integers)),
                (Fmi3(api, _), Type::Real) => ("fmi3GetFloat64", (api.get_float64)(c, r, count, room.reals, n)),
                (Fmi3(api, _), Type::Integer) => ("fmi3GetInt32", (api.get_int32)(c, r, count, room.integers, n)),
                (Fmi3(api, _), Type::Enumeration) => ("fmi3GetInt64", (api.get_int64)(c, r, count, room.longs, n)),
                (Fmi3(api, _), Type::Boolean) => ("fmi3GetBoolean", (api.get_boolean)(c, r, count, room.bytes, n)),
            }
        }
    }

    /// Sets variables; whole numbers are cut to their type.
    pub(super) unsafe fn set(&self, c: Component, access: Access) -> Answer {
        let Access { kind, references: r, count, values, value_count: n } = access;
        let values = values.as_deref();
        let integers: Option<Vec<c_int>> = values.map(|values| values.iter().map(|&value| value as c_int).collect());
        let longs: Option<Vec<i64>> = values.map(|values| values.iter().map(|&value| value as i64).collect());
        let bytes: Option<Vec<u8>> = integers.as_ref().map(|all| all.iter().map(|&value| value as u8).collect());
        let real = values.map_or(null(), <[f64]>::as_ptr);
        let integer = integers.as_ref().map_or(null(), |all| all.as_ptr());
        let long = longs.as_ref().map_or(null(), |all| all.as_ptr());
        let byte = bytes.as_ref().map_or(null(), |all| all.as_ptr());
        // SAFETY: the caller vouches for instance and references, and there are as many values as are given.
        unsafe {
            match (&self.version, kind) {
                (Fmi2(api), Type::Real) => ("fmi2SetReal", (api.set_real)(c, r, count, real)),
                (Fmi2(api), Type::Boolean) => ("fmi2SetBoolean", (api.set_boolean)(c, r, count, integer)),
                (Fmi2(api), _) => ("fmi2SetInteger", (api.set_integer)(c, r, count, integer)),
                (Fmi3(api, _), Type::Real) => ("fmi3SetFloat64", (api.set_float64)(c, r, count, real, n)),
                (Fmi3(api, _), Type::Integer) => ("fmi3SetInt32", (api.set_int32)(c, r, count, integer, n)),
                (Fmi3(api, _), Type::Enumeration) => ("fmi3SetInt64", (api.set_int64)(c, r, count, long, n)),
                (Fmi3(api, _), Type::Boolean) => ("fmi3SetBoolean", (api.set_boolean)(c, r, count, byte, n)),
            }
        }
    }

    /// Derivatives of outputs, into `values` or null.
    pub(super) unsafe fn get_output_derivatives(
        &self,
        c: Component,
        (references, count): (*const u32, usize),
        orders: *const c_int,
        values: *mut f64,
        value_count: usize,
    ) -> Answer {
        // SAFETY: the caller vouches for everything.
        unsafe {
            match &self.version {
                Fmi2(api) => (
                    "fmi2GetRealOutputDerivatives",
                    (api.get_real_output_derivatives)(c, references, count, orders, values),
                ),
                Fmi3(api, _) => (
                    "fmi3GetOutputDerivatives",
                    (api.get_output_derivatives)(c, references, count, orders, values, value_count),
                ),
            }
        }
    }
}

/// Room for values of each type, or null.
#[derive(Clone, Copy)]
struct Room {
    reals: *mut f64,
    integers: *mut c_int,
    longs: *mut i64,
    bytes: *mut u8,
}

impl Default for Room {
    fn default() -> Self {
        Room { reals: null_mut(), integers: null_mut(), longs: null_mut(), bytes: null_mut() }
    }
}
