//! The workbench: from a recorded ride and a rig to a tuned washout and a report.
//!
//! A command each: [`rig`] looks at a platform, [`run`] rides a recording on it, [`measure`] prints a table of the figures of many, [`tune`] finds better parameters,
//! [`respond`] measures a frequency response, [`parameters`] lists what can be tuned.
//! [`ride`] reads recordings, for every command that needs one. Rigs and parameters are read by the crate `moris-setup`.

#![forbid(unsafe_code)]

pub mod measure;
pub mod parameters;
pub mod respond;
pub mod ride;
pub mod rig;
pub mod run;
pub mod setup_options;
pub mod text_table;
pub mod tune;
