//! The workbench: from a recording and a rig to a tuned washout and a report.
//!
//! Each command has a module:
//!
//! - [`rig`] checks a platform.
//! - [`simulate`] simulates recordings on it.
//! - [`measure`] prints a table of the measures of several recordings.
//! - [`fit`](mod@fit) finds the scale at which the cues have the right sign and proportion.
//! - [`bench`](mod@bench) compares washouts on fixed drives and rigs.
//! - [`tune`] searches for better parameters.
//! - [`ride`] writes a page in which the motorcycle is ridden.
//! - [`frequency_response`] measures a frequency response.
//! - [`build_fmu`] packs an FMU with other start values.
//! - [`parameters`] lists all parameters.
//! - [`help`] writes shell completions and man pages.
//! - [`schema`] writes schemas of the files, for editors.
//!
//! [`recording`] reads recordings for all commands, and [`washout_fmu`] steps another washout's
//! FMU. The crate `moris-setup` reads rigs and parameters.

#![forbid(unsafe_code)]

pub mod bench;
pub mod build_fmu;
pub mod fit;
pub mod frequency_response;
pub mod help;
pub mod measure;
pub mod parameters;
mod progress;
pub mod ride;
pub mod rig;
pub mod schema;
pub mod sibling;
pub mod simulate;
mod status;
pub mod tune;

use moris_analysis::texts::text;
use moris_analysis::{learned_road, option_values};
pub use moris_analysis::{recording, text_table, washout_fmu};
pub use moris_command_line::{setup_options, words};
pub use moris_pages::PACKAGE_VERSION;

/// Default directory for reports. No directory of the sources has this name.
pub const REPORT_DIRECTORY: &str = "moris-report";
