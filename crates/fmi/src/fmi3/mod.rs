//! The C functions of FMI 3.0 for co-simulation. [`export_fmi3!`](crate::export_fmi3) makes them, each a line that calls
//! into here.
//!
//! Where a row of the interface has several values it is one array variable, row-major; its value reference is its first
//! slot.
//!
//! # Safety
//! As said in [`abi`](crate::abi).

#![allow(clippy::missing_safety_doc)] // said above, once for all

mod arrays;
pub mod calling_sequence;
mod export;
pub mod lifecycle;
mod log_categories;
mod logger;
pub mod steps;
pub mod types;
pub mod unsupported;
pub mod variables;

pub use log_categories::LOG_CATEGORIES;
pub use logger::Logger;

/// An instance of FMI 3.0.
type Component<M> = crate::abi::Component<M, Logger>;
