//! Inputs between two others.

use nalgebra::Vector3;

use crate::interface::Input;
use crate::motion::orientation::RollPitchYaw;

impl Input {
    /// The input at a `share` of the way to `end`, from 0 to 1; engaged or not as this one.
    pub fn towards(&self, end: &Input, share: f64) -> Input {
        self.map2(end, |from, to| from + share * (to - from))
    }

    fn map2(&self, other: &Input, f: impl Fn(f64, f64) -> f64) -> Input {
        let vector = |a: Vector3<f64>, b: Vector3<f64>| a.zip_map(&b, &f);
        Input {
            specific_force: vector(self.specific_force, other.specific_force),
            angular_velocity: vector(self.angular_velocity, other.angular_velocity),
            orientation: RollPitchYaw::from_vector(vector(self.orientation.to_vector(), other.orientation.to_vector())),
            speed: f(self.speed, other.speed),
            lean: f(self.lean, other.lean),
            engaged: self.engaged,
        }
    }
}
