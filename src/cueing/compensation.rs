//! Block (4): the effect of the platform's rotation about its origin at the washout location.
//!
//! The effect consists of accelerations, and of gravity as far as that is not tilt coordination's.

use nalgebra::{Matrix3, Vector3};

use crate::cueing::gravitational::Tilt;
use crate::interface::Compensation;
use crate::motion::orientation::RotationalMotion;

/// alpha x r, the tangential term (the paper leaves it out; it is the larger).
pub fn tangential(angular_acceleration: Vector3<f64>, arm: Vector3<f64>) -> Vector3<f64> {
    angular_acceleration.cross(&arm)
}

/// omega x (omega x r), the centripetal term (the paper calls it the Coriolis acceleration).
pub fn centripetal(angular_velocity: Vector3<f64>, arm: Vector3<f64>) -> Vector3<f64> {
    angular_velocity.cross(&angular_velocity.cross(&arm))
}

/// The gravity that the tilt alone does not add to the specific force: in the base frame,
/// (1 - R R_t^T) (0, 0, g).
///
/// R is the platform's orientation, and R_t its tilt alone.
pub fn added_gravity(rotation: &Matrix3<f64>, tilt: &Tilt, gravity: f64) -> Vector3<f64> {
    let (sin_roll, cos_roll) = libm::sincos(tilt.roll);
    let (sin_pitch, cos_pitch) = libm::sincos(tilt.pitch);
    let tilted = gravity * Vector3::new(-sin_pitch, cos_pitch * sin_roll, cos_pitch * cos_roll);
    Vector3::new(0.0, 0.0, gravity) - rotation * tilted
}

/// Acceleration to compensate, in the base frame, for a platform that turns as `turning` says.
///
/// `tilt` is tilt coordination's part of the orientation. `arm` is the washout location relative to
/// the platform's origin, in the base frame.
pub fn compensated(
    compensation: Compensation,
    turning: &RotationalMotion,
    arm: Vector3<f64>,
    tilt: &Tilt,
    gravity: f64,
) -> Vector3<f64> {
    let RotationalMotion { orientation, velocity, acceleration } = turning;
    let of_turning = || tangential(*acceleration, arm) + centripetal(*velocity, arm);
    match compensation {
        Compensation::None => Vector3::zeros(),
        Compensation::Centripetal => centripetal(*velocity, arm),
        Compensation::Full => of_turning(),
        Compensation::Gravity => of_turning() + added_gravity(&orientation.rotation, tilt, gravity),
    }
}
