//! Measures of motion cue quality, and the best quality that a rig permits.
//!
//! Plain series go in ([`Run`]): what the vehicle's rider would feel, what the rider on the
//! platform feels, and what the platform did. [`Measures`] come out, and [`Measures::rows`] lists
//! them for people, each with its unit, definition and source.
//!
//! | module | what it measures |
//! |---|---|
//! | [`fidelity`](mod@fidelity) | RMS and peak error, correlation |
//! | [`delay`](mod@delay) | delay of one signal behind another |
//! | [`vestibular`] | what the semicircular canals and the otoliths make of a signal |
//! | [`cues`] | time above the perception thresholds: false cues, missing cues |
//! | [`effort`](mod@effort) | stroke used, time limited |
//! | [`bound`](mod@bound) | the least RMS error that any controller could reach |
//!
//! Frames and signs are those of the washout: x forward, y left, z up; all
//! quantities are in SI units.

#![forbid(unsafe_code)]

pub mod bound;
pub mod cues;
pub mod delay;
pub mod effort;
pub mod fidelity;
mod listing;
mod measures;
mod run;
pub mod vestibular;

pub use listing::{Row, bound_rows};
pub use measures::{Axes, Measures};
pub use run::{Limited, Platform, Run, RunError};
