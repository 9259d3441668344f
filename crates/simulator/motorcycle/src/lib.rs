//! A motorcycle and its rider. The inputs are throttle, brake, lean and wind; the main output is
//! the specific force at the rider's head.
//!
//! [`Motorcycle`] is stepped together with a washout. Its first outputs are the washout's inputs,
//! with the same names and frames.
//!
//! | module | contents |
//! |---|---|
//! | [`longitudinal`] | drive, brakes, drag, tyre limits, standstill |
//! | [`suspension`] | heave and pitch: a half-bike on two springs |
//! | [`lateral`] | lean, steer, lateral velocity and yaw on tyres that slip, in the manner of Sharp (1971) |
//! | [`whipple`] | the limit for stiff tyres: the benchmark bicycle of Meijaard et al. (2007) |
//! | [`rider`] | lean control by steering torque and torso |
//! | [`path`] | a path, and the rider who follows it |
//! | [`pose`] | the pose in the world, and the specific force at the head |
//! | [`state`] | the state vector and its integration |
//!
//! Frames: x forward, y left, z up. Roll is positive to the right, pitch positive nose down, yaw
//! positive to the left. Only [`lateral`] and [`whipple`] use the axes of their literature, y to
//! the right and z down. All quantities are in SI units. Trigonometric and similar functions are
//! those of the crate `libm`, so that every platform computes the same bits.
//!
//! A step allocates nothing, does no I/O and does not panic, for any input.

#![forbid(unsafe_code)]

mod check;
mod identity;
pub mod interface;
pub mod lateral;
pub mod longitudinal;
mod motorcycle;
mod output_rate;
pub mod path;
pub mod pose;
pub mod rider;
mod speeds;
pub mod state;
pub mod suspension;
pub mod whipple;

pub use interface::{Course, Input, Output, Parameters};
pub use moris_interface::{Model, ParameterError};
pub use motorcycle::{MOST_MOTORCYCLE_STEPS, Motorcycle};

// The snippets of `docs/motorcycle.md` as doc tests.
#[cfg(doctest)]
#[doc = include_str!("../../../../docs/motorcycle.md")]
mod page {}
