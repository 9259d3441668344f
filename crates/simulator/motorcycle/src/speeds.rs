//! Speeds for which gains are computed.

use serde::{Deserialize, Serialize};

/// A range of speeds with knots, each faster than the one before by the same factor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Speeds {
    /// Ends of the range \[m/s\].
    pub slowest: f64,
    pub fastest: f64,
}

impl Speeds {
    /// Speed of the knot number `k` of `count` \[m/s\].
    pub fn knot(&self, k: usize, count: usize) -> f64 {
        self.slowest * libm::pow(self.fastest / self.slowest, k as f64 / (count - 1) as f64)
    }

    /// The last of `count` knots before a speed, and the fraction of the way to the next one.
    /// Speeds outside the range count as its ends.
    pub fn find(&self, speed: f64, count: usize) -> (usize, f64) {
        let last = (count - 1) as f64;
        let place = libm::log(speed / self.slowest) / libm::log(self.fastest / self.slowest) * last;
        let place = place.max(0.0).min(last);
        let k = (place as usize).min(count - 2);
        (k, place - k as f64)
    }
}
