//! The braking law: follow a target, and never exceed a position, velocity or acceleration
//! limit, whatever it does.
//!
//! One law serves the safety units, the actuator guard and the tilt tracker. It rests on one
//! function, [`approach_velocity`]: the velocity from which one can still stop within a distance.
//! Over a step the acceleration is constant, so position and velocity at the steps' ends are exact
//! and nothing happens between them unseen.

use serde::{Deserialize, Serialize};

use crate::motion::Motion;
use crate::motion::extremes::{max, min};

/// Limits of a motion along a line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    pub min: f64,
    pub max: f64,
    pub velocity: f64,
    pub acceleration: f64,
    /// The longest step that may ever be taken \[s\]: steps may differ, and whatever the next one
    /// is, there must be room to brake in it.
    pub longest_step: f64,
}

impl Limits {
    /// The same limits on both sides of zero.
    pub fn symmetric(position: f64, velocity: f64, acceleration: f64, longest_step: f64) -> Self {
        Limits { min: -position, max: position, velocity, acceleration, longest_step }
    }

    /// The motion after one step towards a target that is at `target.position` at the step's end
    /// and has `target.velocity`, catching up with at most `catch_up` of acceleration. The limits
    /// hold whatever the target.
    ///
    /// If the motion is already outside its limits (they may have been lowered), it comes back
    /// inside as fast as the acceleration limit allows.
    #[inline(always)]
    pub fn follow(&self, motion: &Motion, target: &Motion, catch_up: f64, step: f64) -> Motion {
        let Motion { position, velocity, .. } = *motion;
        let behind = target.position - position - 0.5 * (velocity + target.velocity) * step;
        let demanded = target.velocity + approach_velocity(behind, catch_up, self.reserve(step));
        self.at_velocity(motion, demanded, step)
    }

    /// The motion after one step at whose end this velocity is demanded. The limits hold whatever
    /// it is, as in [`Limits::follow`].
    #[inline(always)]
    pub fn at_velocity(&self, motion: &Motion, demanded: f64, step: f64) -> Motion {
        let Motion { position, velocity, .. } = *motion;
        let next = self.nearest_velocity(motion, demanded, step);
        let arrived = position + 0.5 * velocity * step + 0.5 * next * step;
        let inside = (self.min..=self.max).contains(&position);
        Motion {
            // The law keeps the limits but for rounding; this removes the rounding.
            position: if inside { arrived.clamp(self.min, self.max) } else { arrived },
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
        let reserve = self.reserve(step);
        let fastest = min(approach_velocity(self.max - coasted, self.acceleration, reserve), self.velocity);
        let slowest = max(approach_velocity(self.min - coasted, self.acceleration, reserve), -self.velocity);
        let change = self.acceleration * step;
        max(min(demanded, fastest), slowest).clamp(velocity - change, velocity + change)
    }

    /// The step that [`approach_velocity`] needs where the one after this may be longer.
    fn reserve(&self, step: f64) -> f64 {
        0.5 * (step + self.longest_step)
    }
}

/// The velocity to have at the end of this step, if at its end `distance` would be left at zero
/// velocity, so as to stop there: w with w^2/(2 a) + w h = distance.
///
/// The first term is the braking distance, v = sqrt(2 a x); the second is what the step itself
/// covers and what makes the law land without overshoot in discrete time: near the end it asks for
/// distance/h, and along it the deceleration never exceeds a, since sqrt(v^2 + (a h)^2) - a h >=
/// v - a h. Where the next step may be longer, h is the mean of this step and the longest.
pub fn approach_velocity(distance: f64, acceleration: f64, step: f64) -> f64 {
    let per_step = acceleration * step;
    let magnitude = (per_step * per_step + 2.0 * acceleration * distance.abs()).sqrt() - per_step;
    magnitude.copysign(distance)
}

/// A motion that has caught up joins its target when it is this fraction of what one step at the
/// acceleration limit covers away from where its velocity takes it: far below what can be measured.
pub const REJOIN_DISTANCE: f64 = 0.01;
/// Factor of a limit that may be reached but for rounding.
pub const WITH_ROUNDING: f64 = 1.0 + 1e-9;
/// Largest rounding error of a difference of positions \[m\].
pub const ROUNDING: f64 = f64::EPSILON;
/// Catching up uses half the acceleration; the other half is for the target's own.
pub const CATCH_UP_FRACTION: f64 = 0.5;
