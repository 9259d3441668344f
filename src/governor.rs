//! The braking law: follow a target, and never exceed a position, velocity or acceleration limit, whatever it does.
//!
//! One law serves the safety units, the actuator guard and the tilt tracker. It rests on one function,
//! [`approach_velocity`]: the velocity from which one can still stop within a distance. Over a step the acceleration is
//! constant, so position and velocity at the steps' ends are exact and nothing happens between them unseen.

use serde::{Deserialize, Serialize};

/// Position, velocity and acceleration of something that moves along a line, in SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    pub position: f64,
    pub velocity: f64,
    pub acceleration: f64,
}

impl Motion {
    /// At rest at this position.
    pub fn at_rest(position: f64) -> Self {
        Motion { position, velocity: 0.0, acceleration: 0.0 }
    }
}

/// What a motion may not exceed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    pub min: f64,
    pub max: f64,
    pub velocity: f64,
    pub acceleration: f64,
}

impl Limits {
    /// The same limits on both sides of zero.
    pub fn symmetric(position: f64, velocity: f64, acceleration: f64) -> Self {
        Limits { min: -position, max: position, velocity, acceleration }
    }

    /// Whether `target` keeps the limits and can be reached by a change of velocity that does, within `share` of the
    /// acceleration limit, from a velocity of `from` in one step.
    fn allow(&self, from: f64, target: &Motion, share: f64, step: f64) -> bool {
        let velocity = target.velocity;
        let braking = velocity.abs() * (0.5 * velocity.abs() / self.acceleration + 0.5 * step);
        velocity.abs() <= self.velocity
            && target.acceleration.abs() <= self.acceleration
            && (velocity - from).abs() <= share * self.acceleration * step
            && target.position <= self.max
            && target.position >= self.min
            && (velocity <= 0.0 || target.position + braking <= self.max)
            && (velocity >= 0.0 || target.position - braking >= self.min)
    }

    /// The motion after one step towards a target that is at `target.position` at the step's end and has
    /// `target.velocity`, catching up with at most `catch_up` of acceleration. The limits hold whatever the target.
    ///
    /// If the motion is already outside its limits (they may have been lowered), it comes back inside as fast as the
    /// acceleration limit allows.
    pub fn follow(&self, motion: &Motion, target: &Motion, catch_up: f64, step: f64) -> Motion {
        let Motion { position, velocity, .. } = *motion;
        // Where the step would end if the velocity at its end were zero; each metre per second adds half a step.
        let coasted = position + 0.5 * velocity * step;
        let behind = target.position - coasted - 0.5 * target.velocity * step;
        let wanted = target.velocity + approach_velocity(behind, catch_up, step);
        let fastest = approach_velocity(self.max - coasted, self.acceleration, step).min(self.velocity);
        let slowest = approach_velocity(self.min - coasted, self.acceleration, step).max(-self.velocity);
        let change = self.acceleration * step;
        let next = wanted.min(fastest).max(slowest).clamp(velocity - change, velocity + change);
        let arrived = coasted + 0.5 * next * step;
        let inside = (self.min..=self.max).contains(&position);
        Motion {
            // The law keeps the limits but for rounding; this removes the rounding.
            position: if inside { arrived.clamp(self.min, self.max) } else { arrived },
            velocity: next,
            acceleration: ((next - velocity) / step).clamp(-self.acceleration, self.acceleration),
        }
    }
}

/// The velocity to have at the end of this step, if at its end `distance` would be left at zero velocity, so as to stop
/// there: w with w^2/(2 a) + w h = distance.
///
/// The first term is the braking distance, v = sqrt(2 a x); the second is what the step itself covers and what makes
/// the law land without overshoot in discrete time: near the end it asks for distance/h, and along it the
/// deceleration never exceeds a, since sqrt(v^2 + (a h)^2) - a h >= v - a h.
pub fn approach_velocity(distance: f64, acceleration: f64, step: f64) -> f64 {
    let per_step = acceleration * step;
    let magnitude = (per_step * per_step + 2.0 * acceleration * distance.abs()).sqrt() - per_step;
    magnitude.copysign(distance)
}

/// A motion that is the target itself while that keeps the limits, and follows it within them while it does not.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Governor {
    pub motion: Motion,
    /// Whether the motion is not the target's.
    pub acting: bool,
}

/// A governor that has caught up takes the target over again at this share of what one step at the acceleration limit
/// covers: far below what can be measured, and inside the share of the limit that [`REJOIN_SHARE`] leaves.
const REJOIN_DISTANCE: f64 = 0.01;
const REJOIN_SHARE: f64 = 0.95;
/// Allows a change of velocity to reach the limit but for rounding.
const FULL_SHARE: f64 = 1.0 + 1e-9;
/// Catching up uses half the acceleration; the other half is for the target's own.
const CATCH_UP_SHARE: f64 = 0.5;

impl Governor {
    /// At rest at this position, not acting.
    pub fn at_rest(position: f64) -> Self {
        Governor { motion: Motion::at_rest(position), acting: false }
    }

    /// Advances by one step at whose end the target's motion is `target`.
    pub fn advance(&mut self, target: &Motion, limits: &Limits, step: f64) {
        let from = self.motion.velocity;
        let joined = if self.acting {
            let expected = self.motion.position + 0.5 * (from + target.velocity) * step;
            let near = REJOIN_DISTANCE * limits.acceleration * step * step;
            (target.position - expected).abs() <= near && limits.allow(from, target, REJOIN_SHARE, step)
        } else {
            limits.allow(from, target, FULL_SHARE, step)
        };
        self.acting = !joined;
        self.motion = if joined {
            *target
        } else {
            limits.follow(&self.motion, target, CATCH_UP_SHARE * limits.acceleration, step)
        };
    }
}
