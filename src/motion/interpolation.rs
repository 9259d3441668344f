//! Orientations between two.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::{Quaternion, Vector3};

use crate::motion::orientation::RollPitchYaw;

/// Largest pitch at whose ends the angles are interpolated \[rad\]. Beyond it, close to a pitch of
/// 90 degrees, roll and yaw turn fast or jump though the body hardly turns.
const LARGEST_PITCH: f64 = 1.4;

/// The orientation at a `fraction` of the way from one to another.
///
/// The angles change linearly, from those of the start's rotation that are nearest to the end's.
/// Where they change by more than a quarter turn, or close to a pitch of 90 degrees, the body turns
/// about a fixed axis. So the result depends on the two rotations alone.
pub fn between(start: RollPitchYaw, end: RollPitchYaw, fraction: f64) -> RollPitchYaw {
    let [from, to] = [start, end].map(RollPitchYaw::to_vector);
    let linear = |from: Vector3<f64>| from.zip_map(&to, |from, to| from + fraction * (to - from));
    let small = |from: Vector3<f64>| (to - from).amax() <= FRAC_PI_2;
    if small(from) && from.y.abs() <= LARGEST_PITCH && to.y.abs() <= LARGEST_PITCH {
        return RollPitchYaw::from_vector(linear(from));
    }
    let nearest = nearest_angles(from, to);
    let steep = |pitch: f64| libm::sin(pitch).abs() > libm::sin(LARGEST_PITCH);
    if small(nearest) && !steep(from.y) && !steep(to.y) {
        return RollPitchYaw::from_vector(linear(nearest));
    }
    angles_of_rotation(interpolated_rotation(rotation_quaternion(from), rotation_quaternion(to), fraction))
}

/// The angles of the same rotation that are nearest to others. The angles are shifted by whole
/// turns, and by half a turn of roll and yaw with the pitch on the other side of 90 degrees.
fn nearest_angles(angles: Vector3<f64>, others: Vector3<f64>) -> Vector3<f64> {
    let flipped = Vector3::new(angles.x + PI, PI - angles.y, angles.z + PI);
    let [same, flipped] = [angles, flipped].map(|angles| {
        let change = others - angles;
        others - change.map(|angle| angle - TAU * libm::round(angle / TAU))
    });
    if (others - flipped).amax() < (others - same).amax() { flipped } else { same }
}

/// The rotation Rz(yaw) Ry(pitch) Rx(roll) as a quaternion.
fn rotation_quaternion(angles: Vector3<f64>) -> Quaternion<f64> {
    let [x, y, z] = [angles.x, angles.y, angles.z].map(|angle| libm::sincos(0.5 * angle));
    Quaternion::new(z.1, 0.0, 0.0, z.0) * Quaternion::new(y.1, 0.0, y.0, 0.0) * Quaternion::new(x.1, x.0, 0.0, 0.0)
}

/// Rotation at a fraction of the way between two, about a fixed axis.
fn interpolated_rotation(from: Quaternion<f64>, to: Quaternion<f64>, fraction: f64) -> Quaternion<f64> {
    let to = if from.dot(&to) < 0.0 { -to } else { to };
    let angle = 2.0 * libm::atan2((to - from).norm(), (to + from).norm());
    let sine = libm::sin(angle);
    if sine <= f64::EPSILON {
        return to;
    }
    from * (libm::sin((1.0 - fraction) * angle) / sine) + to * (libm::sin(fraction * angle) / sine)
}

/// Angles of a rotation.
fn angles_of_rotation(q: Quaternion<f64>) -> RollPitchYaw {
    let (w, x, y, z) = (q.w, q.i, q.j, q.k);
    let (forward, across) = (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z));
    let cos_pitch = libm::hypot(forward, across);
    let pitch = libm::atan2(2.0 * (w * y - x * z), cos_pitch);
    // At the pole itself roll and yaw are one.
    if cos_pitch <= f64::EPSILON {
        let yaw = libm::atan2(2.0 * (w * z - x * y), 1.0 - 2.0 * (x * x + z * z));
        return RollPitchYaw::new(0.0, pitch, yaw);
    }
    let roll = libm::atan2(2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y));
    RollPitchYaw::new(roll, pitch, libm::atan2(across, forward))
}
