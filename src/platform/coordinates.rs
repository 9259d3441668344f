//! The platform's six coordinates, each with its velocity and acceleration.

use serde::{Deserialize, Serialize};

use super::PlatformMotion;
use crate::motion::Motions;
use crate::motion::orientation::RotationalMotion;

/// Surge, sway and heave from neutral in the base frame \[m\]; roll, pitch and yaw \[rad\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlatformCoordinates {
    pub linear: Motions,
    pub angles: Motions,
}

impl PlatformCoordinates {
    /// The platform's motion with these coordinates.
    pub fn motion(&self, neutral_height: f64) -> PlatformMotion {
        PlatformMotion::new(&self.linear, &RotationalMotion::new(&self.angles), neutral_height)
    }

    /// The coordinates at this fraction of the line from these to others, both reached from
    /// `before` in `step` seconds.
    pub fn towards(
        &self,
        others: &PlatformCoordinates,
        fraction: f64,
        before: &PlatformCoordinates,
        step: f64,
    ) -> Self {
        let between = |from: &Motions, to: &Motions, before: &Motions| {
            let velocity = from.velocity.lerp(&to.velocity, fraction);
            Motions {
                position: from.position.lerp(&to.position, fraction),
                velocity,
                acceleration: (velocity - before.velocity) / step,
            }
        };
        PlatformCoordinates {
            linear: between(&self.linear, &others.linear, &before.linear),
            angles: between(&self.angles, &others.angles, &before.angles),
        }
    }

    /// The coordinates after `step` seconds at the velocities they have.
    pub fn coasted(&self, step: f64) -> Self {
        let coasted = |motions: &Motions| motions.at_velocity(motions.velocity, step);
        PlatformCoordinates { linear: coasted(&self.linear), angles: coasted(&self.angles) }
    }
}
