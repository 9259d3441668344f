//! The C functions of FMI 3.0 for co-simulation. [`export_fmi3!`](crate::export_fmi3) makes them,
//! each a line that calls into here.
//!
//! A row of the interface with several values is as many scalar variables, or one array variable,
//! row-major, with the row's first slot as its value reference: see [`Layout`].
//!
//! # Safety, errors
//! As said in [`abi`](crate::abi).

#![allow(clippy::missing_safety_doc, clippy::missing_errors_doc)] // stated above, once for all

mod arrays;
pub mod calling_sequence;
mod export;
pub mod lifecycle;
mod logger;
pub mod steps;
pub mod types;
pub mod variables;

pub use logger::Logger;
pub use moris_interface::{LOG_CATEGORIES_OF_FMI3 as LOG_CATEGORIES, Layout};

/// An instance of FMI 3.0.
type Component<M> = crate::abi::Component<M, Logger>;
