//! The workbench: from a recording and a rig to a tuned washout and a report.
//!
//! One module a command: [`rig`] checks a platform, [`simulate`] simulates a recording on it,
//! [`measure`] prints a table of the measures of many, [`tune`] searches for better
//! parameters, [`frequency_response`] measures a frequency response, [`parameters`] lists all
//! parameters, [`help`] writes completions for shells and man pages, [`schema`] the schemas
//! of files for editors.
//!
//! [`recording`] reads recordings, for every command that needs one. Rigs and parameters are read
//! by the crate `moris-setup`.

#![forbid(unsafe_code)]

pub mod frequency_response;
pub mod help;
pub mod measure;
pub mod parameters;
mod progress;
pub mod recording;
pub mod rig;
pub mod schema;
pub mod setup_options;
pub mod simulate;
pub mod text_table;
pub mod tune;

/// Directory for reports unless `--report` gives another. No directory of the sources is called so.
pub const REPORT_DIRECTORY: &str = "moris-report";
