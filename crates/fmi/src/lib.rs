//! Exports a model as the C functions of FMI.
//!
//! [`export_fmi2!`] and [`export_fmi3!`] make a shared library's functions from a
//! [`Model`](moris_interface::Model). A `cdylib` needs only that line.
//!
//! - The crate's root holds the parts common to all versions of FMI, without C types: an
//!   [`Instance`] with its values, modes and state.
//! - [`abi`] holds the parts of the C interface that all versions share.
//! - [`fmi2`] and [`fmi3`] hold the C functions of each version.
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
mod mode;
mod panics;
mod serialisation;
mod start_section;
mod step;
mod tables;
mod variable_info;
mod variables;

pub use call_error::{CallError, Severity};
pub use instance::Instance;
pub use instance_state::InstanceState;
pub use mode::{Mode, Modes};
pub use moris_interface::{LOG_CATEGORIES, LogCategory};
pub use start_section::{Overrides, SectionError, StartSection, embed, embedded};
pub use tables::{Guid, SharedTables, Tables, slot_count};
pub use variable_info::{Role, Scalar, ValueType, VariableInfo};
pub use variables::{Scalars, Variables};
