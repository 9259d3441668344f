//! The six joints on the base or the platform.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// The x, the y and the z of six joints \[m\]: so laid out, and aligned, the processor
/// does two legs at a time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[repr(align(16))]
pub struct Joints {
    pub x: [f64; 6],
    pub y: [f64; 6],
    pub z: [f64; 6],
}

impl Joints {
    /// Position of joint `i` \[m\].
    pub fn joint(&self, i: usize) -> Vector3<f64> {
        Vector3::new(self.x[i], self.y[i], self.z[i])
    }

    /// The joints turned about the origin of their frame.
    #[inline(always)]
    pub fn turned(&self, rotation: &Matrix3<f64>) -> Joints {
        let row = |k: usize| {
            let (a, b, c) = (rotation[(k, 0)], rotation[(k, 1)], rotation[(k, 2)]);
            core::array::from_fn(|i| a * self.x[i] + b * self.y[i] + c * self.z[i])
        };
        Joints { x: row(0), y: row(1), z: row(2) }
    }
}

impl From<&[Vector3<f64>; 6]> for Joints {
    fn from(joints: &[Vector3<f64>; 6]) -> Self {
        Joints { x: joints.map(|joint| joint.x), y: joints.map(|joint| joint.y), z: joints.map(|joint| joint.z) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::orientation::{Orientation, RollPitchYaw};

    /// Joints out of their plane, too, as some rigs have them.
    #[test]
    fn turned_joints_are_the_rotations_of_each() {
        let joints: [Vector3<f64>; 6] = core::array::from_fn(|i| {
            let angle = i as f64;
            Vector3::new(0.7 * angle.cos(), 0.5 * angle.sin(), 0.05 * (1.0 + angle))
        });
        let rotation = Orientation::new(RollPitchYaw { roll: 0.3, pitch: -0.4, yaw: 1.1 }).rotation;
        let turned = Joints::from(&joints).turned(&rotation);
        for (i, joint) in joints.iter().enumerate() {
            assert!((turned.joint(i) - rotation * joint).norm() < 1e-15);
        }
    }
}
