//! The C functions of FMI 2.0. [`export_fmi2!`](crate::export_fmi2) makes them, each a line
//! that calls into here.
//!
//! # Safety, errors
//! As said in [`abi`](crate::abi).

#![allow(clippy::missing_safety_doc, clippy::missing_errors_doc)] // stated above, once for all

pub mod calling_sequence;
mod export;
pub mod lifecycle;
mod logger;
pub mod steps;
pub mod types;
pub mod variables;

pub use logger::Logger;

/// An instance of FMI 2.0.
type Component<M> = crate::abi::Component<M, Logger>;
