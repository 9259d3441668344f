//! Soft limits that change in motion.
//!
//! Pace, margin and looser limits of position go to new values at a bounded rate, because the
//! acceleration at a limit follows them. Tighter limits of position are in force at once, as those
//! of the safety units are.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::interface::{Parameters, SafetyParameters, SoftLimitParameters};
use crate::motion::min_max::{max, min};

/// The parameters in force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SoftLimitGlide {
    soft_limit: SoftLimitParameters,
    position_limit: Vector3<f64>,
}

/// Relative rate of the pace \[1/s\]: from one end of its usual range to the other in 2 s.
const PACE_RATE: f64 = 1.5;
/// Rate of the margin and of the limits of position \[m/s\]: at the default
/// pace, 5 m/s3 at a limit.
const POSITION_RATE: f64 = 0.2;
/// Slowest pace but none \[rad/s\].
const MIN_PACE: f64 = 1e-3;

impl SoftLimitGlide {
    /// At these parameters.
    pub fn at(parameters: &Parameters) -> Self {
        let SafetyParameters { position_limit, velocity_limit: _, acceleration_limit: _ } = parameters.safety;
        SoftLimitGlide { soft_limit: parameters.soft_limit, position_limit }
    }

    /// True if the parameters in force are these.
    #[inline(always)]
    pub fn is_at(&self, parameters: &Parameters) -> bool {
        self.soft_limit == parameters.soft_limit && self.position_limit == parameters.safety.position_limit
    }

    /// The parameters with what is in force of the soft limits'.
    pub fn in_force(&self, parameters: &Parameters) -> Parameters {
        let safety = SafetyParameters { position_limit: self.position_limit, ..parameters.safety };
        Parameters { soft_limit: self.soft_limit, safety, ..*parameters }
    }

    /// Puts limits of position that are tighter into force.
    pub fn tighten(&mut self, parameters: &SafetyParameters) {
        self.position_limit = self.position_limit.inf(&parameters.position_limit);
    }

    /// The parameters in force `step` seconds later, on the way to these. The soft limits are
    /// switched off only while they are `idle`.
    pub fn after(&self, parameters: &Parameters, idle: bool, step: f64) -> Self {
        let SoftLimitParameters { pace, margin } = parameters.soft_limit;
        let before = self.soft_limit;
        let factor = 1.0 + PACE_RATE * step;
        let pace = match (before.pace, pace) {
            (_, 0.0) if idle => 0.0,
            (now, 0.0) => now,
            (now, target) if now < MIN_PACE || target < MIN_PACE => target,
            (now, target) => max(min(target, now * factor), now / factor),
        };
        let way = POSITION_RATE * step;
        let margin = max(min(margin, before.margin + way), before.margin - way);
        // Beyond the actuators' length no limit is reached.
        let far = parameters.rig.farthest_joint();
        let position_limit = self.position_limit.zip_map(&parameters.safety.position_limit, |now, target| {
            if now >= far { target } else { min(target, now + way) }
        });
        SoftLimitGlide { soft_limit: SoftLimitParameters { pace, margin }, position_limit }
    }

    /// True if a limit is approached more slowly than with the others.
    pub fn is_gentler_than(&self, other: &Self) -> bool {
        let (soft_limit, before) = (self.soft_limit, other.soft_limit);
        soft_limit.pace > 0.0
            && (before.pace == 0.0 || soft_limit.pace < before.pace || soft_limit.margin > before.margin)
    }
}
