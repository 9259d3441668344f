//! Block (4): what turning the platform about its origin adds at the washout location:
//! accelerations, and gravity where it is not tilt coordination's.

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

/// Part of gravity in the specific force where the platform has the orientation R and not its tilt
/// alone, R_t: in the base frame, (1 - R R_t^T) (0, 0, g).
pub fn added_gravity(rotation: &Matrix3<f64>, tilt: &Tilt, gravity: f64) -> Vector3<f64> {
    let (sin_roll, cos_roll) = libm::sincos(tilt.roll);
    let (sin_pitch, cos_pitch) = libm::sincos(tilt.pitch);
    let tilted = gravity * Vector3::new(-sin_pitch, cos_pitch * sin_roll, cos_pitch * cos_roll);
    Vector3::new(0.0, 0.0, gravity) - rotation * tilted
}

/// The acceleration to compensate, in the base frame, for a platform that turns like this, of which
/// `tilt` is tilt coordination's part; `arm` is the washout location relative to the platform's
/// origin, in the base frame.
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
