//! A self-contained HTML page about a recording on a motion platform.
//!
//! The page shows felt and desired signals, the legs' lengths in their stroke, the times at which
//! limits were active, and a table of measures. Beside them the platform moves in 3D.
//!
//! The input is a [`Report`]; [`html`] returns the page's text. The page needs no network and no
//! other file. Data are in it, and the scripts and styles of
//! `crates/workbench/pages/page/report/` and `shared/` beside it.

mod data;
mod encode;
mod events;
mod index;
mod page;
mod run;
mod simulator;
mod tables;
mod thinning;

/// Parts of the page that all pages have.
#[cfg(feature = "ride")]
pub(crate) mod shared {
    pub use crate::report::encode::bytes;
    pub use crate::report::page::{Head, WEBASSEMBLY_SOURCE, assembled};
}

pub use data::{Chart, Cues, LimitHistory, Line, Report, Rig, Run, Vehicle};
pub use events::{Event, Kind, events};
pub use index::{IndexRow, index_html};
pub use page::{escaped, html};
pub use run::{felt_chart, run};
pub use simulator::{MODULE_REMEDY, Parameter, ParameterKind, SIMULATION_MODULE, Simulator};
pub use tables::{PageTable, tables_html};
pub use thinning::Thinning;
