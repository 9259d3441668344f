//! The platform's six coordinates, each with its velocity and acceleration.

use serde::{Deserialize, Serialize};

use super::PlatformMotion;
use crate::motion::Motions;
use crate::motion::orientation::Turning;

/// Surge, sway and heave from neutral in the base frame \[m\]; roll, pitch and yaw \[rad\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Coordinates {
    pub linear: Motions,
    pub angles: Motions,
}

impl Coordinates {
    /// The platform's motion with these coordinates.
    pub fn motion(&self, neutral_height: f64) -> PlatformMotion {
        PlatformMotion::new(&self.linear, &Turning::new(&self.angles), neutral_height)
    }

    /// The coordinates at this fraction of the line from these to others, both reached from
    /// `before` in `step` seconds.
    pub fn towards(&self, others: &Coordinates, fraction: f64, before: &Coordinates, step: f64) -> Self {
        let between = |from: &Motions, to: &Motions, before: &Motions| {
            let velocity = from.velocity.lerp(&to.velocity, fraction);
            Motions {
                position: from.position.lerp(&to.position, fraction),
                velocity,
                acceleration: (velocity - before.velocity) / step,
            }
        };
        Coordinates {
            linear: between(&self.linear, &others.linear, &before.linear),
            angles: between(&self.angles, &others.angles, &before.angles),
        }
    }

    /// The coordinates after `step` seconds at the velocities they have.
    pub fn coasted(&self, step: f64) -> Self {
        let coasted = |motions: &Motions| motions.at_velocity(motions.velocity, step);
        Coordinates { linear: coasted(&self.linear), angles: coasted(&self.angles) }
    }
}
