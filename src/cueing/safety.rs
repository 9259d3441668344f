//! The safety units: surge, sway and heave are what is wanted as long as that keeps the limits, and follow it within them
//! when it does not.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::interface::SafetyParameters;
use crate::motion::Motions;
use crate::motion::braking_law::{CATCH_UP_SHARE, FULL_SHARE, Limits, REJOIN_DISTANCE, REJOIN_SHARE, ROUNDING};

/// One safety unit for each axis of the base frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SafetyUnits {
    /// The longest step that may ever be taken \[s\].
    longest_step: f64,
    motion: Motions,
    /// Whether the motion is not the wanted one, on each axis.
    acting: [bool; 3],
    /// The last step \[s\] and the way made in it \[m\].
    last_step: f64,
    last_way: Vector3<f64>,
}

impl Limits {
    /// The limits of one axis about neutral.
    pub fn safety(parameters: &SafetyParameters, axis: usize, longest_step: f64) -> Self {
        let SafetyParameters { position_limit, velocity_limit, acceleration_limit } = parameters;
        Limits::symmetric(position_limit[axis], velocity_limit[axis], acceleration_limit[axis], longest_step)
    }
}

impl SafetyUnits {
    /// At rest at neutral, not acting.
    pub fn new(longest_step: f64) -> Self {
        SafetyUnits {
            longest_step,
            motion: Motions::default(),
            acting: [false; 3],
            last_step: 0.0,
            last_way: Vector3::zeros(),
        }
    }

    /// The motion now.
    pub fn motion(&self) -> &Motions {
        &self.motion
    }

    /// Whether a unit acted in the last step.
    pub fn acting(&self) -> bool {
        self.acting.contains(&true)
    }

    /// Advances by one step at whose end the motion `wanted` is.
    pub fn advance(&mut self, wanted: &Motions, limits: &SafetyParameters, step: f64) {
        let next = if !self.acting() && self.may_all_be(wanted, limits, step) {
            *wanted
        } else {
            self.followed(wanted, limits, step)
        };
        self.last_way = next.position - self.motion.position;
        self.last_step = step;
        self.motion = next;
    }

    /// Axis by axis: the wanted motion where it keeps the limits, and what comes nearest to it where it does not.
    fn followed(&mut self, wanted: &Motions, limits: &SafetyParameters, step: f64) -> Motions {
        for k in 0..3 {
            self.acting[k] = !self.may_be(k, wanted, limits, step);
        }
        Motions::from_axes(|k| {
            let target = wanted.axis(k);
            if !self.acting[k] {
                return target;
            }
            let limits = Limits::safety(limits, k, self.longest_step);
            limits.follow(&self.motion.axis(k), &target, CATCH_UP_SHARE * limits.acceleration, step)
        })
    }

    /// Whether all three can be what is wanted, if none has been acting.
    fn may_all_be(&self, wanted: &Motions, limits: &SafetyParameters, step: f64) -> bool {
        let mut may = true;
        for k in 0..3 {
            may &= self.keeps_limits(k, wanted, limits, FULL_SHARE, step);
        }
        may
    }

    /// Whether the motion on this axis at the step's end can be the wanted one.
    fn may_be(&self, k: usize, wanted: &Motions, limits: &SafetyParameters, step: f64) -> bool {
        if !self.acting[k] {
            return self.keeps_limits(k, wanted, limits, FULL_SHARE, step);
        }
        let near = REJOIN_DISTANCE * limits.acceleration_limit[k] * step * step;
        let expected = self.motion.position[k] + 0.5 * (self.motion.velocity[k] + wanted.velocity[k]) * step;
        (wanted.position[k] - expected).abs() <= near && self.keeps_limits(k, wanted, limits, REJOIN_SHARE, step)
    }

    /// Whether the wanted motion keeps the limits at the step's end, can stop before them, and is reached within them:
    /// with this share of the acceleration limit for the change of velocity; and for whoever sees positions only, in its
    /// mean velocity, and in the change of that from one step to the next. Where a wanted velocity jumps within a step,
    /// its values at the steps' ends do not tell.
    fn keeps_limits(&self, k: usize, wanted: &Motions, limits: &SafetyParameters, share: f64, step: f64) -> bool {
        let (farthest, fastest) = (limits.position_limit[k], limits.velocity_limit[k]);
        let most = limits.acceleration_limit[k];
        let (position, velocity) = (wanted.position[k], wanted.velocity[k]);
        let speed = velocity.abs();
        // The braking distance v^2/(2 a) + v h/2 of `approach_velocity`, without its division.
        let ahead = farthest - position * 1.0_f64.copysign(velocity);
        let half_change = 0.5 * most * step;
        let (way, both) = (position - self.motion.position[k], step + self.last_step);
        let mut keeps = position.abs() <= farthest;
        keeps &= speed <= fastest;
        keeps &= wanted.acceleration[k].abs() <= most;
        keeps &= speed * (speed + most * self.longest_step) <= 2.0 * most * ahead;
        keeps &= (velocity - self.motion.velocity[k]).abs() <= share * most * step;
        keeps &= way.abs() <= fastest * step + ROUNDING;
        // The mean velocities way/step, multiplied by both steps.
        keeps &=
            (way * self.last_step - self.last_way[k] * step).abs() <= (half_change * self.last_step + ROUNDING) * both;
        // Leaves room for the step after, which may have to brake.
        keeps & ((velocity * step - way).abs() <= half_change * step + ROUNDING)
    }
}
