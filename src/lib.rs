//! The washout filter of the MORIS motorcycle simulator, with its Stewart platform's kinematics.
//!
//! A vehicle model computes what a rider would feel. [`Washout`] computes the motion of a
//! platform and its six actuators that lets a real rider feel it. The source is Barbagli,
//! Ferrazzin, Avizzano, Bergamasco: *Washout Filter Design for a Motorcycle Simulator*. Equations
//! are cited by its numbers.
//!
//! Data flows one way. Signals pass the blocks of the paper's Fig. 4, which are the files of
//! `src/cueing`, and then the [`platform`]'s kinematics and actuator guard.
//!
//! [`Washout`] is the whole filter. [`interface`] has its inputs, outputs and parameters,
//! [`presets`] sets of parameters, [`platform`] the kinematics alone.
//!
//! ```
//! use moris_washout::{Group, Input, Parameters, Washout};
//!
//! let mut parameters = Parameters::default();
//! parameters.set("scale.specificForce.x", 0.5)?; // by the FMU's name,
//! parameters.tilt.rate_limit = 0.04; // or by the field: `tilt.rateLimit`, in rad/s
//! let mut washout = Washout::new(&parameters)?;
//! washout.step(&Input::default(), 0.001);
//! let error = parameters.set("tilt.rateLimit", -1.0).unwrap_err();
//! assert_eq!(error.to_string(), "tilt.rateLimit: is -1, but must be from 1e-9 to 10");
//! # Ok::<(), moris_washout::ParameterError>(())
//! ```
//!
//! The base frame and the platform frame have x forward, y left and z up. Roll, pitch and
//! yaw are rotations about x, y and z. Positive pitch is therefore nose down. All
//! quantities are in SI units.
//!
//! Sines, cosines and similar functions come from the crate `libm`, so that every platform
//! computes the same bits.
//!
//! A step allocates nothing, does no I/O and does not panic, whatever its input.
//!
//! Without the feature `std`, which is on by default, the crate needs `core` and `alloc` alone.

#![forbid(unsafe_code)]
#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;

#[cfg(test)]
#[path = "../tests/cases/mod.rs"]
mod cases;

// The blocks and their filters: public for the workspace's other models and for tests, and no part of
// the crate's interface.
#[doc(hidden)]
pub mod cueing;
mod default_rig;
#[doc(hidden)]
pub mod filter;
mod input;
pub mod interface;
mod model;
pub mod motion;
pub mod platform;
pub mod presets;
pub mod riccati;
mod validate;
mod washout;

pub use nalgebra;

pub use interface::{Input, Output, Parameters, Preview, Rig};
pub use moris_interface::{Group, MOST_INTERNAL_STEPS, ParameterError, SHORTEST_STEP};
pub use validate::{check, check_rig, input_warnings, warnings};
pub use washout::{InputCourse, Washout};

// The snippets of these pages, as doc tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
#[doc = include_str!("../docs/rust.md")]
mod pages {}
