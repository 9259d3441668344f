//! Interpolation between two inputs.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::Vector3;

use crate::interface::Input;
use crate::motion::orientation::RollPitchYaw;

impl Input {
    /// The input at a `fraction` of the way to `end`, from 0 to 1. It is engaged if this one is.
    pub fn towards(&self, end: &Input, fraction: f64) -> Input {
        self.map2(end, |from, to| from + fraction * (to - from))
    }

    /// The start of a linear change to `end`, if this input came before it: this input, with its
    /// angles shifted by whole turns to be nearest to the end's. None if no angle is shifted.
    ///
    /// An angle that still changes by more than a quarter turn has not been turned through: at a
    /// pitch of 90 degrees, roll and yaw jump. The orientation is then that of the end.
    pub fn ramp_start(&self, end: &Input) -> Option<Input> {
        let (before, after) = (self.orientation.to_vector(), end.orientation.to_vector());
        let change = after - before;
        if change.amax() <= FRAC_PI_2 {
            return None;
        }
        let nearest = after - change.map(|angle| angle - TAU * (angle / TAU).round());
        let orientation = if (after - nearest).amax() <= FRAC_PI_2 { nearest } else { after };
        Some(Input { orientation: RollPitchYaw::from_vector(orientation), ..*self })
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
