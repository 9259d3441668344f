//! Soft limits: the platform approaches a limit like a critically damped system, long before the
//! safety units or the actuator guard would have to brake.
//!
//! For surge, sway, heave and the six legs' lengths, or cranks' arcs, q in \[lo, hi\] the
//! acceleration towards hi is kept within
//!
//! ```text
//!     q''  <=  psi(p (hi - m - q) - q') - p q'
//! ```
//!
//! with the pace p and the margin m, and likewise towards lo. The bound is a control barrier
//! function of relative degree two. p (hi - m - q) is the largest velocity, and psi the
//! acceleration towards it. The acceleration ends gently, because psi grows with the pace at first,
//! and then like a root (`GentleSlope`).
//!
//! A leg's acceleration is affine in the platform's. Where a demand leaves these ranges, it is
//! replaced by the nearest accelerations of all six coordinates. The ranges change continuously
//! with the motion, so a smooth demand stays smooth.

pub mod glide;
pub mod nearest;
mod relaxation;
#[cfg(test)]
mod tests;

use nalgebra::{SMatrix, Vector3};
use serde::{Deserialize, Serialize};
use wide::{CmpGe, f64x2};

use self::nearest::{Accelerations, ActingRows, ROW_COUNT, RowValues, Rows, nearest_accelerations};
use self::relaxation::Relaxation;
use crate::interface::{Parameters, SafetyParameters, SoftLimitParameters};
use crate::motion::Motion;
use crate::motion::min_max::{max, min};
use crate::motion::orientation::{RollPitchYaw, RotationalMotion};
use crate::motion::square_root::square_root;
use crate::platform::reach::{clear_stroke, neutral_lengths, pace_within_stroke, short_stroke_factor};
use crate::platform::{Geometry, PlatformCoordinates, PlatformMotion, PlatformState, accelerations_with_jacobian};

/// The soft limits with their state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SoftLimits {
    geometry: Geometry,
    neutral_height: f64,
    pace: f64,
    axis_limits: [ApproachLimits; 3],
    leg_limits: ApproachLimits,
    /// The same of surge and sway, of heave twice, and of two legs.
    axis_pairs: [ApproachLimitPair; 2],
    leg_pair: ApproachLimitPair,
    /// The part of the relaxation for which the clearance at neutral suffices.
    relaxation_fraction: f64,
    /// The rows that acted in the last step.
    acting_rows: ActingRows,
    relaxation: Relaxation,
}

/// Weights of the changed accelerations' squares: of surge, sway and heave, and
/// of the angles \[m2\].
const CHANGE_WEIGHTS: [f64; 6] = [1.0, 1.0, 2.0, 2.0, 2.0, 2.0];
/// Fraction of a limit of acceleration that demands may use.
const ACCELERATION_FRACTION: f64 = 0.95;
/// Rate at which a limit of velocity is approached \[1/s\].
const VELOCITY_PACE: f64 = 25.0;
/// Largest slope of the acceleration on the way to a limit of velocity \[m/s3\]. Together with the
/// next one it keeps the jolt of a smooth motion below 0.7 m/s2 within 20 ms.
const VELOCITY_SLOPE: f64 = 25.0;
/// Largest slope of psi on the way to a limit of position \[m/s3\].
const POSITION_SLOPE: f64 = 15.0;
/// A function of the clearance: `pace` times the clearance at first, and then a root, so that
/// the function times its derivative is at most `slope`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct GentleSlope {
    pace: f64,
    slope: f64,
}

impl GentleSlope {
    /// The function's value where the root begins.
    fn knee(self) -> f64 {
        self.slope / self.pace
    }

    #[inline(always)]
    fn value(self, clearance: f64) -> f64 {
        let (linear, knee) = (self.pace * clearance, self.knee());
        if linear <= knee { linear } else { square_root(2.0 * self.slope * clearance - knee * knee) }
    }
}

/// A quantity's limits of position, velocity and acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct ApproachLimits {
    min: f64,
    max: f64,
    velocity: f64,
    acceleration: f64,
    /// Distances from neutral to `min` and to `max`.
    neutral_clearance: [f64; 2],
}

impl ApproachLimits {
    /// The limits of a quantity that is between `neutral[0]` and `neutral[1]` at neutral. At either
    /// end the margin takes at most half the clearance at neutral. No velocity is larger than
    /// what the acceleration can brake at this pace.
    fn new([min, max]: [f64; 2], neutral: [f64; 2], velocity: f64, acceleration: f64, margin: f64, pace: f64) -> Self {
        let clearance = [neutral[0] - min, max - neutral[1]].map(|clearance| self::max(clearance, 0.0));
        let [below, above] = clearance.map(|clearance| self::min(margin, 0.5 * clearance));
        ApproachLimits {
            min: min + below,
            max: max - above,
            velocity: if pace > 0.0 { self::min(velocity, acceleration / pace) } else { velocity },
            acceleration: ACCELERATION_FRACTION * acceleration,
            neutral_clearance: [clearance[0] - below, clearance[1] - above],
        }
    }

    /// True if a motion towards a limit ends before it at this pace, or is no
    /// faster than `slow_speed`.
    fn stops_in_time(&self, position: f64, velocity: f64, pace: f64, slow_speed: f64) -> bool {
        velocity <= max(pace * (self.max - position), slow_speed)
            && -velocity <= max(pace * (position - self.min), slow_speed)
    }

    /// The least and the largest acceleration with which the limits are approached at this pace.
    #[inline(always)]
    fn range(&self, position: f64, velocity: f64, pace: f64) -> (f64, f64) {
        let approach = GentleSlope { pace, slope: POSITION_SLOPE };
        let to_velocity = GentleSlope { pace: VELOCITY_PACE, slope: VELOCITY_SLOPE };
        // Towards an end, `clearance` before it, at the velocity `towards`.
        let largest = |clearance: f64, towards: f64| {
            let by_position = approach.value(pace * clearance - towards) - pace * towards;
            min(by_position, to_velocity.value(self.velocity - towards))
        };
        let (upper, lower) = (largest(self.max - position, velocity), -largest(position - self.min, -velocity));
        let most = self.acceleration;
        let upper = max(min(upper, most), -most);
        (min(max(lower, -most), upper), upper)
    }
}

/// The limits of two quantities side by side, as [`ApproachLimits::range`] has them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct ApproachLimitPair {
    middle: f64x2,
    /// Half the range of position, times the pace.
    by_position: f64x2,
    /// The limit of velocity.
    by_velocity: f64x2,
    acceleration: f64x2,
}

impl ApproachLimitPair {
    fn of(ends: [ApproachLimits; 2], pace: f64) -> Self {
        let two = |value: &dyn Fn(&ApproachLimits) -> f64| f64x2::new(ends.each_ref().map(value));
        ApproachLimitPair {
            middle: two(&|ends| 0.5 * (ends.min + ends.max)),
            by_position: two(&|ends| pace * 0.5 * (ends.max - ends.min)),
            by_velocity: two(&|ends| ends.velocity),
            acceleration: two(&|ends| ends.acceleration),
        }
    }

    /// In each lane, whether this acceleration is within [`ApproachLimits::range`].
    #[inline(always)]
    fn is_within(&self, position: f64x2, velocity: f64x2, acceleration: f64x2, pace: f64) -> f64x2 {
        // The inverses of psi: beside the linear part the square of what is beyond the knee. Where signs
        // differ the square belongs to the other end, and this is stricter than `ApproachLimits::range`.
        let beyond = |value: f64x2, knee: f64, slope: f64| {
            let beyond = (value.abs() - f64x2::splat(knee)).max(f64x2::ZERO);
            beyond * beyond * (0.5 / slope)
        };
        let damped = acceleration + velocity * pace;
        let to_position = damped * (1.0 / pace) + velocity + (position - self.middle) * pace;
        let to_velocity = acceleration * (1.0 / VELOCITY_PACE) + velocity;
        let by_position = to_position.abs() + beyond(damped, POSITION_SLOPE / pace, POSITION_SLOPE);
        let by_velocity = to_velocity.abs() + beyond(acceleration, VELOCITY_SLOPE / VELOCITY_PACE, VELOCITY_SLOPE);
        self.by_position.cmp_ge(by_position)
            & self.by_velocity.cmp_ge(by_velocity)
            & self.acceleration.cmp_ge(acceleration.abs())
    }
}

impl SoftLimits {
    /// The soft limits for these parameters. The strategy wants at most `heave` \[m\]: the
    /// predictive one little, the others any.
    pub fn new(parameters: &Parameters, heave: f64) -> Self {
        let Parameters { safety, soft_limit, rig, .. } = parameters;
        let SafetyParameters { position_limit, velocity_limit, acceleration_limit } = safety;
        let SoftLimitParameters { pace, margin } = *soft_limit;
        let (margin, pace) = (margin * short_stroke_factor(rig), pace_within_stroke(pace, rig));
        let farthest = |k: usize| if k == 2 { min(position_limit[k], heave) } else { position_limit[k] };
        let geometry = Geometry::from(rig);
        let axes = [0, 1, 2].map(|k: usize| {
            let ends = [-farthest(k), farthest(k)];
            ApproachLimits::new(ends, [0.0; 2], velocity_limit[k], acceleration_limit[k], margin, pace)
        });
        let neutral = neutral_lengths(&geometry, rig.neutral_height);
        let leg =
            ApproachLimits::new(clear_stroke(rig), neutral, rig.velocity_limit, rig.acceleration_limit, margin, pace);
        SoftLimits {
            geometry,
            neutral_height: rig.neutral_height,
            pace,
            axis_limits: axes,
            leg_limits: leg,
            axis_pairs: [[axes[0], axes[1]], [axes[2]; 2]].map(|ends| ApproachLimitPair::of(ends, pace)),
            leg_pair: ApproachLimitPair::of([leg; 2], pace),
            relaxation_fraction: Relaxation::fraction_within(
                axes.iter()
                    .chain([&leg])
                    .fold(f64::INFINITY, |least, ends| ends.neutral_clearance.into_iter().fold(least, min)),
            ),
            acting_rows: ActingRows::default(),
            relaxation: Relaxation::default(),
        }
    }

    /// Changes the limits; their relaxation goes on.
    pub fn retune(&mut self, parameters: &Parameters, heave: f64) {
        let SoftLimits { acting_rows, relaxation, .. } = *self;
        *self = SoftLimits { acting_rows, relaxation, ..SoftLimits::new(parameters, heave) };
    }

    /// Ends the action of all rows, where the demand passes by the soft limits.
    pub fn release(&mut self) {
        (self.acting_rows, self.relaxation) = Default::default();
    }

    /// True unless they are switched off.
    pub fn enabled(&self) -> bool {
        self.pace > 0.0
    }

    /// True if the demand was changed in the last step.
    pub fn limited(&self) -> bool {
        self.acting_rows.any()
    }

    /// True if axes and legs come to rest before their limits at this part of the pace. Those up to
    /// `slow_speed` \[m/s\] do anyway.
    pub fn stops_in_time(&self, state: &PlatformState, part: f64, slow_speed: f64) -> bool {
        let pace = part * self.pace;
        let linear = &state.coordinates.linear;
        let axes =
            (0..3).all(|k| self.axis_limits[k].stops_in_time(linear.position[k], linear.velocity[k], pace, slow_speed));
        axes && (0..6)
            .all(|i| self.leg_limits.stops_in_time(state.legs.position[i], state.legs.velocity[i], pace, slow_speed))
    }

    /// The demand at the step's end, changed so that it approaches no limit faster than it may.
    /// None if it need not be changed. `state` is that of the step's start. The limits relax by
    /// the surge and sway that make up for the tilt.
    #[inline(always)]
    pub fn apply(
        &mut self,
        demand: &PlatformState,
        state: &PlatformState,
        tilt_compensation: &Vector3<f64>,
        step: f64,
    ) -> Option<PlatformCoordinates> {
        if !self.relaxation.acts() && self.is_within_ranges(demand, state, step) {
            return None;
        }
        self.relaxation = self.relaxation.accelerated(&(self.relaxation_fraction * tilt_compensation));
        let limited = self.limited_demand(&demand.coordinates, state, step);
        self.relaxation = limited.map_or(Relaxation::default(), |_| self.relaxation.after(step));
        limited
    }

    /// True if the mean accelerations of axes and legs over the step are within their ranges.
    #[inline(always)]
    fn is_within_ranges(&self, demand: &PlatformState, state: &PlatformState, step: f64) -> bool {
        let per_step = 1.0 / step;
        let (after, before) = (&demand.coordinates.linear.velocity, &state.coordinates.linear);
        let two = |values: &[f64], [i, j]: [usize; 2]| f64x2::new([values[i], values[j]]);
        let axes = |k: usize, pair: [usize; 2]| {
            let velocity = two(before.velocity.as_slice(), pair);
            let acceleration = (two(after.as_slice(), pair) - velocity) * per_step;
            self.axis_pairs[k].is_within(two(before.position.as_slice(), pair), velocity, acceleration, self.pace)
        };
        let of_legs = |pair: [usize; 2]| {
            let velocity = two(&state.legs.velocity, pair);
            let acceleration = (two(&demand.legs.velocity, pair) - velocity) * per_step;
            self.leg_pair.is_within(two(&state.legs.position, pair), velocity, acceleration, self.pace)
        };
        let within = axes(0, [0, 1]) & axes(1, [2, 2]) & of_legs([0, 1]) & of_legs([2, 3]) & of_legs([4, 5]);
        within.move_mask() == 0b11
    }

    #[cold]
    fn limited_demand(
        &mut self,
        demand: &PlatformCoordinates,
        state: &PlatformState,
        step: f64,
    ) -> Option<PlatformCoordinates> {
        let PlatformCoordinates { linear, angles } = &state.coordinates;
        let change = (demand.linear.velocity - linear.velocity) / step;
        let turn = (demand.angles.velocity - angles.velocity) / step;
        let demanded = Accelerations::new(change.x, change.y, change.z, turn.x, turn.y, turn.z);
        let rows = self.rows(state);
        let inverse_weights = Accelerations::from(CHANGE_WEIGHTS.map(|weight| 1.0 / weight));
        let nearest = nearest_accelerations(&demanded, &inverse_weights, &rows, &mut self.acting_rows);
        if !self.acting_rows.any() {
            return None;
        }
        let after = |motion: &Motion<Vector3<f64>>, k: usize| {
            motion.at_velocity(motion.velocity + step * Vector3::new(nearest[k], nearest[k + 1], nearest[k + 2]), step)
        };
        Some(PlatformCoordinates { linear: after(linear, 0), angles: after(angles, 3) })
    }

    /// The ranges of the accelerations. A leg's acceleration is J c plus the terms of velocities.
    fn rows(&self, state: &PlatformState) -> Rows {
        let PlatformCoordinates { linear, angles } = &state.coordinates;
        let coasting = PlatformCoordinates {
            linear: Motion { acceleration: Vector3::zeros(), ..*linear },
            angles: Motion { acceleration: Vector3::zeros(), ..*angles },
        };
        let turning = RotationalMotion::new(&coasting.angles);
        let motion = PlatformMotion::new(&coasting.linear, &turning, self.neutral_height);
        let (remaining, jacobian) = accelerations_with_jacobian(&self.geometry, &motion);
        // The columns of eq. (10): angular velocities of unit rates.
        let of_rates = SMatrix::<f64, 3, 3>::from_columns(
            &[Vector3::x(), Vector3::y(), Vector3::z()]
                .map(|rates| turning.orientation.angular_velocity(RollPitchYaw::from_vector(rates))),
        );
        let by_angles = jacobian.fixed_columns::<3>(3) * of_rates;
        let mut normals = SMatrix::<f64, ROW_COUNT, 6>::zeros();
        normals.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        normals.fixed_view_mut::<6, 3>(3, 0).copy_from(&jacobian.fixed_columns::<3>(0));
        normals.fixed_view_mut::<6, 3>(3, 3).copy_from(&by_angles);
        let (mut lower, mut upper) = (RowValues::zeros(), RowValues::zeros());
        let range = |row: usize, ends: &ApproachLimits, motion: [f64; 2]| {
            let direction = normals.fixed_view::<1, 3>(row, 0).transpose();
            self.relaxation.range(ends, motion, &direction, self.pace)
        };
        for k in 0..3 {
            (lower[k], upper[k]) = range(k, &self.axis_limits[k], [linear.position[k], linear.velocity[k]]);
        }
        for i in 0..6 {
            let (least, most) = range(3 + i, &self.leg_limits, [state.legs.position[i], state.legs.velocity[i]]);
            (lower[3 + i], upper[3 + i]) = (least - remaining[i], most - remaining[i]);
        }
        Rows { normals, lower, upper }
    }
}
