//! Exports a model as the C functions of FMI.
//!
//! [`export_fmi2!`] and [`export_fmi3!`] make a shared library's functions from a
//! [`Model`](moris_interface::Model): a `cdylib` needs no more than that line. What every version
//! of FMI needs is in this crate's root, without a C type in it: an [`Instance`] with its values,
//! its modes and its state; and what C makes of that in every version is in [`abi`]. What the
//! versions need on top of it is in [`fmi2`] and [`fmi3`].
//!
//! Nothing here writes to standard output or standard error, reads the
//! environment, or starts a thread.

pub mod abi;
mod access;
mod call_error;
pub mod fmi2;
pub mod fmi3;
mod initialization;
mod instance;
mod instance_state;
mod log_categories;
mod mode;
mod panics;
mod serialisation;
mod step;
mod tables;
mod variable_info;
mod variables;

pub use call_error::{CallError, Severity};
pub use instance::Instance;
pub use instance_state::InstanceState;
pub use log_categories::{LOG_CATEGORIES, LogCategory};
pub use mode::{Mode, Modes};
pub use tables::{Guid, SharedTables, Tables, slot_count};
pub use variable_info::{Role, Scalar, ValueType, VariableInfo};
pub use variables::{Scalars, Variables};
