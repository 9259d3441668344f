//! Parts common to the C functions of all versions of FMI: access to an instance, pointers, states.
//!
//! # Safety
//! All functions of the versions' modules take a host's pointers. Null pointers are refused.
//! Other pointers must be what the standard requires: an instance or a state made by this library
//! and not yet freed, arrays of the given length, zero-terminated strings. An instance is not
//! used by two threads at once.
//!
//! # Errors
//! A function fails where an argument is not as the standard and the model description say. The
//! text says which, and the host receives it from [`call`].

#![allow(clippy::missing_safety_doc, clippy::missing_errors_doc)] // stated above, once for all

mod arithmetic;
mod component;
mod export;
pub mod fmu_state;
mod function;
pub mod lifecycle;
pub mod older_glibc;
pub mod pointers;
pub mod unsupported;

pub(crate) use arithmetic::with_default as with_default_arithmetic;
pub use component::{Component, Host, call};
pub use function::Function;
pub(crate) use function::calling_sequence;

/// Expands to nothing: other systems need none of glibc's functions.
#[cfg(not(all(target_os = "linux", target_env = "gnu", any(target_arch = "x86_64", target_arch = "aarch64"))))]
#[doc(hidden)]
#[macro_export]
macro_rules! own_functions_of_newer_glibc {
    () => {};
}
