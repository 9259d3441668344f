//! Interpolation between two inputs.

use nalgebra::Vector3;

use crate::interface::Input;
use crate::motion::interpolation::between;

impl Input {
    /// The input at a `fraction` of the way to `end`, from 0 to 1. The result is
    /// engaged if this one is.
    ///
    /// The orientation goes the short way between the two rotations, whatever angles describe
    /// them: a roll from 3.1 to -3.1 rad goes over pi.
    pub fn towards(&self, end: &Input, fraction: f64) -> Input {
        let f = |from: f64, to: f64| from + fraction * (to - from);
        let vector = |a: Vector3<f64>, b: Vector3<f64>| a.zip_map(&b, f);
        Input {
            specific_force: vector(self.specific_force, end.specific_force),
            angular_velocity: vector(self.angular_velocity, end.angular_velocity),
            orientation: between(self.orientation, end.orientation, fraction),
            speed: f(self.speed, end.speed),
            lean: f(self.lean, end.lean),
            engaged: self.engaged,
        }
    }
}
