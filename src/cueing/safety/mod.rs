//! The safety units: surge, sway and heave equal their demand as long as it keeps the limits, and
//! follow it within them otherwise.

#[cfg(test)]
mod tests;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use wide::{CmpGe, f64x4};

use crate::interface::SafetyParameters;
use crate::motion::Motion;
use crate::motion::braking_law::{CATCH_UP_FRACTION, Limits, REJOIN_TOLERANCE, ROUNDING, WITH_ROUNDING};
use crate::motion::lanes::lanes;

/// One safety unit for each axis of the base frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SafetyUnits {
    /// The longest step that may ever be taken \[s\].
    max_step: f64,
    motion: Motion<Vector3<f64>>,
    /// True on each axis whose motion is not the demanded one.
    deviating: [bool; 3],
    /// True on each axis that a safety limit keeps from its demand.
    limited: [bool; 3],
}

impl SafetyUnits {
    /// The safety units at rest at neutral, not active.
    pub fn new(max_step: f64) -> Self {
        SafetyUnits { max_step, motion: Motion::default(), deviating: [false; 3], limited: [false; 3] }
    }

    /// The limited motion now.
    pub fn motion(&self) -> &Motion<Vector3<f64>> {
        &self.motion
    }

    /// True if a unit limited the motion in the last step.
    pub fn limited(&self) -> bool {
        self.limited != [false; 3]
    }

    /// True if the motion on an axis is not the demanded one.
    pub fn deviates(&self) -> bool {
        self.deviating != [false; 3]
    }

    /// Continues from the platform's real motion, where that is not the one that the units gave.
    #[cold]
    pub fn continue_from(&mut self, motion: &Motion<Vector3<f64>>) {
        self.motion = *motion;
        self.deviating = [true; 3];
    }

    /// True if the motion is beyond its limits, or could not stop within them:
    /// they have become tighter.
    pub fn beyond_limits(&self, limits: &SafetyParameters) -> bool {
        (0..3).any(|k| self.axis_beyond_limits(k, limits))
    }

    fn axis_beyond_limits(&self, k: usize, limits: &SafetyParameters) -> bool {
        let Motion { position, velocity, .. } = self.motion.axis(k);
        let outward = if velocity.is_sign_negative() { -position } else { position };
        let ahead = limits.position_limit[k] - outward;
        let (speed, most) = (velocity.abs(), limits.acceleration_limit[k]);
        let complies = speed <= limits.velocity_limit[k] && speed * speed <= 2.0 * most * ahead * WITH_ROUNDING;
        !complies
    }

    /// Advances by one step at whose end the motion `demand` is.
    pub fn advance(&mut self, demand: &Motion<Vector3<f64>>, limits: &SafetyParameters, step: f64) {
        let complies = self.complies_with_limits(demand, limits, step);
        self.motion = if self.deviating == [false; 3] && complies == [true; 3] {
            *demand
        } else {
            self.following(demand, complies, limits, step)
        };
    }

    /// Axis by axis: the demanded motion where it keeps the limits, and what comes nearest to
    /// it where it does not.
    #[cold]
    fn following(
        &mut self,
        demand: &Motion<Vector3<f64>>,
        complies: [bool; 3],
        limits: &SafetyParameters,
        step: f64,
    ) -> Motion<Vector3<f64>> {
        for (k, axis_complies) in complies.into_iter().enumerate() {
            let joins = axis_complies && (!self.deviating[k] || self.has_caught_up(k, demand, limits, step));
            // A unit that follows the platform's real motion is active from where that is beyond the limits.
            let limits_it = self.limited[k] || !self.deviating[k] || self.axis_beyond_limits(k, limits);
            self.limited[k] = !joins && limits_it;
            self.deviating[k] = !joins;
        }
        Motion::from_axes(|k| {
            let target = demand.axis(k);
            if !self.deviating[k] {
                return target;
            }
            let limits = Limits::safety(limits, k, self.max_step);
            limits.follow(&self.motion.axis(k), &target, CATCH_UP_FRACTION * limits.acceleration, step)
        })
    }

    /// True if the motion on this axis can join the demanded one. Their positions must differ from
    /// what the velocities account for by at most [`REJOIN_TOLERANCE`] a h², with the limit of
    /// acceleration a and the step h.
    fn has_caught_up(&self, k: usize, demand: &Motion<Vector3<f64>>, limits: &SafetyParameters, step: f64) -> bool {
        let near = REJOIN_TOLERANCE * limits.acceleration_limit[k] * step * step;
        let expected = self.motion.position[k] + 0.5 * (self.motion.velocity[k] + demand.velocity[k]) * step;
        (demand.position[k] - expected).abs() <= near
    }

    /// The axes on which the demand keeps the limits at the step's end, can stop before them, and
    /// is reached within them.
    ///
    /// The gap between the positions' difference and the mean velocity times the step h counts as
    /// an acceleration of 2 gap/h².
    fn complies_with_limits(&self, demand: &Motion<Vector3<f64>>, limits: &SafetyParameters, step: f64) -> [bool; 3] {
        let SafetyParameters { position_limit, velocity_limit, acceleration_limit } = limits;
        let (farthest, fastest, most) = (lanes(position_limit), lanes(velocity_limit), lanes(acceleration_limit));
        let (position, velocity) = (lanes(&demand.position), lanes(&demand.velocity));
        let (position_before, velocity_before) = (lanes(&self.motion.position), lanes(&self.motion.velocity));
        let speed = velocity.abs();
        // The braking distance v^2/(2 a) + v h/2 of `approach_velocity`, without its division.
        let direction = velocity & f64x4::splat(-0.0);
        let ahead = farthest - (position ^ direction);
        let mean = 0.5 * (velocity + velocity_before);
        let change = (velocity - velocity_before).abs();
        let gap = (position - position_before - mean * step).abs();
        let mut complies = farthest.cmp_ge(position.abs());
        complies &= fastest.cmp_ge(speed);
        complies &= (fastest * step * WITH_ROUNDING + ROUNDING).cmp_ge(mean.abs() * step + gap);
        complies &= most.cmp_ge(lanes(&demand.acceleration).abs());
        complies &= (2.0 * most * ahead).cmp_ge(speed * (speed + most * self.max_step));
        complies &= (most * step * step * WITH_ROUNDING + 2.0 * ROUNDING).cmp_ge(change * step + 2.0 * gap);
        let complies = complies.move_mask();
        core::array::from_fn(|k| complies & (1 << k) != 0)
    }
}
