//! The types of fmi3PlatformTypes.h and fmi3FunctionTypes.h, under the names that
//! the standard gives them.
//!
//! The types that variables have are types of their own here, so that no other version's
//! get and set take them.

use std::ffi::{c_char, c_void};

use crate::variable_info::scalar;
use crate::{Scalar, ValueType};

/// An instance, as the host holds it.
#[allow(non_camel_case_types)]
pub type fmi3Instance = *mut c_void;
/// The host's argument, returned with every message.
#[allow(non_camel_case_types)]
pub type fmi3InstanceEnvironment = *mut c_void;
/// A saved state, as the host holds it.
#[allow(non_camel_case_types)]
pub type fmi3FMUState = *mut c_void;
/// The index of a variable's first slot.
#[allow(non_camel_case_types)]
pub type fmi3ValueReference = u32;
/// A string ended by a zero.
#[allow(non_camel_case_types)]
pub type fmi3String = *const c_char;
#[allow(non_camel_case_types)]
pub type fmi3Byte = u8;
#[allow(non_camel_case_types)]
pub type fmi3Binary = *const fmi3Byte;

/// A real variable's value, or a time \[s\].
#[allow(non_camel_case_types)]
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct fmi3Float64(pub f64);

/// An integer variable's value.
#[allow(non_camel_case_types)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct fmi3Int32(pub i32);

/// An enumeration's value.
#[allow(non_camel_case_types)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct fmi3Int64(pub i64);

/// C's `bool`, of which a host can send any byte; everything but 0 is true.
#[allow(non_camel_case_types)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct fmi3Boolean(pub u8);

impl fmi3Boolean {
    /// True for any value but zero.
    #[inline]
    pub fn is_true(self) -> bool {
        self.0 != 0
    }
}

/// Status of a call.
#[allow(non_camel_case_types)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum fmi3Status {
    fmi3OK,
    fmi3Warning,
    fmi3Discard,
    fmi3Error,
    fmi3Fatal,
}

/// The host's function for messages.
#[allow(non_camel_case_types)]
pub type fmi3LogMessageCallback = unsafe extern "C" fn(
    environment: fmi3InstanceEnvironment,
    status: fmi3Status,
    category: fmi3String,
    message: fmi3String,
);

/// A function of the host that is never called.
#[allow(non_camel_case_types)]
pub type fmi3UnusedCallback = Option<unsafe extern "C" fn()>;

scalar!(fmi3Float64, Real, |value| value.0, |slot| fmi3Float64(slot));
scalar!(fmi3Int32, Integer, |value| f64::from(value.0), |slot| fmi3Int32(slot as i32));
// Whole numbers beyond 2^53 are rounded, but no enumeration has so many items.
scalar!(fmi3Int64, Enumeration, |value| value.0 as f64, |slot| fmi3Int64(slot as i64));
scalar!(fmi3Boolean, Boolean, |value| f64::from(u8::from(value.is_true())), |slot| fmi3Boolean(u8::from(slot != 0.0)));

/// A type of FMI 3.0.
fn type_name(value_type: ValueType) -> &'static str {
    match value_type {
        ValueType::Real => "Float64",
        ValueType::Integer => "Int32",
        ValueType::Boolean => "Boolean",
        ValueType::Enumeration => "Enumeration, which goes by Int64",
    }
}
