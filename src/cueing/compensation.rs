//! Block (4): the accelerations that turning the platform about its origin causes at the washout location.

use nalgebra::Vector3;

use crate::interface::Compensation;

/// alpha x r, the tangential term (the paper leaves it out; it is the larger).
pub fn tangential(angular_acceleration: Vector3<f64>, arm: Vector3<f64>) -> Vector3<f64> {
    angular_acceleration.cross(&arm)
}

/// omega x (omega x r), the centripetal term (the paper calls it the Coriolis acceleration).
pub fn centripetal(angular_velocity: Vector3<f64>, arm: Vector3<f64>) -> Vector3<f64> {
    angular_velocity.cross(&angular_velocity.cross(&arm))
}

/// The acceleration to compensate, for a platform that turns like this; `arm` is the washout location relative to the
/// platform's origin. All in the base frame.
pub fn compensated(
    compensation: Compensation,
    angular_velocity: Vector3<f64>,
    angular_acceleration: Vector3<f64>,
    arm: Vector3<f64>,
) -> Vector3<f64> {
    match compensation {
        Compensation::None => Vector3::zeros(),
        Compensation::Centripetal => centripetal(angular_velocity, arm),
        Compensation::Full => tangential(angular_acceleration, arm) + centripetal(angular_velocity, arm),
    }
}
