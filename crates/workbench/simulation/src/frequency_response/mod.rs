//! Frequency response of the whole washout, from the head in the vehicle to the head on the
//! platform.
//!
//! The test follows the objective motion cueing test of ICAO Doc 9625. The module [`excitation`]
//! makes a sine on one channel. Under it [`response()`] simulates the washout, and measures what
//! is felt on all channels.

pub mod channel;
pub mod excitation;
mod measure;

pub use measure::{Response, SETTLED_FRACTION, response, response_on};
