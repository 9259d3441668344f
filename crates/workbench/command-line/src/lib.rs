//! What the commands `moris` and `moris-live` have in common: [`setup_options`] for rig and
//! parameters, [`words`] that write remedies as options, a [`console`] that stops no thread, and the exit status.

#![forbid(unsafe_code)]

pub mod console;
mod failure;
pub mod setup_options;
pub mod words;

pub use failure::exit_status;
