//! The braking law: follow a target, and never exceed a position, velocity or acceleration limit, whatever it does.
//!
//! One law serves the safety units, the actuator guard and the tilt tracker. It rests on one function,
//! [`approach_velocity`]: the velocity from which one can still stop within a distance. Over a step the acceleration is
//! constant, so position and velocity at the steps' ends are exact and nothing happens between them unseen.

use std::ops::Add;

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

impl Add for Motion {
    type Output = Motion;

    fn add(self, other: Motion) -> Motion {
        Motion {
            position: self.position + other.position,
            velocity: self.velocity + other.velocity,
            acceleration: self.acceleration + other.acceleration,
        }
    }
}

/// What a motion may not exceed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    pub min: f64,
    pub max: f64,
    pub velocity: f64,
    pub acceleration: f64,
    /// The longest step that may ever be taken \[s\]: steps may differ, and whatever the next one is, there must be room
    /// to brake in it.
    pub longest_step: f64,
}

impl Limits {
    /// The same limits on both sides of zero.
    pub fn symmetric(position: f64, velocity: f64, acceleration: f64, longest_step: f64) -> Self {
        Limits { min: -position, max: position, velocity, acceleration, longest_step }
    }

    /// Whether one can move as in `target` and still brake in time.
    fn allow(&self, target: &Motion) -> bool {
        let Motion { position, velocity, acceleration } = *target;
        let ahead = if velocity > 0.0 { self.max - position } else { position - self.min };
        // The braking distance v^2/(2 a) + v h/2 of `approach_velocity`, without its division.
        let can_stop = velocity.abs() * (velocity.abs() + self.acceleration * self.longest_step)
            <= 2.0 * self.acceleration * ahead;
        velocity.abs() <= self.velocity
            && acceleration.abs() <= self.acceleration
            && (self.min..=self.max).contains(&position)
            && can_stop
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
        let reserve = 0.5 * (step + self.longest_step);
        let wanted = target.velocity + approach_velocity(behind, catch_up, reserve);
        let fastest = approach_velocity(self.max - coasted, self.acceleration, reserve).min(self.velocity);
        let slowest = approach_velocity(self.min - coasted, self.acceleration, reserve).max(-self.velocity);
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
/// deceleration never exceeds a, since sqrt(v^2 + (a h)^2) - a h >= v - a h. Where the next step may be longer, h is the
/// mean of this step and the longest.
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
    /// The last step \[s\] and the way made in it \[m\].
    last_step: f64,
    last_way: f64,
}

/// A governor that has caught up takes the target over again at this share of what one step at the acceleration limit
/// covers: far below what can be measured, and inside the share of the limit that [`REJOIN_SHARE`] leaves.
const REJOIN_DISTANCE: f64 = 0.01;
const REJOIN_SHARE: f64 = 0.95;
/// Allows a change of velocity to reach the limit but for rounding.
const FULL_SHARE: f64 = 1.0 + 1e-9;
/// What rounding may add to a difference of positions \[m\].
const ROUNDING: f64 = 1e-14;
/// Catching up uses half the acceleration; the other half is for the target's own.
const CATCH_UP_SHARE: f64 = 0.5;

impl Governor {
    /// At rest at this position, not acting.
    pub fn at_rest(position: f64) -> Self {
        Governor { motion: Motion::at_rest(position), acting: false, last_step: 0.0, last_way: 0.0 }
    }

    /// Advances by one step at whose end the target's motion is `target`.
    #[inline(always)]
    pub fn advance(&mut self, target: &Motion, limits: &Limits, step: f64) {
        let joined = self.may_be(target, limits, step);
        let next = if joined {
            *target
        } else {
            limits.follow(&self.motion, target, CATCH_UP_SHARE * limits.acceleration, step)
        };
        self.acting = !joined;
        self.last_way = next.position - self.motion.position;
        self.last_step = step;
        self.motion = next;
    }

    /// Whether the motion at the step's end can be the target's.
    #[inline(always)]
    fn may_be(&self, target: &Motion, limits: &Limits, step: f64) -> bool {
        let Motion { position, velocity, .. } = self.motion;
        let near = REJOIN_DISTANCE * limits.acceleration * step * step;
        let expected = position + 0.5 * (velocity + target.velocity) * step;
        let caught_up = !self.acting || (target.position - expected).abs() <= near;
        let share = if self.acting { REJOIN_SHARE } else { FULL_SHARE };
        caught_up
            && limits.allow(target)
            && (target.velocity - velocity).abs() <= share * limits.acceleration * step
            && self.may_travel(target, limits, step)
    }

    /// Whether the way to the target's position keeps the limits for whoever sees positions only: its mean velocity, and
    /// the change of that from one step to the next. Where a target's velocity jumps within a step, its velocities at
    /// the steps' ends do not tell.
    fn may_travel(&self, target: &Motion, limits: &Limits, step: f64) -> bool {
        let way = target.position - self.motion.position;
        let both = step + self.last_step;
        let half_change = 0.5 * limits.acceleration * step;
        way.abs() <= limits.velocity * step + ROUNDING
            // The mean velocities way/step, multiplied by both steps.
            && (way * self.last_step - self.last_way * step).abs() <= (half_change * self.last_step + ROUNDING) * both
            // Leaves room for the step after, which may have to brake.
            && (target.velocity * step - way).abs() <= half_change * step + ROUNDING
    }
}
