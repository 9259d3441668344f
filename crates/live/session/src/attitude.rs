//! Attitudes compared as rotations. Roll, pitch and yaw describe each attitude twice, and jump from
//! one description to the other at a vertical.

use std::f64::consts::PI;

use moris_washout::interface::RollPitchYaw;
use moris_washout::motion::orientation::Orientation;
use nalgebra::{Rotation3, UnitQuaternion};

use crate::motion::turns;

fn rotation(angles: &RollPitchYaw) -> UnitQuaternion<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(Orientation::new(*angles).rotation))
}

/// Angle of the rotation from one attitude to another \[rad\].
pub fn angle_between(one: &RollPitchYaw, other: &RollPitchYaw) -> f64 {
    rotation(one).angle_to(&rotation(other))
}

/// The description of the attitude that is nearest to another.
pub fn nearest_angles(angles: &RollPitchYaw, to: &RollPitchYaw) -> RollPitchYaw {
    let near = |value: f64, to: f64| value - turns(value - to);
    let first = RollPitchYaw::new(near(angles.roll, to.roll), near(angles.pitch, to.pitch), near(angles.yaw, to.yaw));
    let second = RollPitchYaw::new(
        near(angles.roll + PI, to.roll),
        near(PI - angles.pitch, to.pitch),
        near(angles.yaw + PI, to.yaw),
    );
    let distance = |found: &RollPitchYaw| (found.to_vector() - to.to_vector()).norm_squared();
    if distance(&second) < distance(&first) { second } else { first }
}

/// The attitude at a part of the rotation from one attitude to another.
pub fn between(from: &RollPitchYaw, to: &RollPitchYaw, part: f64) -> RollPitchYaw {
    let [start, end] = [from, to].map(rotation);
    let Some(middle) = start.try_slerp(&end, part, 1e-9) else { return *from };
    let (roll, pitch, yaw) = middle.euler_angles();
    nearest_angles(&RollPitchYaw::new(roll, pitch, yaw), from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_descriptions_are_one_attitude() {
        let (one, other) = (RollPitchYaw::new(0.3, 1.2, -0.4), RollPitchYaw::new(0.3 + PI, PI - 1.2, PI - 0.4));
        assert!(angle_between(&one, &other) < 1e-7);
        let nearest = nearest_angles(&other, &one);
        assert!((nearest.to_vector() - one.to_vector()).norm() < 1e-12);
    }

    #[test]
    fn a_loop_has_no_jump() {
        let mut before = RollPitchYaw::default();
        for k in 1..2000 {
            let angle = 0.01 * f64::from(k);
            let over = angle.cos() < 0.0;
            let half = if over { PI } else { 0.0 };
            let given = RollPitchYaw::new(half, -angle.sin().asin(), half);
            let found = nearest_angles(&given, &before);
            assert!((found.to_vector() - before.to_vector()).amax() < 0.011, "{found:?} after {before:?}");
            before = found;
        }
        assert!((before.pitch + 19.99).abs() < 1e-6);
    }

    #[test]
    fn the_middle_of_a_rotation() {
        let middle = between(&RollPitchYaw::new(0.0, 1.5, 0.0), &RollPitchYaw::new(PI, 1.5, PI), 0.5);
        assert!(
            (middle.pitch - PI / 2.0).abs() < 1e-6
                && angle_between(&middle, &RollPitchYaw::new(0.0, PI / 2.0, 0.0)) < 1e-6
        );
    }
}
