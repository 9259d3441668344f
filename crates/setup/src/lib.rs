//! Rig files and parameter files, in TOML.
//!
//! A parameter file gives values by the names of the FMU's variables ([`parameter_file`]), a rig
//! file says where a platform's joints are and what its legs can do ([`rig_file`]). Both come down
//! to [`NamedValues`], so that one may be laid over the other, and both over any model that has
//! variables of these names. [`Setup`] puts them together and checks that a washout can be made of
//! them.
//!
//! Every name is checked against the interface's rows, and a wrong one is answered with the right
//! ones that look most like it.

#![forbid(unsafe_code)]

mod consistency;
mod error;
mod named_values;
mod names;
pub mod parameter_file;
mod parameter_sets;
pub mod ranges;
pub mod rig_file;
mod setup;

pub use consistency::check_consistency;
pub use error::Error;
pub use named_values::{NamedValues, all, changed, overlaid, values_of};
pub use names::nearest;
pub use parameter_sets::SETS;
pub use setup::{Setup, load_rig, load_set};
