//! A ride in the browser: the motorcycle by hand, with the washout and the platform.
//!
//! - [`Ridden`] is the motorcycle with its rider, who obeys a player.
//! - [`Ride`] steps motorcycle and washout together, a millisecond at a time.
//! - [`Circuit`] is the road in the plane.
//! - [`Recording`] has the ride's measures and its file.
//! - [`lamps`] shows limits that act.
//! - [`page`] makes the page. The functions for its script are in `exports`, which only the
//!   WebAssembly has.

mod course;
pub mod lamps;
pub mod page;
mod recording;
mod ridden;
mod rider;
mod stepping;

pub use course::{Circuit, PlanePose, RoadMap, RoadPlace};
pub use recording::{Rating, Recording};
pub use ridden::{Ridden, RiderCommand};
pub use stepping::{HALF_WIDTH, Lap, Ride, STEP, Stage};
