//! Common parts of the commands `moris` and `moris-live`.
//!
//! - [`setup_options`]: the options for rig and parameters.
//! - [`words`]: remedies as options.
//! - [`console`]: lines on standard error that stop no thread.
//! - [`exit_status`]: the end of a command.

#![forbid(unsafe_code)]

pub mod console;
mod failure;
pub mod setup_options;
pub mod words;

pub use failure::exit_status;
