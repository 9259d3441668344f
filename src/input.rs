//! Inputs made safe, and inputs between two others.

use nalgebra::Vector3;

use crate::interface::Input;
use crate::motion::orientation::RollPitchYaw;

/// No vehicle comes near this in SI units; beyond it arithmetic would.
const LARGEST: f64 = 1e9;

impl Input {
    /// The input with every number finite: one that is not a number counts as at rest, and any other beyond
    /// +-1e9 as that.
    pub fn made_finite(&self) -> Input {
        let usable = |value: f64| value.abs() <= LARGEST;
        let Input { specific_force: f, angular_velocity: w, orientation, speed, lean, engaged: _ } = self;
        let angles = orientation.to_vector();
        // One look at all of them: it is rare that one has to be changed.
        if [f, w, &angles].into_iter().flatten().chain([speed, lean]).fold(true, |all, &value| all & usable(value)) {
            return *self;
        }
        let rest = Input::default();
        self.map2(&rest, |value, rest| if value.is_nan() { rest } else { value.clamp(-LARGEST, LARGEST) })
    }

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
