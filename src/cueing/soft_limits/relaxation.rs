//! Relaxation of limits beyond which a demand stays, such as the classical strategy's.
//!
//! Travel would not make up for a tilt that begins there, and the head would be kicked back. So the
//! limits relax by the surge and sway y that make up for the tilt's acceleration alpha,
//!
//! ```text
//!     y'' = -alpha x r - w^2 y - w y',    r from the platform's origin to the head
//! ```
//!
//! along each row, and never beyond where they are. Where the clearance is small, y is a part of
//! that: limits that come and go fast would jolt. Along a row y counts as y/(1 + (y/r)^4)^(1/4),
//! with r a part of the clearance that the row has at neutral. Limits that relaxed farther would
//! contradict each other, and none would be kept.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::ApproachLimits;
use crate::motion::Motion;
use crate::motion::min_max::{max, min};
use crate::motion::square_root::square_root;

/// Frequency w at which the limits return, with a damping ratio of 1/2 \[rad/s\].
const RETURN_RATE: f64 = 0.8;
/// Largest relaxation of an end, as a fraction of its distance from neutral.
const MAX_RELAXATION_FRACTION: f64 = 0.5;
/// Least clearance at neutral from which on the relaxation is whole \[m\].
const FULL_RELAXATION_CLEARANCE: f64 = 0.1;
/// Time within which the relaxation sets in, so that it does so without a jump \[s\].
const ONSET_TIME: f64 = 0.2;

/// The relaxation of all limits while a row acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Relaxation {
    travel: Motion<Vector3<f64>>,
    /// Time for which a row has acted, at most [`ONSET_TIME`] \[s\].
    acting: f64,
}

impl Relaxation {
    /// The fraction of a relaxation that a machine can make with this least
    /// clearance at neutral \[m\].
    pub fn fraction_within(clearance: f64) -> f64 {
        min(clearance / FULL_RELAXATION_CLEARANCE, 1.0)
    }

    /// True while a row acts.
    pub fn acts(&self) -> bool {
        self.acting > 0.0
    }

    /// The relaxation with its acceleration in this step. `tilt_compensation` is the surge and sway
    /// that compensate the tilt's acceleration.
    pub fn accelerated(&self, tilt_compensation: &Vector3<f64>) -> Self {
        let Motion { position, velocity, .. } = self.travel;
        let acceleration =
            self.acting / ONSET_TIME * tilt_compensation - RETURN_RATE * (RETURN_RATE * position + velocity);
        Relaxation { travel: Motion { acceleration, ..self.travel }, ..*self }
    }

    /// The relaxation after a step in which a row has acted.
    pub fn after(&self, step: f64) -> Self {
        let Motion { velocity, acceleration, .. } = self.travel;
        let travel = self.travel.at_velocity(velocity + step * acceleration, step);
        Relaxation { travel, acting: min(self.acting + step, ONSET_TIME) }
    }

    /// The range of the acceleration of a quantity that travel changes along `direction`.
    pub fn range(&self, ends: &ApproachLimits, [q, v]: [f64; 2], direction: &Vector3<f64>, pace: f64) -> (f64, f64) {
        let (lower, upper) = ends.range(q, v, pace);
        if !self.acts() {
            return (lower, upper);
        }
        let Motion { position, velocity, acceleration } = &self.travel;
        let [position, velocity, acceleration] = [position, velocity, acceleration].map(|part| direction.dot(part));
        // The end that comes nearer: the other one stays where it is.
        let clearance = if position > 0.0 { ends.neutral_clearance[0] } else { ends.neutral_clearance[1] };
        let largest = max(MAX_RELAXATION_FRACTION * clearance, f64::MIN_POSITIVE);
        let part = position / largest;
        let to_fourth = 1.0 + (part * part) * (part * part);
        let root = square_root(square_root(to_fourth));
        let slope = 1.0 / (to_fourth * root);
        let second_slope = -5.0 * (part * part * part) / largest * slope / to_fourth;
        let along = slope * acceleration + second_slope * velocity * velocity;
        let (least, most) = ends.range(q - position / root, v - slope * velocity, pace);
        let upper = min(upper, most + along);
        (min(max(lower, least + along), upper), upper)
    }
}
