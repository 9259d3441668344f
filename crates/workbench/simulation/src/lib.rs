//! Simulation of a recording with its measures and findings, and the measures themselves.
//!
//! The workbench and the report's page use it. The page has it as WebAssembly, so that both have
//! the same numbers and sentences: no threads, no files.
//!
//! - [`Replay`] takes a washout through a [`Manoeuvre`]; [`drives`] has computed ones.
//! - [`Simulation`] steps the washout, [`Unfinished`] part by part; [`preview`] gives it
//!   the recording's future.
//! - [`verdict`] is the most important fault, and [`advice`] what is better, simulated.
//! - [`fit`](mod@fit) finds the largest scale with the right sign and proportion.
//! - [`foreign`] makes the same of the motion that another washout computed.
//! - [`channels`] are the figures of each channel.
//! - [`capabilities`] is what a rig can do; [`clearance`] is how close its legs come.
//! - [`frequency_response`] is that of the washout with a set of parameters.
//! - [`mod@measures`] are those of motion-cue quality, and a bound of what a rig permits. Series
//!   alone make them, without a replay.
//! - [`Evaluated`] has the measures and the sentences about them.

#![forbid(unsafe_code)]

pub mod advice;
pub mod capabilities;
pub mod channels;
pub mod clearance;
pub mod drives;
mod evaluated;
mod finding;
pub mod findings;
pub mod fit;
pub mod foreign;
pub mod frequency_response;
mod limits;
mod manoeuvre;
mod measured;
pub mod measures;
pub mod preview;
mod refusal;
pub mod replay;
pub mod sentences;
mod simulation;
mod spans;
mod tilt_limits;
pub mod verdict;

pub use evaluated::{Evaluated, capitalised};
pub use finding::{Finding, Weight};
pub use limits::Limits;
pub use manoeuvre::Manoeuvre;
pub use measured::{measures, measures_with};
pub use refusal::Refusal;
pub(crate) use refusal::refuse;
pub use replay::Replay;
pub(crate) use sentences::sentence;
pub use simulation::{Simulation, Unfinished};
pub use tilt_limits::{TiltFlags, TiltLimit, tilt_limits};
