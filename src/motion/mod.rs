//! Motion along lines and about axes, and the braking law that keeps it within limits.
//!
//! [`Motion`] is one motion, or three side by side.

pub mod braking_law;
pub(crate) mod interpolation;
pub(crate) mod lanes;
pub(crate) mod min_max;
pub mod orientation;
pub(crate) mod square_root;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Position, velocity and acceleration of a motion along a line or about an axis, in SI units. With
/// vectors, those of three motions side by side: along x, y, z or in roll, pitch, yaw.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Motion<T = f64> {
    pub position: T,
    pub velocity: T,
    pub acceleration: T,
}

impl Motion {
    /// At rest at this position.
    pub fn at_rest(position: f64) -> Self {
        Motion { position, velocity: 0.0, acceleration: 0.0 }
    }

    /// The function of position, velocity and acceleration each.
    pub(crate) fn map(self, function: impl Fn(f64) -> f64) -> Self {
        let [position, velocity, acceleration] = [self.position, self.velocity, self.acceleration].map(function);
        Motion { position, velocity, acceleration }
    }
}

impl Motion<Vector3<f64>> {
    /// The motion on one axis.
    pub fn axis(&self, k: usize) -> Motion {
        Motion { position: self.position[k], velocity: self.velocity[k], acceleration: self.acceleration[k] }
    }

    /// The motions of three axes side by side.
    pub fn from_axes(motion: impl Fn(usize) -> Motion) -> Self {
        let axes = [motion(0), motion(1), motion(2)];
        Motion {
            position: axes.map(|axis| axis.position).into(),
            velocity: axes.map(|axis| axis.velocity).into(),
            acceleration: axes.map(|axis| axis.acceleration).into(),
        }
    }

    /// Adds a motion to that on one axis.
    pub fn add_to_axis(&mut self, k: usize, motion: &Motion) {
        self.position[k] += motion.position;
        self.velocity[k] += motion.velocity;
        self.acceleration[k] += motion.acceleration;
    }

    /// The motions after `time` seconds of their accelerations, for tests.
    #[cfg(test)]
    pub(crate) fn after(&self, time: f64) -> Self {
        Motion {
            position: self.position + (self.velocity + self.acceleration * (0.5 * time)) * time,
            velocity: self.velocity + self.acceleration * time,
            acceleration: self.acceleration,
        }
    }

    /// The motions after `step` seconds of the steady accelerations that lead to these velocities.
    pub fn at_velocity(&self, velocity: Vector3<f64>, step: f64) -> Self {
        Motion {
            position: self.position + 0.5 * step * (self.velocity + velocity),
            velocity,
            acceleration: (velocity - self.velocity) / step,
        }
    }
}
