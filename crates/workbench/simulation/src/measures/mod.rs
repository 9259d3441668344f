//! Measures of motion-cue quality, and a bound of the quality that a rig permits.
//!
//! The input is a [`Run`]: series of the desired, the felt and the platform's motion. The result is
//! [`Measures`]. [`Measures::rows`] lists them with unit, definition and source.
//!
//! | module | what it measures |
//! |---|---|
//! | [`fidelity`](mod@fidelity) | RMS and peak error, correlation |
//! | [`delay`](mod@delay) | delay of one signal behind another |
//! | [`vestibular`] | what the semicircular canals and the otoliths make of a signal |
//! | [`comfort`](mod@comfort) | shake, jolt and peak: what RMS errors hide |
//! | [`shape`](mod@shape) | sign, time and proportion of surge and sway: shape, size, inverted |
//! | [`cues`] | time above the perception thresholds: false cues, missing cues |
//! | [`sickness`] | motion sickness of the ride and of the platform |
//! | [`incongruence`](mod@incongruence) | how wrong the worst moment feels |
//! | [`effort`](mod@effort) | stroke used, time limited |
//! | [`bound`](mod@bound) | the least RMS error that any controller could reach |
//!
//! Frames and signs are those of the washout: x forward, y left, z up; all
//! quantities are in SI units.

mod all;
pub mod bound;
pub mod comfort;
pub mod cues;
pub mod delay;
pub mod effort;
pub mod fidelity;
pub mod incongruence;
mod listing;
mod run;
pub mod shape;
pub mod sickness;
pub mod statistics;
pub mod vestibular;
mod zero_phase;

pub use all::{Axes, Measures, References, Rider};
pub use listing::{Better, Row, all_rows, bound_rows};
pub use run::{Limits, Platform, Run, Series};
