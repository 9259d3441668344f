//! The washout filter of the MORIS motorcycle simulator, with its Stewart platform's kinematics.
//!
//! A vehicle model says what a rider would feel; [`Washout`] says where a platform and its six actuators must go so that
//! a real rider feels it. The source is Barbagli, Ferrazzin, Avizzano, Bergamasco: *Washout Filter Design for a
//! Motorcycle Simulator*; equations are cited by its numbers.
//!
//! Data flows one way, through modules named as in the paper's Fig. 4:
//!
//! | module | block |
//! |---|---|
//! | [`conditioning`], [`splitter`] | (1) strategy splitter: gravity removal, scale, limit; high and low frequencies |
//! | `preaction` | ahead of (1): begin to end the tilt before a stop (the paper's section 6) |
//! | [`gravitational`] | (2) gravitational strategy: tilt |
//! | [`direct_linear`], [`safety`] | (3) direct linear motion with its safety units |
//! | [`spurious`] | (4) spurious accelerations of tilting |
//! | [`angular`] | (5), (6) angular channel |
//! | [`platform`] | pose to legs and back, actuator guard |
//! | [`evaluator`] | what the rider feels |
//!
//! Frames: the base frame and the platform frame have x forward, y left, z up; roll, pitch and yaw turn about x, y and
//! z, so that positive pitch is nose down. All quantities are in SI units.
//!
//! Sines, cosines and their like come from the crate `libm`, so that every platform computes the same bits.
//!
//! A step allocates nothing, does no I/O and does not panic, whatever it is fed.

#![forbid(unsafe_code)]

pub mod angular;
mod bump;
pub mod chain;
mod check;
pub mod conditioning;
mod default_rig;
pub mod direct_linear;
pub mod evaluator;
mod extremes;
pub mod governor;
pub mod gravitational;
pub mod head;
mod input;
pub mod interface;
mod model;
pub mod motions;
pub mod orientation;
pub mod parameter_sets;
pub mod platform;
mod preaction;
pub mod safety;
pub mod splitter;
pub mod spurious;
mod washout;

pub use nalgebra;

pub use check::check;
pub use interface::{Input, Output, Parameters, Rig};
pub use model_interface::Refusal;
pub use washout::{ENGAGE_TIME, MOST_INTERNAL_STEPS, SHORTEST_STEP, Washout};
