//! The platform's six coordinates, each with its velocity and acceleration.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::PlatformMotion;
use crate::motion::Motion;
use crate::motion::orientation::RotationalMotion;

/// Surge, sway and heave from neutral in the base frame \[m\]; roll, pitch and yaw \[rad\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlatformCoordinates {
    pub linear: Motion<Vector3<f64>>,
    pub angles: Motion<Vector3<f64>>,
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
        let between = |from: &Motion<Vector3<f64>>, to: &Motion<Vector3<f64>>, before: &Motion<Vector3<f64>>| {
            let velocity = from.velocity.lerp(&to.velocity, fraction);
            Motion {
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
        let coasted = |motions: &Motion<Vector3<f64>>| motions.at_velocity(motions.velocity, step);
        PlatformCoordinates { linear: coasted(&self.linear), angles: coasted(&self.angles) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn coordinates_between_two_have_the_velocity_between_and_the_acceleration_to_it() {
        let motions = |position: f64, velocity: f64| Motion {
            position: Vector3::new(position, 0.0, -position),
            velocity: Vector3::new(0.0, velocity, 2.0 * velocity),
            acceleration: Vector3::zeros(),
        };
        let coordinates = |position, velocity| PlatformCoordinates {
            linear: motions(position, velocity),
            angles: motions(2.0 * position, 3.0 * velocity),
        };
        let (step, before) = (0.004, coordinates(0.1, 0.2));
        let between = coordinates(0.11, 0.22).towards(&coordinates(0.15, 0.3), 0.25, &before, step);
        let expected = |found: f64, value: f64| assert!((found - value).abs() < 1e-12, "{found}, not {value}");
        expected(between.linear.position.x, 0.12);
        expected(between.linear.velocity.y, 0.24);
        expected(between.linear.acceleration.z, 2.0 * (0.24 - 0.2) / step);
        expected(between.angles.position.z, -0.24);
        expected(between.angles.acceleration.y, 3.0 * (0.24 - 0.2) / step);
    }
}
