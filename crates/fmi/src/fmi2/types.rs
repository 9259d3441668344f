//! The types of fmi2TypesPlatform.h and fmi2FunctionTypes.h, under the names that
//! the standard gives them.

use std::ffi::{c_char, c_int, c_void};

use crate::variable_info::scalar;
use crate::{Scalar, ValueType};

/// An instance, as the host holds it.
#[allow(non_camel_case_types)]
pub type fmi2Component = *mut c_void;
/// The host's argument, returned with every message.
#[allow(non_camel_case_types)]
pub type fmi2ComponentEnvironment = *mut c_void;
/// A saved state, as the host holds it.
#[allow(non_camel_case_types)]
pub type fmi2FMUstate = *mut c_void;
/// The index of a variable's slot.
#[allow(non_camel_case_types)]
pub type fmi2ValueReference = u32;
#[allow(non_camel_case_types)]
pub type fmi2Real = f64;
#[allow(non_camel_case_types)]
pub type fmi2Integer = c_int;
/// A string ended by a zero.
#[allow(non_camel_case_types)]
pub type fmi2String = *const c_char;
/// C's `char`, as a byte of a serialized state.
#[allow(non_camel_case_types)]
pub type fmi2Byte = u8;

/// Everything but 0 is true.
#[allow(non_camel_case_types)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct fmi2Boolean(pub c_int);

/// A type of FMI 2.0.
fn type_name(value_type: ValueType) -> &'static str {
    match value_type {
        ValueType::Real => "Real",
        ValueType::Integer => "Integer",
        ValueType::Boolean => "Boolean",
        ValueType::Enumeration => "Enumeration, which goes by Integer",
    }
}

scalar!(fmi2Real, Real, |value| value, |slot| slot);
scalar!(fmi2Integer, Integer | Enumeration, |value| f64::from(value), |slot| slot as fmi2Integer);
scalar!(fmi2Boolean, Boolean, |value| f64::from(u8::from(value.0 != 0)), |slot| fmi2Boolean(c_int::from(slot != 0.0)));

/// Status of a call.
#[allow(non_camel_case_types)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum fmi2Status {
    fmi2OK,
    fmi2Warning,
    fmi2Discard,
    fmi2Error,
    fmi2Fatal,
    fmi2Pending,
}

/// The value of fmi2Type that this library can be; as an `int`, for a host can send any.
pub const CO_SIMULATION: c_int = 1;
/// The value of fmi2StatusKind for the time of the last successful step.
pub const LAST_SUCCESSFUL_TIME: c_int = 2;
/// The value of fmi2StatusKind for a simulation that has terminated by itself.
pub const TERMINATED: c_int = 3;

/// The host's function for messages; what comes after `message` is for the format that this is.
#[allow(non_camel_case_types)]
pub type fmi2CallbackLogger = unsafe extern "C" fn(
    environment: fmi2ComponentEnvironment,
    instance_name: fmi2String,
    status: fmi2Status,
    category: fmi2String,
    message: fmi2String,
    ...
);

/// The host's functions. Only the logger is used.
#[allow(non_camel_case_types)]
#[derive(Clone, Copy)]
#[repr(C)]
pub struct fmi2CallbackFunctions {
    pub logger: Option<fmi2CallbackLogger>,
    pub allocate_memory: Option<unsafe extern "C" fn(count: usize, size: usize) -> *mut c_void>,
    pub free_memory: Option<unsafe extern "C" fn(memory: *mut c_void)>,
    pub step_finished: Option<unsafe extern "C" fn(environment: fmi2ComponentEnvironment, status: fmi2Status)>,
    pub environment: fmi2ComponentEnvironment,
}
