//! Rig files and parameter files, in TOML.
//!
//! - A parameter file ([`parameter_file`]) holds values by the names of the FMU's variables.
//! - A rig file ([`rig_file`]) holds a platform's joints and the limits of its legs.
//!
//! Both are converted to [`NamedValues`]. Such values can override each other, and
//! those of any model with variables of these names. A [`Setup`] combines them and
//! checks that they make a washout.
//!
//! Every name is checked against the interface's rows. For an unknown name, the error lists the
//! most similar known ones.

#![forbid(unsafe_code)]

mod error;
mod named_values;
mod names;
pub mod parameter_file;
mod parameter_sets;
pub mod rig_file;
mod rigs;
mod setup;

pub use error::Error;
pub use named_values::{NamedValues, all, changed, differing, overlaid, values_of};
pub use names::nearest;
pub use parameter_sets::PARAMETER_SETS;
pub use rigs::SHIPPED_RIGS;
pub use setup::{Setup, load_rig, load_set, set_name};
