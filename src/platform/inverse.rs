//! Inverse kinematics: L_i = |v_p + R a_i - b_i| and its derivatives.

use serde::{Deserialize, Serialize};

use super::{Geometry, PlatformMotion, Pose};
use crate::cueing::compensation::{centripetal, tangential};

/// The six legs: length \[m\] and rate \[m/s\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Legs {
    pub length: [f64; 6],
    pub velocity: [f64; 6],
}

/// A leg shorter than this has no direction; no rig that is accepted comes near it \[m\].
const SHORTEST: f64 = 1e-9;

/// Lengths and rates of the legs for a motion of the platform.
#[inline(always)]
pub fn inverse_kinematics(geometry: &Geometry, motion: &PlatformMotion) -> Legs {
    let Geometry { base, platform } = geometry;
    let arm = platform.turned(&motion.orientation.rotation);
    let (p, v, w) = (motion.position, motion.velocity, motion.angular_velocity);
    let mut legs = Legs::default();
    // Written out and not in vectors, so that the processor does two legs at a time.
    for i in 0..6 {
        let (x, y, z) = (p.x + arm.x[i] - base.x[i], p.y + arm.y[i] - base.y[i], p.z + arm.z[i] - base.z[i]);
        let along = x * (v.x + (w.y * arm.z[i] - w.z * arm.y[i]))
            + y * (v.y + (w.z * arm.x[i] - w.x * arm.z[i]))
            + z * (v.z + (w.x * arm.y[i] - w.y * arm.x[i]));
        let length = (x * x + y * y + z * z).sqrt();
        legs.length[i] = length;
        legs.velocity[i] = along / length.max(SHORTEST);
    }
    legs
}

/// Accelerations of the legs' lengths \[m/s2\] for a motion of the platform.
pub fn leg_accelerations(geometry: &Geometry, motion: &PlatformMotion) -> [f64; 6] {
    std::array::from_fn(|i| {
        let arm = motion.orientation.rotation * geometry.platform.joint(i);
        let leg = motion.position + arm - geometry.base.joint(i);
        let length = leg.norm().max(SHORTEST);
        let direction = leg / length;
        let velocity = motion.velocity + motion.angular_velocity.cross(&arm);
        let acceleration = motion.acceleration
            + tangential(motion.angular_acceleration, arm)
            + centripetal(motion.angular_velocity, arm);
        let rate = direction.dot(&velocity);
        // The part of the joint's velocity across the leg turns it, which lengthens it as well.
        direction.dot(&acceleration) + (velocity.norm_squared() - rate * rate) / length
    })
}

/// Lengths of the legs in a pose.
pub fn leg_lengths(geometry: &Geometry, pose: &Pose) -> [f64; 6] {
    std::array::from_fn(|i| {
        (pose.position + pose.orientation.rotation * geometry.platform.joint(i) - geometry.base.joint(i)).norm()
    })
}

/// The six legs with their accelerations \[m/s2\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegMotion {
    pub length: [f64; 6],
    pub velocity: [f64; 6],
    pub acceleration: [f64; 6],
}

/// Lengths, rates and accelerations of the legs for a motion of the platform.
pub fn leg_motion(geometry: &Geometry, motion: &PlatformMotion) -> LegMotion {
    let Legs { length, velocity } = inverse_kinematics(geometry, motion);
    LegMotion { length, velocity, acceleration: leg_accelerations(geometry, motion) }
}
