//! The certificate: proof that a transition, and a stop plan after it, keep every
//! limit at every instant.
//!
//! A transition goes from position q0 and velocity u0 to q1 and u1 in a step h. The transition
//! stands for a trajectory with the steady acceleration c = (u1 - u0)/h, and a gap d = q1 -
//! q0 - (u0 + u1) h/2 at its end. The gap counts as an acceleration of 2 |d|/h². Limits that
//! hold on the trajectory with this added also hold for the differences of the positions and
//! velocities at the steps' ends.

use nalgebra::Vector3;

use super::bounds::JointBounds;
use super::certifier::{Certifier, STOP_FRACTION, Speed, sum_of_magnitudes};
use super::cranks::JointLimits;
use crate::interface::SafetyParameters;
use crate::motion::Motion;
use crate::motion::braking_law::{ROUNDING, WITH_ROUNDING};
use crate::motion::min_max::{max, min};
use crate::platform::inverse::{LegMotion, leg_motion};
use crate::platform::stop_plan::{StopDurations, StopPlan};
use crate::platform::{PlatformCoordinates, PlatformMotion, PlatformState};

/// Stop plans are divided into cells. The bound on what happens between two points is about this
/// fraction of the acceleration limit.
const CELL_ACCELERATION_FRACTION: f64 = 0.05;
/// Number of cells into which a stop plan is divided at most; rounding up in its four
/// pieces makes at most 15.
const MOST_CELLS: f64 = 12.0;

impl Certifier {
    /// Duration of a certified stop from the candidate, if bounds on the transition and the stop
    /// are enough to certify it. No point between is evaluated.
    ///
    /// No joint moves farther from the present state than (stop duration/2 + step) times the
    /// largest speed in the transition.
    #[inline(always)]
    pub fn certify_by_bounds(
        &self,
        from: &PlatformState,
        to: &PlatformState,
        safety: &SafetyParameters,
        step: f64,
    ) -> Option<f64> {
        match &self.geometry.cranks {
            None => self.certify_within::<false>(&self.joint_limits_of_legs(), from, to, safety, step),
            Some(cranks) => self.certify_cranks_by_bounds(cranks, from, to, safety, step),
        }
    }

    /// As [`Certifier::certify_by_bounds`], if bounds also certify the way home from where the stop
    /// ends.
    #[inline(always)]
    pub fn certify_home_by_bounds(
        &self,
        from: &PlatformState,
        to: &PlatformState,
        safety: &SafetyParameters,
        step: f64,
    ) -> Option<f64> {
        if let Some(cranks) = &self.geometry.cranks {
            return self.certify_cranks_home_by_bounds(cranks, from, to, safety, step);
        }
        let duration = self.certify_within::<false>(&self.joint_limits_of_legs(), from, to, safety, step)?;
        self.has_way_home_by_bounds(to, duration).then_some(duration)
    }

    /// The same as [`Certifier::certify_by_bounds`] with these limits of the joints; the
    /// transmission matters with cranks alone.
    #[inline(always)]
    pub(super) fn certify_within<const CRANKS: bool>(
        &self,
        joint_limits: &JointLimits,
        from: &PlatformState,
        to: &PlatformState,
        safety: &SafetyParameters,
        step: f64,
    ) -> Option<f64> {
        let SafetyParameters { position_limit, velocity_limit, acceleration_limit } = safety;
        let (now, next) = (&from.coordinates, &to.coordinates);
        let per_step = 1.0 / step;
        let gap_factor = 2.0 * per_step * per_step;
        let (change, gap) = change_and_gap(&now.linear, &next.linear, step);
        let (turn, angle_gap) = change_and_gap(&now.angles, &next.angles, step);
        let gap_acceleration = gap_factor * (sum_of_magnitudes(&gap) + sum_of_magnitudes(&angle_gap) * self.radius);
        let (before, speed) = (Speed::of(now), Speed::of(next));
        let rate = max(speed.angular, before.angular);
        let joint_speed = speed.of_joints(self.radius);
        let fastest = max(joint_speed, before.of_joints(self.radius)) + 0.5 * step * gap_acceleration;
        let curvature = fastest * fastest / joint_limits.turning_length + rate * rate * self.radius;
        // The gap turns the legs a little as well, which changes their rates.
        let gap_turning = 0.5 * step * gap_acceleration * (fastest / joint_limits.turning_length + rate);
        let steady = change.norm() * per_step
            + sum_of_magnitudes(&turn) * per_step * self.radius
            + gap_acceleration
            + gap_turning;
        let mut duration = joint_speed * joint_limits.stop_time_per_speed;
        for k in 0..3 {
            let speed = next.linear.velocity[k].abs();
            if speed >= acceleration_limit[k] * duration {
                duration = speed / acceleration_limit[k];
            }
        }
        let time = 0.5 * duration + step;
        let reach = fastest * time;

        let [least, greatest] = to.legs.extremes();
        let moved = if CRANKS { reach / joint_limits.transmission } else { reach };
        let rates_comply = || {
            let [linear, angular] = [change.norm() * per_step, sum_of_magnitudes(&turn) * per_step];
            let bounds =
                JointBounds { velocity: fastest, ..JointBounds::new([fastest, rate], [linear, angular], self.radius) };
            let gap = (gap_acceleration + 2.0 * gap_turning) / joint_limits.transmission;
            let rates = [&from.legs.velocity, &to.legs.velocity];
            self.rates_comply_with_acceleration_limit(joint_limits, rates, &bounds, gap, step)
        };
        let legs_comply = curvature <= (1.0 - STOP_FRACTION) * joint_limits.acceleration
            && (curvature + steady <= joint_limits.acceleration || CRANKS && rates_comply())
            && fastest <= joint_limits.velocity
            && least - moved >= self.limits.min
            && greatest + moved <= self.limits.max
            && (!CRANKS || reach <= joint_limits.travel);
        let axis_complies = |k: usize| {
            let most = acceleration_limit[k];
            let ends = max(next.linear.velocity[k].abs(), now.linear.velocity[k].abs());
            let fastest = ends + per_step * gap[k].abs();
            change[k].abs() * per_step + gap_factor * gap[k].abs() <= most
                && next.linear.acceleration[k].abs() <= most
                && fastest <= velocity_limit[k]
                && next.linear.position[k].abs() + fastest * time <= position_limit[k]
        };
        (legs_comply && (0..3).all(axis_complies)).then_some(duration)
    }

    /// A certified stop plan from the candidate, if the transition to it is certified as well.
    #[cold]
    pub fn certify(
        &self,
        from: &PlatformState,
        to: &PlatformState,
        safety: &SafetyParameters,
        step: f64,
    ) -> Option<StopPlan> {
        let cranks = self.geometry.cranks.as_ref();
        // Bounds cost least and certify nearly every candidate of legs. With cranks they are left
        // for what neither ends nor cells certify.
        let by_bounds = || {
            let duration = self.certify_by_bounds(from, to, safety, step)?;
            Some(StopPlan::new(&to.coordinates, StopDurations::common(duration)))
        };
        if cranks.is_none()
            && let Some(plan) = by_bounds()
        {
            return Some(plan);
        }
        let certified = axes_comply_with_limits(&from.coordinates, &to.coordinates, safety, step);
        let plan = if certified { self.stop_plan(to, safety) } else { None }?;
        let complies = cranks.is_some_and(|cranks| self.ends_certify_stop(cranks, from, to, &plan, step))
            || self.transition_complies_with_leg_limits(from, to, step) && self.plan_complies_with_leg_limits(&plan);
        if complies { Some(plan) } else { cranks.and_then(|_| by_bounds()) }
    }

    /// The stop from the candidate within the safety limits. All coordinates stop in one
    /// duration that suits the fastest leg and the safety limits of acceleration. An axis with
    /// less clearance stops sooner.
    pub(super) fn stop_plan(&self, to: &PlatformState, safety: &SafetyParameters) -> Option<StopPlan> {
        let Motion { position, velocity, .. } = to.coordinates.linear;
        let fastest_leg = to.legs.velocity.iter().fold(0.0, |fastest, velocity| max(velocity.abs(), fastest));
        let duration = (0..3).fold(fastest_leg * self.stop_time_per_speed, |duration, k| {
            max(velocity[k].abs() / safety.acceleration_limit[k], duration)
        });
        let mut durations = StopDurations::common(duration);
        for k in 0..3 {
            let speed = velocity[k].abs();
            // From the candidate on: one that is back inside a tightened limit stays inside.
            let (lowest, highest) = reachable(&to.coordinates, safety, k);
            let clearance = if velocity[k] >= 0.0 { highest - position[k] } else { position[k] - lowest };
            // At rest, the quotient is infinite or no number.
            durations.linear[k] = min(2.0 * clearance / speed, duration);
            let brakes = speed <= safety.acceleration_limit[k] * WITH_ROUNDING * durations.linear[k];
            if !(brakes && clearance >= 0.0) {
                return None;
            }
        }
        Some(StopPlan::new(&to.coordinates, durations))
    }

    /// True if the legs keep speed and acceleration at every instant of the transition. Their
    /// lengths need no check: both ends are inside the stroke by the margin.
    fn transition_complies_with_leg_limits(&self, from: &PlatformState, to: &PlatformState, step: f64) -> bool {
        let (now, next) = (&from.coordinates, &to.coordinates);
        let (linear, angles) =
            (Transition::new(&now.linear, &next.linear, step), Transition::new(&now.angles, &next.angles, step));
        let start = PlatformCoordinates { linear: linear.start, angles: angles.start };
        let end = PlatformCoordinates { linear: linear.end, angles: angles.end };
        let left = leg_motion(&self.geometry, &PlatformMotion::turning(&from.motion, &start));
        let right = self.leg_motion_of(&end);
        let (before, after) = (Speed::of(now), Speed::of(next));
        let speeds = [max(before.linear, after.linear), max(before.angular, after.angular)];
        let accelerations = [linear.start.acceleration.norm(), sum_of_magnitudes(&angles.start.acceleration)];
        let bounds = JointBounds::new(speeds, accelerations, self.radius);
        // The gap at the end as accelerations: one from lengths, one from rates.
        let rounding = ROUNDING / right.transmission;
        let gaps = core::array::from_fn(|i| {
            let length = without_rounding(to.legs.position[i] - right.position[i], rounding).abs();
            let rate = without_rounding(to.legs.velocity[i] - right.velocity[i], rounding).abs();
            2.0 * length / (step * step) + rate / step
        });
        self.interval_complies_with_leg_limits(&left, &right, &bounds, step, (f64::NEG_INFINITY, f64::INFINITY), &gaps)
    }

    /// True if the legs keep stroke, speed and acceleration all the way to rest.
    fn plan_complies_with_leg_limits(&self, plan: &StopPlan) -> bool {
        let stops = plan.durations().breakpoints();
        let duration = stops[3];
        let speed = Speed::of(plan.start()).of_joints(self.radius);
        // Between points d apart the bound is about 1.5 (G1²/L) d/T.
        let joint_limits = self.joint_limits(self.transmission_at(plan.start()));
        let needed = 1.5 * speed * speed
            / (joint_limits.turning_length * CELL_ACCELERATION_FRACTION * joint_limits.acceleration);
        let whole = libm::ceil(needed).clamp(1.0, MOST_CELLS);
        if duration <= 0.0 {
            // At rest already.
            let start = self.leg_motion_of(plan.start());
            let least = self.geometry.cranks.map_or(0.0, |cranks| cranks.least_transmission);
            return start.transmission >= least
                && start.position.iter().all(|length| (self.limits.min..=self.limits.max).contains(length));
        }
        let mut begin = 0.0;
        for end in stops {
            let cells = libm::ceil(whole * ((end - begin) / duration));
            if cells != 0.0 && !self.piece_complies_with_leg_limits(plan, begin, end, cells) {
                return false;
            }
            begin = end;
        }
        true
    }

    /// True if the legs keep their limits between two breakpoints of a plan, divided into cells.
    fn piece_complies_with_leg_limits(&self, plan: &StopPlan, begin: f64, end: f64, cells: f64) -> bool {
        let accelerating = plan.at(begin);
        let (linear, angles) = (accelerating.linear.acceleration, accelerating.angles.acceleration);
        let at = |time: f64| {
            let mut coordinates = plan.at(time);
            (coordinates.linear.acceleration, coordinates.angles.acceleration) = (linear, angles);
            (self.leg_motion_of(&coordinates), Speed::of(&coordinates))
        };
        let cell = (end - begin) / cells;
        let (mut left, mut speed) = at(begin);
        for k in 1..=cells as usize {
            let time = if k as f64 == cells { end } else { begin + k as f64 * cell };
            let (right, speed_after) = at(time);
            // Every coordinate decelerates: a cell is fastest at its start.
            let bounds = JointBounds::new(
                [speed.linear, speed.angular],
                [linear.norm(), sum_of_magnitudes(&angles)],
                self.radius,
            );
            let stroke = (self.limits.min, self.limits.max);
            if !self.interval_complies_with_leg_limits(&left, &right, &bounds, cell, stroke, &[0.0; 6]) {
                return false;
            }
            (left, speed) = (right, speed_after);
        }
        true
    }

    /// True if the legs keep their limits in an interval in which the coordinates' accelerations
    /// are steady. The legs' motion at both ends decides. `gaps` are accelerations that each leg
    /// needs besides \[m/s2\].
    ///
    /// No instant is farther than half the interval d from the nearer end, and the leg's jerk J is
    /// bounded. The acceleration therefore differs from that end's by at most J d/2. Speed and
    /// length follow by integration from that end.
    pub(super) fn interval_complies_with_leg_limits(
        &self,
        left: &LegMotion,
        right: &LegMotion,
        bounds: &JointBounds,
        interval: f64,
        (shortest, longest): (f64, f64),
        gaps: &[f64; 6],
    ) -> bool {
        let half = 0.5 * interval;
        let least = |lengths: &[f64; 6]| lengths.iter().fold(f64::INFINITY, |a, &b| a.min(b));
        let spread = match &self.geometry.cranks {
            None => {
                let length = least(&left.position).min(least(&right.position)) - bounds.velocity * half;
                if length.is_nan() || length <= 0.0 {
                    return false;
                }
                bounds.leg_jerk(length) * half
            }
            Some(cranks) => match cranks.spread(bounds, [left, right], interval) {
                Some(spread) => spread,
                None => return false,
            },
        };
        let mut complies = true;
        for (i, gap) in gaps.iter().enumerate() {
            let acceleration = max(left.acceleration[i].abs(), right.acceleration[i].abs()) + spread;
            let from_left = left.velocity[i] + left.acceleration[i] * half;
            let from_right = right.velocity[i] - right.acceleration[i] * half;
            let at_ends = max(left.velocity[i].abs(), right.velocity[i].abs());
            let speed = max(at_ends, max(from_left.abs(), from_right.abs()) + spread * half);
            let beyond = 0.5 * acceleration * half * half;
            complies &= acceleration + gap <= self.limits.acceleration;
            complies &= speed + gap * half <= self.limits.velocity;
            complies &= left.position[i].min(right.position[i]) - beyond >= shortest;
            complies &= left.position[i].max(right.position[i]) + beyond <= longest;
        }
        complies
    }

    pub(super) fn leg_motion_of(&self, coordinates: &PlatformCoordinates) -> LegMotion {
        leg_motion(&self.geometry, &coordinates.motion(self.neutral_height))
    }
}

/// The trajectory of three coordinates over a step, without the gap at its end.
struct Transition {
    start: Motion<Vector3<f64>>,
    end: Motion<Vector3<f64>>,
    gap: Vector3<f64>,
}

impl Transition {
    fn new(now: &Motion<Vector3<f64>>, next: &Motion<Vector3<f64>>, step: f64) -> Self {
        let (change, gap) = change_and_gap(now, next, step);
        let acceleration = change / step;
        Transition {
            start: Motion { acceleration, ..*now },
            end: Motion { position: next.position - gap, velocity: next.velocity, acceleration },
            gap: gap.map(|gap| without_rounding(gap, ROUNDING)),
        }
    }
}

/// True if surge, sway and heave keep their safety limits at every instant of the transition: on
/// the trajectory, which ends a gap before the candidate, and at the candidate.
pub fn axes_comply_with_limits(
    from: &PlatformCoordinates,
    to: &PlatformCoordinates,
    safety: &SafetyParameters,
    step: f64,
) -> bool {
    let SafetyParameters { position_limit: _, velocity_limit, acceleration_limit } = safety;
    let (now, next) = (&from.linear, &to.linear);
    let Transition { start, end, gap } = Transition::new(now, next, step);
    let mut complies = true;
    for k in 0..3 {
        let (before, after) = (now.velocity[k], next.velocity[k]);
        let gap = gap[k].abs();
        let turned = turning_point(now.position[k], before, after, start.acceleration[k]);
        let most = acceleration_limit[k] * WITH_ROUNDING;
        complies &= start.acceleration[k].abs() + 2.0 * gap / (step * step) <= most;
        complies &= next.acceleration[k].abs() <= most;
        // Beyond a tightened limit an axis may become slower, not faster.
        let fastest = max(velocity_limit[k] * WITH_ROUNDING, before.abs());
        complies &= max(before.abs(), after.abs()) + gap / step <= fastest;
        let (lowest, highest) = reachable(from, safety, k);
        let (arrived, shown) = (end.position[k], next.position[k]);
        complies &= lowest <= min(min(arrived, shown), turned) && max(max(arrived, shown), turned) <= highest;
    }
    complies
}

/// The lowest and the highest position that an axis may have from now on. Beyond its limit it may
/// come nearer to neutral, but not go farther.
fn reachable(from: &PlatformCoordinates, safety: &SafetyParameters, k: usize) -> (f64, f64) {
    const ROUNDING: f64 = 4.0 * f64::EPSILON;
    let (position, limit) = (from.linear.position[k], safety.position_limit[k]);
    let rounding = ROUNDING * max(position.abs(), limit);
    (min(position, -limit) - rounding, max(position, limit) + rounding)
}

/// The position at which a steady acceleration turns the velocity round between these
/// two, or the first one.
fn turning_point(position: f64, before: f64, after: f64, acceleration: f64) -> f64 {
    if before * after < 0.0 { position - 0.5 * before * before / acceleration } else { position }
}

/// Change of velocity over a step, and what the positions' difference has beyond the mean
/// velocity times the step.
#[inline(always)]
pub(super) fn change_and_gap(
    now: &Motion<Vector3<f64>>,
    next: &Motion<Vector3<f64>>,
    step: f64,
) -> (Vector3<f64>, Vector3<f64>) {
    let gap = next.position - now.position - (now.velocity + next.velocity) * (0.5 * step);
    (next.velocity - now.velocity, gap)
}

/// A difference of positions without what rounding may have added.
fn without_rounding(gap: f64, rounding: f64) -> f64 {
    if gap.is_nan() { gap } else { (gap.abs() - rounding).max(0.0).copysign(gap) }
}

#[cfg(test)]
mod tests {
    use super::turning_point;

    #[test]
    fn velocity_turns_round_between_opposite_ones_alone() {
        // v^2/(2a) beyond the start.
        assert_eq!(turning_point(1.0, 2.0, -1.0, -4.0), 1.5);
        assert_eq!(turning_point(-1.0, -2.0, 1.0, 4.0), -1.5);
        // The end of an interval is looked at for itself.
        for (before, after) in [(2.0, 0.0), (-2.0, 0.0), (2.0, 1.0), (-2.0, -1.0), (0.0, -1.0), (0.0, 1.0)] {
            assert_eq!(turning_point(1.0, before, after, 4.0), 1.0, "{before} and {after} m/s");
        }
    }
}
