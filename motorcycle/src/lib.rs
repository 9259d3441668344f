//! A motorcycle and its rider, from throttle, brake and lean to what the rider's head feels.
#![forbid(unsafe_code)]

pub mod interface;
mod model;
mod motorcycle;

pub use interface::{Input, Output, Parameters};
pub use motorcycle::{MOST_INTERNAL_STEPS, Motorcycle};
