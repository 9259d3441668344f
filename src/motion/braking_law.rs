//! The braking law: follows a target without exceeding a limit of position, velocity or
//! acceleration, whatever the target does.
//!
//! One law serves the safety units, the actuator guard and the tilt tracker. The law rests on one
//! function, [`approach_velocity`]: the velocity from which one can still stop within a distance.
//! The acceleration is constant over a step. Position and velocity at the steps' ends are therefore
//! exact, and determine the motion between them.

use serde::{Deserialize, Serialize};

use crate::interface::SafetyParameters;
use crate::motion::Motion;
use crate::motion::min_max::{max, min};
use crate::motion::square_root::square_root;

/// Limits of a motion along a line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    pub min: f64,
    pub max: f64,
    pub velocity: f64,
    pub acceleration: f64,
    /// The longest step that may ever be taken \[s\]. Steps may differ: there must be room to brake
    /// in the next one, however long it is.
    pub max_step: f64,
}

impl Limits {
    /// The same limits on both sides of zero.
    pub fn symmetric(position: f64, velocity: f64, acceleration: f64, max_step: f64) -> Self {
        Limits { min: -position, max: position, velocity, acceleration, max_step }
    }

    /// The platform's limits of one axis about neutral.
    pub fn safety(parameters: &SafetyParameters, axis: usize, max_step: f64) -> Self {
        let SafetyParameters { position_limit, velocity_limit, acceleration_limit } = parameters;
        Limits::symmetric(position_limit[axis], velocity_limit[axis], acceleration_limit[axis], max_step)
    }

    /// The motion after one step towards a target. At the step's end the target is at
    /// `target.position` and has `target.velocity`. Catching up uses an acceleration of at most
    /// `catch_up`. The limits hold whatever the target.
    ///
    /// If the motion is already outside its limits (they may have been lowered), it comes back
    /// inside as fast as the acceleration limit allows.
    #[inline(always)]
    pub fn follow(&self, motion: &Motion, target: &Motion, catch_up: f64, step: f64) -> Motion {
        let Motion { position, velocity, .. } = *motion;
        let behind = target.position - position - 0.5 * (velocity + target.velocity) * step;
        let demanded = target.velocity + approach_velocity(behind, catch_up, self.braking_step(step));
        self.at_velocity(motion, demanded, step)
    }

    /// The motion after one step, with this velocity demanded at its end. The limits hold whatever
    /// the demand, as in [`Limits::follow`].
    #[inline(always)]
    pub fn at_velocity(&self, motion: &Motion, demanded: f64, step: f64) -> Motion {
        let Motion { position, velocity, .. } = *motion;
        let next = self.nearest_velocity(motion, demanded, step);
        let arrived = position + 0.5 * velocity * step + 0.5 * next * step;
        // The law keeps the limits but for rounding, which this removes. Where a limit was lowered onto a
        // motion that cannot stop within it, the motion brakes beyond it: a stop at it would be a blow.
        let inside = (self.min..=self.max).contains(&position);
        let kept = arrived.clamp(self.min, self.max);
        let is_rounding = (arrived - kept).abs() <= REJOIN_TOLERANCE * self.acceleration * step * step;
        Motion {
            position: if inside && is_rounding { kept } else { arrived },
            velocity: next,
            acceleration: ((next - velocity) / step).clamp(-self.acceleration, self.acceleration),
        }
    }

    /// The velocity nearest to the demanded one that a motion can have after one step and
    /// still keep the limits.
    pub fn nearest_velocity(&self, motion: &Motion, demanded: f64, step: f64) -> f64 {
        let Motion { position, velocity, .. } = *motion;
        // Where the step would end if the velocity at its end were zero; each metre per second adds half a step.
        let coasted = position + 0.5 * velocity * step;
        let braking_step = self.braking_step(step);
        let fastest = min(approach_velocity(self.max - coasted, self.acceleration, braking_step), self.velocity);
        let slowest = max(approach_velocity(self.min - coasted, self.acceleration, braking_step), -self.velocity);
        let change = self.acceleration * step;
        max(min(demanded, fastest), slowest).clamp(velocity - change, velocity + change)
    }

    /// The step that [`approach_velocity`] needs where the one after this may be longer.
    fn braking_step(&self, step: f64) -> f64 {
        0.5 * (step + self.max_step)
    }
}

/// Velocity w at a step's end that leads to a stop in time: w^2/(2 a) + w h = `distance`.
///
/// `distance` is what would be left at the step's end if the velocity there were zero; a is the
/// acceleration and h the step. The first term is the braking distance, v = sqrt(2 a x). The
/// second is what the step itself covers. With it the law lands without overshoot in discrete
/// time: near the end the law demands distance/h. Along it the deceleration never exceeds a, since
/// sqrt(v^2 + (a h)^2) - a h >= v - a h. Where the next step may be longer, h is the mean of this
/// step and the longest.
pub fn approach_velocity(distance: f64, acceleration: f64, step: f64) -> f64 {
    let per_step = acceleration * step;
    let magnitude = square_root(per_step * per_step + 2.0 * acceleration * distance.abs()) - per_step;
    magnitude.copysign(distance)
}

/// A motion that has caught up joins its target when it is at most this times a h^2 away from where
/// its velocity takes it. Here a is the acceleration limit and h the step. Such a distance is far
/// below what can be measured.
pub const REJOIN_TOLERANCE: f64 = 0.01;
/// Factor on a limit that allows for rounding.
pub const WITH_ROUNDING: f64 = 1.0 + 1e-9;
/// Largest rounding error of a difference of positions \[m\].
pub const ROUNDING: f64 = f64::EPSILON;
/// Fraction of the acceleration that catching up uses; the rest is for the
/// target's own acceleration.
pub const CATCH_UP_FRACTION: f64 = 0.5;
