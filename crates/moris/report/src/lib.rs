//! One self-contained HTML page about a recording on a motion platform: what is felt against what
//! is desired, the legs against their stroke, what was limited and when, a table of measures; and
//! beside it the platform itself, moving in 3D.
//!
//! Plain data in ([`Report`]), text out ([`html`]). The page needs no network and no other file:
//! its script and style are those of `crates/moris/report/page/`, its numbers are inside it.

#![forbid(unsafe_code)]

mod check;
mod data;
mod encode;
mod events;
mod index;
mod page;
mod thinning;

pub use check::{ReportError, check};
pub use data::{Better, Chart, Cues, Finding, Limited, Limits, Line, Measure, Report, Rig, Run, Value, Weight};
pub use events::{Event, Kind, events};
pub use index::{IndexRow, index_html};
pub use page::html;
pub use thinning::Thinning;
