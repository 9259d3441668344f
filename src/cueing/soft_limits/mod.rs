//! Soft limits: the platform approaches a limit like a critically damped system, long before the
//! safety units or the actuator guard would have to brake.
//!
//! For surge, sway, heave and the six legs' lengths q in \[lo, hi\] the acceleration is kept within
//!
//! ```text
//!     -p^2 (q - lo - m) - 2 p q'  <=  q''  <=  p^2 (hi - m - q) - 2 p q'
//! ```
//!
//! with the pace p and the margin m, an exponential control barrier function of relative degree two.
//! A leg's acceleration is affine in the platform's. Where a demand leaves these ranges, it is
//! replaced by the [`nearest`] accelerations of all six coordinates. The ranges change continuously
//! with the motion, so a smooth demand stays smooth.

pub mod nearest;
#[cfg(test)]
mod tests;

use nalgebra::{SMatrix, Vector3};
use serde::{Deserialize, Serialize};

use self::nearest::{Accelerations, ROWS, RowValues, Rows, Sides, nearest};
use crate::interface::{Rig, SafetyParameters, SoftLimitParameters};
use crate::motion::Motion;
use crate::motion::min_max::{max, min};
use crate::motion::orientation::{RollPitchYaw, RotationalMotion};
use crate::platform::{Geometry, Legs, PlatformCoordinates, PlatformMotion, jacobian, leg_accelerations};

/// The soft limits with their state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SoftLimits {
    geometry: Geometry,
    neutral_height: f64,
    /// The rows that acted in the last step.
    sides: Sides,
    inverse_weights: Accelerations,
}

/// The state and the limits that the ranges follow from.
#[derive(Clone, Copy)]
pub struct Limited<'a> {
    pub parameters: &'a SoftLimitParameters,
    pub safety: &'a SafetyParameters,
    pub rig: &'a Rig,
    /// The largest heave that the strategy wants \[m\].
    pub heave: f64,
    /// The platform's coordinates and its legs at the step's start.
    pub coordinates: &'a PlatformCoordinates,
    pub legs: &'a Legs,
}

/// Weights of the changed accelerations' squares: surge, sway, heave, and the angles \[m2\].
const WEIGHTS: [f64; 6] = [1.0, 1.0, 10.0, 2.0, 2.0, 2.0];
/// Fraction of a limit of acceleration that demands may use.
const ACCELERATION: f64 = 0.95;
/// Rate at which a limit of velocity is approached \[1/s\].
const VELOCITY_PACE: f64 = 25.0;

/// A quantity's limits of position, velocity and acceleration.
#[derive(Clone, Copy)]
struct Ends {
    min: f64,
    max: f64,
    velocity: f64,
    acceleration: f64,
}

impl Ends {
    fn new([min, max]: [f64; 2], velocity: f64, acceleration: f64, margin: f64) -> Self {
        let margin = self::min(margin, 0.25 * (max - min));
        Ends { min: min + margin, max: max - margin, velocity, acceleration: ACCELERATION * acceleration }
    }

    /// The least and the largest acceleration with which the limits are approached at this pace.
    #[inline(always)]
    fn range(&self, position: f64, velocity: f64, pace: f64) -> (f64, f64) {
        let damped = 2.0 * pace * velocity;
        let by_position = pace * pace;
        let upper = min(by_position * (self.max - position) - damped, VELOCITY_PACE * (self.velocity - velocity));
        let lower = max(by_position * (self.min - position) - damped, -VELOCITY_PACE * (self.velocity + velocity));
        let most = self.acceleration;
        let upper = max(min(upper, most), -most);
        (min(max(lower, -most), upper), upper)
    }
}

impl SoftLimits {
    /// The soft limits of a rig.
    pub fn new(rig: &Rig) -> Self {
        SoftLimits {
            geometry: Geometry::from(rig),
            neutral_height: rig.neutral_height,
            sides: Sides::default(),
            inverse_weights: Accelerations::from(WEIGHTS.map(|weight| 1.0 / weight)),
        }
    }

    /// True if the demand was changed in the last step.
    pub fn active(&self) -> bool {
        self.sides.any()
    }

    /// The demand at the step's end, changed so that it approaches no limit faster than it may. None
    /// if it need not be changed. `legs` are the demanded ones.
    #[inline(always)]
    pub fn soften(
        &mut self,
        demand: &PlatformCoordinates,
        legs: &Legs,
        limited: &Limited,
        step: f64,
    ) -> Option<PlatformCoordinates> {
        if limited.keep(demand, legs, step) {
            self.sides = Sides::default();
            return None;
        }
        self.softened(demand, limited, step)
    }

    #[cold]
    fn softened(&mut self, demand: &PlatformCoordinates, limited: &Limited, step: f64) -> Option<PlatformCoordinates> {
        let PlatformCoordinates { linear, angles } = limited.coordinates;
        let change = (demand.linear.velocity - linear.velocity) / step;
        let turn = (demand.angles.velocity - angles.velocity) / step;
        let demanded = Accelerations::new(change.x, change.y, change.z, turn.x, turn.y, turn.z);
        let rows = self.rows(limited);
        let nearest = nearest(&demanded, &self.inverse_weights, &rows, &mut self.sides);
        if !self.sides.any() {
            return None;
        }
        let after = |motion: &Motion<Vector3<f64>>, k: usize| {
            motion.at_velocity(motion.velocity + step * Vector3::new(nearest[k], nearest[k + 1], nearest[k + 2]), step)
        };
        Some(PlatformCoordinates { linear: after(linear, 0), angles: after(angles, 3) })
    }

    /// The ranges of the accelerations. A leg's is J c and what remains without accelerations.
    fn rows(&self, limited: &Limited) -> Rows {
        let PlatformCoordinates { linear, angles } = limited.coordinates;
        let coasting = PlatformCoordinates {
            linear: Motion { acceleration: Vector3::zeros(), ..*linear },
            angles: Motion { acceleration: Vector3::zeros(), ..*angles },
        };
        let turning = RotationalMotion::new(&coasting.angles);
        let motion = PlatformMotion::new(&coasting.linear, &turning, self.neutral_height);
        let remaining = leg_accelerations(&self.geometry, &motion);
        let jacobian = jacobian(&self.geometry, &motion.pose());
        // The columns of eq. (10): angular velocities of unit rates.
        let of_rates = SMatrix::<f64, 3, 3>::from_columns(
            &[Vector3::x(), Vector3::y(), Vector3::z()]
                .map(|rates| turning.orientation.angular_velocity(RollPitchYaw::from_vector(rates))),
        );
        let by_angles = jacobian.fixed_columns::<3>(3) * of_rates;
        let mut normals = SMatrix::<f64, ROWS, 6>::zeros();
        normals.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        normals.fixed_view_mut::<6, 3>(3, 0).copy_from(&jacobian.fixed_columns::<3>(0));
        normals.fixed_view_mut::<6, 3>(3, 3).copy_from(&by_angles);
        let (mut lower, mut upper) = (RowValues::zeros(), RowValues::zeros());
        for row in 0..ROWS {
            let ((least, most), remaining) = match row {
                0..3 => (limited.axis_range(row), 0.0),
                _ => (limited.leg_range(row - 3), remaining[row - 3]),
            };
            (lower[row], upper[row]) = (least - remaining, most - remaining);
        }
        Rows { normals, lower, upper }
    }
}

impl Limited<'_> {
    /// True if the mean accelerations of axes and legs over the step are within their ranges.
    #[inline(always)]
    fn keep(&self, demand: &PlatformCoordinates, legs: &Legs, step: f64) -> bool {
        let mut keep = true;
        for k in 0..3 {
            let (least, most) = self.axis_range(k);
            let change = demand.linear.velocity[k] - self.coordinates.linear.velocity[k];
            keep &= (least * step <= change) & (change <= most * step);
        }
        for i in 0..6 {
            let (least, most) = self.leg_range(i);
            let change = legs.velocity[i] - self.legs.velocity[i];
            keep &= (least * step <= change) & (change <= most * step);
        }
        keep
    }

    #[inline(always)]
    fn axis_range(&self, k: usize) -> (f64, f64) {
        let SafetyParameters { position_limit, velocity_limit, acceleration_limit } = self.safety;
        let farthest = if k == 2 { min(position_limit[k], self.heave) } else { position_limit[k] };
        let ends = Ends::new([-farthest, farthest], velocity_limit[k], acceleration_limit[k], self.parameters.margin);
        ends.range(self.coordinates.linear.position[k], self.coordinates.linear.velocity[k], self.parameters.pace)
    }

    #[inline(always)]
    fn leg_range(&self, i: usize) -> (f64, f64) {
        let Rig { min_length, max_length, velocity_limit, acceleration_limit, .. } = *self.rig;
        let ends = Ends::new([min_length, max_length], velocity_limit, acceleration_limit, self.parameters.margin);
        ends.range(self.legs.length[i], self.legs.velocity[i], self.parameters.pace)
    }
}
