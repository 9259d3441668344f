//! A Stewart platform with dynamics: the real motion of a motion base for commanded leg lengths.
//!
//! The inputs are six commanded leg lengths. Each leg follows its command as a second-order system
//! after a dead time, within limits of speed, acceleration, stroke and force. The outputs are the
//! real leg lengths, the pose, the forces, and the specific force at the rider's head. On a rig
//! with cranks angles of the arms stand in the place of lengths. The model serves to test a washout
//! filter or a motion base's controller.
//!
//! | module | contents |
//! |---|---|
//! | [`interface`] | the table of variables |
//! | [`delay`] | the dead time of the commands |
//! | [`drive`] | a leg's response to its command, and its limits of speed, acceleration and stroke |
//! | [`body`] | the moving masses as one rigid body |
//! | [`dynamics`] | from the legs' forces to the body's acceleration, and back |
//! | [`saturation`] | the motion under limited forces, or with a leg at an end of its stroke |
//!
//! Geometry and kinematics are those of [`moris_washout::platform`], frames and signs too: x
//! forward, y left, z up. All quantities are in SI units. A step allocates nothing, does no I/O and
//! does not panic, for any input.

#![forbid(unsafe_code)]

pub mod body;
mod check;
pub mod delay;
pub mod drive;
pub mod dynamics;
mod identity;
pub mod interface;
pub mod saturation;
mod stewart_platform;

pub use check::check;
pub use interface::{Input, Output, Parameters};
pub use moris_interface::{Model, ParameterError};
pub use stewart_platform::StewartPlatform;
