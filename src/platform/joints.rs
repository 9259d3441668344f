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
    /// One joint.
    pub fn joint(&self, i: usize) -> Vector3<f64> {
        Vector3::new(self.x[i], self.y[i], self.z[i])
    }

    /// The joints turned about the origin of their frame.
    #[inline(always)]
    pub fn turned(&self, rotation: &Matrix3<f64>) -> Joints {
        let row = |k: usize| {
            let (a, b, c) = (rotation[(k, 0)], rotation[(k, 1)], rotation[(k, 2)]);
            std::array::from_fn(|i| a * self.x[i] + b * self.y[i] + c * self.z[i])
        };
        Joints { x: row(0), y: row(1), z: row(2) }
    }
}

impl From<&[Vector3<f64>; 6]> for Joints {
    fn from(joints: &[Vector3<f64>; 6]) -> Self {
        Joints { x: joints.map(|joint| joint.x), y: joints.map(|joint| joint.y), z: joints.map(|joint| joint.z) }
    }
}
