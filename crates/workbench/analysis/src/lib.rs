//! Analysis of recordings on a rig: what the command and the Python package share.
//!
//! - [`recording`] reads recordings and checks them.
//! - [`outcome`] is a recording on a rig with one set of parameters; [`bounds`] the least possible
//!   errors, [`host`] the steps and inputs of another host.
//! - [`learned_road`] keeps what laps learn of a road in a file.
//! - [`washout_fmu`] steps another washout's FMU through a recording.
//! - [`tune`] finds better parameters.
//! - [`rig`] surveys a platform and draws it.
//! - [`fit`] finds the scale at which the cues have the right sign, and [`measure`] the figures of
//!   each channel.
//! - [`bench`](mod@bench) compares washouts on fixed drives and rigs.
//! - [`frequency_response`] measures the whole washout's.
//! - [`page`] makes the report's page.
//! - [`error`] has the reasons why an analysis has no result.
//! - [`message`] has the remedies in errors and warnings as data, which each face words;
//!   [`texts`] has the sentences.
//!
//! There is no command line here, no terminal and no socket: nothing is printed. The feature `clap`
//! lets the types that options have be parsed.

#![forbid(unsafe_code)]

pub mod bench;
pub mod bounds;
pub mod error;
pub mod fit;
pub mod frequency_response;
pub mod host;
pub mod learned_road;
pub mod measure;
pub mod message;
pub mod option_values;
pub mod outcome;
pub mod page;
pub mod random;
pub mod recording;
pub mod rig;
pub mod text_table;
pub mod texts;
pub mod tune;
pub mod washout_fmu;
