//! A preview that is learned by driving the same road again.
//!
//! [`Laps`] remembers the specific force of surge and sway along the line that a vehicle drives.
//! Where the vehicle comes by again in the same direction, the force of the earlier passes is a
//! forecast of the next 4 s. The washout's predictive strategy takes it as its [`Preview`]
//! (`vehicle.preview.*`).
//!
//! ```
//! use moris_laps::{Laps, Sample};
//!
//! let mut laps = Laps::new();
//! // Four rounds of 60 s on a circle, with brakes and throttle in turn.
//! let surge = |angle: f64| 2.0 * (4.0 * (13.0 * angle).sin()).tanh();
//! for k in 0..24_000 {
//!     let angle = std::f64::consts::TAU * 0.01 * f64::from(k) / 60.0;
//!     laps.step(&Sample {
//!         step: 0.01,
//!         position: [100.0 * angle.cos(), 100.0 * angle.sin(), 0.0],
//!         speed: None,
//!         force: [surge(angle), 1.1],
//!     });
//! }
//! let preview = laps.preview();
//! assert_eq!(preview.count, 20);
//! // 1 s from now, at the beginning of the fifth round.
//! let angle = std::f64::consts::TAU / 60.0;
//! assert!((preview.surge[4] - surge(angle)).abs() < 0.1);
//! assert!(laps.trust() > 0.9);
//! ```
//!
//! The modules follow a sample on its way:
//!
//! - `ticks` makes equal ticks of 50 ms of it, and `smooth` the force and the position that are
//!   remembered.
//! - `line` is the memory: a ring of points, found by place.
//! - `search` finds earlier passes of a place, and `pass` follows one of them beside the vehicle.
//! - `account` keeps account of what the preview has gained and lost, and bounds the loss.
//! - `forecast` makes the forecast of an axis of them, and compares it with what came.
//! - `text` writes the memory as text, and reads it.

#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;

mod account;
mod forecast;
mod laps;
mod line;
mod pass;
mod search;
mod smooth;
mod text;
mod ticks;

pub use laps::Laps;
pub use line::Point;
pub use moris_washout::Preview;
pub use text::NoMemory;
pub use ticks::Sample;
