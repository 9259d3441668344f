//! Vectors in lanes, for arithmetic on three axes at once.

use nalgebra::Vector3;
use wide::f64x4;

/// The components in the first three lanes; the fourth is zero.
pub fn lanes(vector: &Vector3<f64>) -> f64x4 {
    f64x4::new([vector.x, vector.y, vector.z, 0.0])
}
