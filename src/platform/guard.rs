//! The actuator guard: stroke, speed and acceleration of each leg are limits of the machine, and no command exceeds them.

use serde::{Deserialize, Serialize};

use super::{Geometry, Legs, PlatformMotion, inverse_kinematics, leg_accelerations, motion_of_legs};
use crate::governor::{Governor, Limits, Motion};
use crate::interface::Rig;

/// The guard with the commanded legs and the motion that the platform makes on them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActuatorGuard {
    geometry: Geometry,
    limits: Limits,
    legs: [Governor; 6],
    motion: PlatformMotion,
}

impl ActuatorGuard {
    /// At rest at neutral; no step will be longer than `longest_step` \[s\].
    pub fn new(rig: &Rig, longest_step: f64) -> Self {
        let geometry = Geometry::from(rig);
        let motion = PlatformMotion::at_rest(super::Pose::neutral(rig));
        let limits = Limits {
            min: rig.min_length,
            max: rig.max_length,
            velocity: rig.velocity_limit,
            acceleration: rig.acceleration_limit,
            longest_step,
        };
        let legs = inverse_kinematics(&geometry, &motion).length.map(Governor::at_rest);
        ActuatorGuard { geometry, limits, legs, motion }
    }

    /// Advances by `step` seconds, at whose end the platform is wanted to move as `wanted`.
    ///
    /// While all legs can follow, the motion is the wanted one and the legs are its inverse kinematics. Otherwise each
    /// leg follows as far as its limits allow, and the motion is the one that the legs really make. If forward
    /// kinematics does not find that (in a rig free of singularities it always does), the legs are still within their
    /// limits and the last pose known is reported.
    pub fn advance(&mut self, wanted: &PlatformMotion, step: f64) {
        let target = inverse_kinematics(&self.geometry, wanted);
        for (i, leg) in self.legs.iter_mut().enumerate() {
            let motion = Motion {
                position: target.length[i],
                velocity: target.velocity[i],
                // Over the step; what it is at an instant within does not move the machine.
                acceleration: (target.velocity[i] - leg.motion.velocity) / step,
            };
            leg.advance(&motion, &self.limits, step);
        }
        self.motion = if self.acting() {
            let accelerations = self.legs.map(|leg| leg.motion.acceleration);
            motion_of_legs(&self.geometry, &self.legs(), &accelerations, &self.motion.pose())
                .unwrap_or_else(|_| PlatformMotion::at_rest(self.motion.pose()))
        } else {
            *wanted
        };
    }

    /// The commanded legs.
    pub fn legs(&self) -> Legs {
        Legs { length: self.legs.map(|leg| leg.motion.position), velocity: self.legs.map(|leg| leg.motion.velocity) }
    }

    /// The accelerations of the commanded legs' lengths \[m/s2\]: over the last step while the guard acts.
    pub fn leg_accelerations(&self) -> [f64; 6] {
        if self.acting() {
            self.legs.map(|leg| leg.motion.acceleration)
        } else {
            leg_accelerations(&self.geometry, &self.motion)
        }
    }

    /// The motion that the platform makes.
    pub fn motion(&self) -> &PlatformMotion {
        &self.motion
    }

    /// Whether a leg was held back in the last step.
    pub fn acting(&self) -> bool {
        self.legs.iter().any(|leg| leg.acting)
    }

    /// The smallest distance of a leg from either end of its stroke \[m\].
    pub fn stroke_margin(&self) -> f64 {
        self.margins().fold(f64::INFINITY, |smallest, (margin, _)| smallest.min(margin))
    }

    /// The time derivative of [`ActuatorGuard::stroke_margin`] \[m/s\].
    pub fn stroke_margin_rate(&self) -> f64 {
        let nearest = self.margins().fold((f64::INFINITY, 0.0), |a, b| if b.0 < a.0 { b } else { a });
        nearest.1
    }

    /// Each leg's distance from each end of its stroke, and the rate of it.
    fn margins(&self) -> impl Iterator<Item = (f64, f64)> {
        self.legs.iter().flat_map(|Governor { motion, .. }| {
            [
                (motion.position - self.limits.min, motion.velocity),
                (self.limits.max - motion.position, -motion.velocity),
            ]
        })
    }
}
