//! The evaluator (the paper's section 5): what the rider feels on the commanded motion.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::platform::LocationFrame;
use crate::platform::PlatformMotion;

/// Specific force \[m/s2\] and angular velocity \[rad/s\] at the washout location, in its axes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Felt {
    pub specific_force: Vector3<f64>,
    pub angular_velocity: Vector3<f64>,
}

/// f^H = R_B^H (p_head'' - g), eq. (5) with g = (0, 0, -gravity) and every term of p_head''.
///
/// The head is taken as at rest relative to the platform: the platform does not
/// cause the rider's leaning.
#[inline(always)]
pub fn felt(platform: &PlatformMotion, head: &LocationFrame, gravity: f64) -> Felt {
    let rotation = platform.orientation.rotation;
    let specific_force = platform.acceleration_at(rotation * head.point) + Vector3::new(0.0, 0.0, gravity);
    Felt {
        specific_force: head.to_location_axes(rotation.tr_mul(&specific_force)),
        angular_velocity: head.to_location_axes(rotation.tr_mul(&platform.angular_velocity)),
    }
}
