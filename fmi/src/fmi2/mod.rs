//! The C functions of FMI 2.0. [`export_fmi2!`](crate::export_fmi2) makes them, each a line that calls into here.
//!
//! # Safety
//! All functions here take a host's pointers. Null pointers are refused; others have to be what the standard says: an
//! instance or a state made by this library and not yet freed, arrays of the length given, strings ended by a zero.
//! An instance is not used by two threads at once.

#![allow(clippy::missing_safety_doc)] // said above, once for all

pub mod calling_sequence;
mod component;
mod export;
pub mod fmu_state;
pub mod lifecycle;
mod logger;
mod pointers;
pub mod status;
pub mod steps;
pub mod types;
pub mod unsupported;
pub mod variables;
