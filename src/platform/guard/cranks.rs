//! What the certificate and the way home need beside the legs' proofs where the
//! actuators are cranks.
//!
//! Let G1, G2, G3 be the bounds on the derivatives of the joints' vectors ([`JointBounds`]), a the
//! arm and s the rod. An arc q with the rod's direction n, the arm's direction o and its tangent t
//! has q' = n·V/k, and the rod's ends move apart at Q = V - t q'. Q is the projection of V along t
//! onto the plane across n. Therefore |Q| is at most |V|/k, as |q'| is. Both |n·o| and the part of
//! t across n are at most c = sqrt(1 - k²). From n·Q = 0 it follows that
//!
//! ```text
//!     k q''  = n·V' + (n·o) q'²/a + |Q|²/s
//!     k q''' = n·V'' + 3 Q·Q'/s + 3 (n·o) q' q''/a + k q'³/a²
//!     k'     = Q·t/s - (n·o) q'/a
//! ```
//!
//! So, while no transmission is smaller than k,
//!
//! ```text
//!     |q'|   <= F1 = G1/k
//!     |q''|  <= F2 = (G2 + c F1²/a + F1²/s)/k
//!     |Q·Q'| <= F1 S2,   S2 = (G2 + F1²/a + c F1²/s)/k
//!     |q'''| <= F3 = (G3 + 3 F1 S2/s + 3 c F1 F2/a)/k + F1³/a²
//!     |k'|   <= c F1 (1/s + 1/a)
//! ```
//!
//! Where |q'| is at most R, which is less than F1, R stands in the place of those F1 that bound q'.
//!
//! k is assumed, and shown afterwards. A transmission is continuous: from a larger value at an end
//! of the piece it cannot fall below k within the piece at that rate.
//!
//! In terms of the joints, F1 and F2 are G1/k and (G2 + G1²/b)/k with a length b, as a leg's are
//! with k = 1 and its length ([`JointLimits`]).

use nalgebra::Vector3;

use super::bounds::JointBounds;
use super::certificate::change_and_gap;
use super::certifier::{Certifier, HOME_MARGIN_FRACTION, STOP_FRACTION, Speed, sum_of_magnitudes};
use super::home::Distance;
use crate::interface::SafetyParameters;
use crate::motion::min_max::{max, min};
use crate::motion::square_root::square_root;
use crate::platform::PlatformState;
use crate::platform::crank::{Arms, Chords, Cranks};
use crate::platform::inverse::LegMotion;
use crate::platform::stop_plan::{StopDurations, StopPlan};

/// The transmission that is assumed, relative to that of a state: what is left is for the motion.
const ASSUMED_PART: f64 = 0.8;
/// Largest turn of an arm within a piece \[rad\]. Angles are within 2 rad from level, so one that
/// is off by a whole turn is at least 2 pi - 4 = 2.28 rad away.
const LARGEST_TURN: f64 = 2.0;

/// The largest cosine of an angle of transmission whose sine is not smaller than this one.
fn cosine_from_sine(transmission: f64) -> f64 {
    square_root(max(1.0 - transmission * transmission, 0.0))
}

/// Limits of the actuators as limits of the joints.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointLimits {
    /// Transmission k that is assumed; 1 with legs.
    pub transmission: f64,
    /// A joint at the speed G turns its actuator as one of this length \[m\]: that adds G²/c to the
    /// joint's acceleration.
    pub turning_length: f64,
    /// Limits of velocity \[m/s\] and acceleration \[m/s2\] of a joint along its rod.
    pub velocity: f64,
    pub acceleration: f64,
    /// Duration of a stop for each m/s of a joint \[s2/m\].
    pub stop_time_per_speed: f64,
    /// Distance of joints within which the transmission stays at what is assumed \[m\].
    pub travel: f64,
}

impl Cranks {
    /// The transmission to be assumed about a state or a piece with this one at its ends.
    fn assumed(&self, transmission: f64) -> f64 {
        max(ASSUMED_PART * transmission, self.least_transmission)
    }

    /// The largest change of a transmission for each metre of a joint's travel \[1/m\].
    pub(super) fn transmission_slope(&self, transmission: f64) -> f64 {
        cosine_from_sine(transmission) / transmission * (1.0 / self.rod + 1.0 / self.arm)
    }

    /// What a joint's speed squared adds to its acceleration, as one over a length \[1/m\].
    pub(super) fn turning(&self, transmission: f64) -> f64 {
        (cosine_from_sine(transmission) / self.arm + 1.0 / self.rod) / (transmission * transmission)
    }

    /// Bound on |q'''| with these bounds of the joints, where no transmission is smaller than this
    /// one, and no |q'| larger than `rate` \[m/s3\].
    pub(super) fn arc_jerk(&self, bounds: &JointBounds, transmission: f64, rate: f64) -> f64 {
        let JointBounds { velocity, acceleration, jerk } = *bounds;
        let (per, cosine) = (1.0 / transmission, cosine_from_sine(transmission));
        let (rod_rate, of_arm) = (velocity * per, rate / self.arm);
        let of_rod = rod_rate / self.rod;
        let second = (acceleration + cosine * rate * of_arm + rod_rate * of_rod) * per;
        let rod_second = (acceleration + rate * of_arm + cosine * rod_rate * of_rod) * per;
        (jerk + 3.0 * (of_rod * rod_second + cosine * of_arm * second)) * per + rate * of_arm * of_arm
    }

    /// The change of the arcs' accelerations within half of an interval between these states, if
    /// every crank keeps its transmission there.
    pub(super) fn spread(&self, bounds: &JointBounds, ends: [&LegMotion; 2], interval: f64) -> Option<f64> {
        let half = 0.5 * interval;
        let rate = ends.iter().flat_map(|legs| legs.velocity).fold(0.0, |most, rate| max(rate.abs(), most));
        let ends = min(ends[0].transmission, ends[1].transmission);
        let transmission = self.assumed(ends);
        let lost = bounds.velocity * half * self.transmission_slope(transmission);
        let turns = bounds.velocity / transmission * interval / self.arm;
        // What is left is no smaller than what was assumed, so it may be assumed in its place.
        let left = ends - lost;
        let rate = self.rate_after(bounds, left, rate, half);
        (left >= transmission && turns <= LARGEST_TURN).then(|| self.arc_jerk(bounds, left, rate) * half)
    }

    /// Bound on |q'| up to `time` seconds away from this one, where no transmission is smaller than
    /// this.
    fn rate_after(&self, bounds: &JointBounds, transmission: f64, rate: f64, time: f64) -> f64 {
        let JointBounds { velocity, acceleration, .. } = *bounds;
        let second = (acceleration + velocity * velocity * self.turning(transmission)) / transmission;
        min(rate + time * second, velocity / transmission)
    }
}

/// True if a function with these values at the ends of a way is nowhere negative on it. Its second
/// derivative is at most 2 `bend`, so it stays above its chord less bend s (1 - s). That parabola
/// has no zero inside if (bend - start - end)² <= 4 start end.
#[inline(always)]
fn is_nowhere_negative([start, end]: [f64; 2], bend: f64) -> bool {
    let missing = max(0.0, bend - start - end);
    (start >= 0.0) & (end >= 0.0) & (missing * missing <= 4.0 * start * end)
}

/// A straight path of all coordinates between two poses, with bounds on it as functions of the
/// fraction of the path.
///
/// A joint's vector l is its chord but for its second derivative b. So |l'| is no more than b/2
/// above the chord. |g''|/2 is no more than h = |l'|² + |l| b. On the way g is no more than h/4
/// below its values at the ends. |g'| is no more than h below the difference of these.
pub(super) struct Way<'a> {
    cranks: &'a Cranks,
    ends: [&'a Arms; 2],
    /// Distance from the first end within which the path begins \[m\].
    travel: f64,
    /// Bounds on the joints' second derivative, and on their distance from the axles \[m\].
    bend: f64,
    farthest: f64,
    /// Bounds on the square of each joint's derivative \[m2\], and on any joint's \[m\].
    squares: [f64; 6],
    joint: f64,
    /// Bounds on the second derivatives of the transmissions' squares.
    pub(super) square_bends: [f64; 6],
}

impl<'a> Way<'a> {
    /// The way between these ends, or from within `travel` of the first one.
    ///
    /// The square of a transmission is (e² + f² - g²)/(2 a s)². e and f are linear in l. Its part
    /// in the plane of the crank alone makes them.
    #[inline(never)]
    pub(super) fn new(cranks: &'a Cranks, ends: [&'a Arms; 2], bend: f64, farthest: f64, travel: f64) -> Self {
        let [start, end] = ends;
        let Chords { squares: chords, in_plane } = cranks.chords(ends);
        let longest = square_root(chords.iter().fold(0.0, |most, &chord| max(chord, most)));
        let off = travel + 0.5 * bend;
        let (slack, turned, shift) = (off * (2.0 * longest + off), farthest * bend, 2.0 * farthest * travel);
        let four_arms = 4.0 * cranks.arm * cranks.arm;
        let above = max(farthest * farthest + cranks.arm * cranks.arm - cranks.rod * cranks.rod, 0.0);
        let of_all = 2.0 * four_arms * (slack + turned) + 4.0 * above * turned;
        let scale = 0.5 / (cranks.arm * cranks.rod);
        let [mut squares, mut square_bends] = [[0.0; 6]; 2];
        for i in 0..6 {
            squares[i] = chords[i] + slack;
            let bulge = squares[i] + turned;
            let below = max(0.25 * bulge + shift - min(start.g[i], end.g[i]), 0.0);
            let slope = max((end.g[i] - start.g[i]).abs() - shift - bulge, 0.0);
            let bend = 2.0 * four_arms * in_plane[i] + of_all + 4.0 * below * bulge - 2.0 * slope * slope;
            square_bends[i] = bend * (scale * scale);
        }
        Way { cranks, ends, travel, bend, farthest, squares, joint: longest + off, square_bends }
    }

    /// True if every crank keeps transmission and range on the way. At either end it needs this
    /// transmission and these clearances from spheres. Transmissions become smaller by `lost`
    /// before the way begins.
    ///
    /// An angle stays inside its range while the joint keeps its side of a sphere. Its centre is
    /// the end of an arm at the range's end, given by cosine and sine. Its radius is the rod.
    /// Such distances are lengths of legs, whose squares have the second derivatives of
    /// `home.rs`.
    #[inline(never)]
    fn complies(&self, range: &[[f64; 2]; 2], needed: [f64; 2], clearances: [[f64; 2]; 2], lost: f64) -> bool {
        let Way { cranks, ends: [start, end], travel, bend, farthest, .. } = *self;
        let turned = (farthest + cranks.arm) * bend;
        let [below_travel, above_travel] =
            [2.0 * travel * (farthest + cranks.arm), travel * (2.0 * cranks.rod + travel)];
        let [least, least_at_end] = needed.map(|transmission| transmission * transmission);
        let mut complies = true;
        for i in 0..6 {
            let left = start.transmission[i] - lost;
            let (from, to) = (left * left - least, end.transmission[i] * end.transmission[i] - least_at_end);
            complies &= (left >= 0.0) & is_nowhere_negative([from, to], 0.5 * self.square_bends[i]);
            let [below, above] = start.clear_of(i, range);
            let [below, above] = [below - below_travel - clearances[0][0], above - above_travel - clearances[0][1]];
            let [below_at_end, above_at_end] = end.clear_of(i, range);
            let [below_at_end, above_at_end] = [below_at_end - clearances[1][0], above_at_end - clearances[1][1]];
            complies &= is_nowhere_negative([below, below_at_end], self.squares[i] + turned);
            complies &= is_nowhere_negative([above, above_at_end], turned);
        }
        complies
    }

    /// Bound on |q''| on a way that begins at its first end, where no |q'| is larger than `rate` at
    /// its start. None if a transmission may come to zero.
    fn arc_bend(&self, rate: f64) -> Option<f64> {
        let Way { cranks, ends, joint, bend, .. } = *self;
        let least = (0..6).fold(f64::INFINITY, |least, i| {
            let smaller = min(ends[0].transmission[i], ends[1].transmission[i]);
            min(smaller * smaller - 0.125 * max(self.square_bends[i], 0.0), least)
        });
        let transmission = square_root(least);
        let rod_rate = joint / transmission;
        let by_joints = (bend + joint * joint * cranks.turning(transmission)) / transmission;
        let rate = min(rate + by_joints, rod_rate);
        let of_arm = cosine_from_sine(transmission) * rate * rate / cranks.arm;
        (least > 0.0).then_some((bend + of_arm + rod_rate * rod_rate / cranks.rod) / transmission)
    }
}

impl Certifier {
    /// The limits of the joints of cranks with this smallest transmission in a state.
    pub(super) fn joint_limits_of_cranks(&self, cranks: &Cranks, transmission: f64) -> JointLimits {
        let assumed = cranks.assumed(transmission);
        let acceleration = self.limits.acceleration * assumed;
        JointLimits {
            transmission: assumed,
            turning_length: 1.0 / cranks.turning(assumed),
            velocity: self.limits.velocity * assumed,
            acceleration,
            stop_time_per_speed: 1.0 / (STOP_FRACTION * acceleration),
            travel: (transmission - assumed) / cranks.transmission_slope(assumed),
        }
    }

    /// As [`Certifier::certify_by_bounds`], for cranks.
    #[inline(never)]
    pub(super) fn certify_cranks_by_bounds(
        &self,
        cranks: &Cranks,
        from: &PlatformState,
        to: &PlatformState,
        safety: &SafetyParameters,
        step: f64,
    ) -> Option<f64> {
        let joint_limits = self.joint_limits_of_cranks(cranks, cranks.transmission(&self.geometry, &to.motion.pose()));
        self.certify_within::<true>(&joint_limits, from, to, safety, step)
    }

    /// As [`Certifier::certify_home_by_bounds`], for cranks.
    #[inline(never)]
    pub(super) fn certify_cranks_home_by_bounds(
        &self,
        cranks: &Cranks,
        from: &PlatformState,
        to: &PlatformState,
        safety: &SafetyParameters,
        step: f64,
    ) -> Option<f64> {
        let arms = cranks.arms_in(&self.geometry, &to.motion.pose());
        let joint_limits = self.joint_limits_of_cranks(cranks, arms.least_transmission());
        let duration = self.certify_within::<true>(&joint_limits, from, to, safety, step)?;
        let speed = Speed::of(&to.coordinates);
        let travel = 0.5 * duration * speed.of_joints(self.radius);
        let turn = 0.5 * duration * speed.angular;
        let from = Distance::of(&to.coordinates, self.radius);
        let distance = Distance { joint: from.joint + travel, angular: from.angular + turn };
        let lost = travel * cranks.transmission_slope(joint_limits.transmission);
        (travel <= joint_limits.travel && self.arms_have_way_home(cranks, &arms, distance, travel, lost))
            .then_some(duration)
    }

    /// True if bounds certify the way home over this distance, from within `travel` of where the
    /// arms are. Their transmissions become smaller by `lost` there.
    #[inline(always)]
    pub(super) fn arms_have_way_home(
        &self,
        cranks: &Cranks,
        arms: &Arms,
        distance: Distance,
        travel: f64,
        lost: f64,
    ) -> bool {
        let Some(neutral) = &self.home.arms else { return false };
        let bend = distance.angular * distance.angular * self.radius;
        let way = Way::new(cranks, [arms, neutral], bend, self.home.joints[1] + distance.joint, travel);
        self.arms_certify_way(&way, [0.0, 1.0], lost)
    }

    /// True if bounds certify a part of the way home, which begins and ends at these fractions of
    /// it.
    #[inline(always)]
    pub(super) fn arms_certify_way(&self, way: &Way, fractions: [f64; 2], lost: f64) -> bool {
        let needed = fractions.map(|fraction| self.transmission_needed(way.cranks, fraction));
        let clearances = fractions.map(|fraction| self.home.joints_margin.map(|clearance| fraction * clearance));
        way.complies(&self.home.ends, needed, clearances, lost)
    }

    /// True if the arms in a candidate and where its stop ends certify the stop, and the rates at
    /// both ends of the transition to it certify that.
    ///
    /// At the fraction p of its duration T, the stop is T (p - p²/2) along the way on which the
    /// velocities stay. At the start of that way arcs have the first derivative q'. The second one
    /// is at most B. So accelerations are at most B (1 - p + p²/2) + |q'|/T. Speeds are at most
    /// |q'| + 0.2 B T.
    pub(super) fn ends_certify_stop(
        &self,
        cranks: &Cranks,
        from: &PlatformState,
        to: &PlatformState,
        plan: &StopPlan,
        step: f64,
    ) -> bool {
        let StopDurations { linear, angular: duration } = *plan.durations();
        let arms = cranks.arms_in(&self.geometry, &to.motion.pose());
        let [shortest, longest] = to.legs.extremes();
        if linear != Vector3::repeat(duration)
            || !(shortest >= self.limits.min && longest <= self.limits.max)
            || !self.rates_certify_transition(cranks, arms.least_transmission(), from, to, step)
        {
            return false;
        }
        let end = cranks.arms_in(&self.geometry, &plan.at(duration).motion(self.neutral_height).pose());
        let speed = Speed::of(&to.coordinates);
        let turn = 0.5 * duration * speed.angular;
        let bend = turn * turn * self.radius;
        let farthest = self.home.joints[1] + Distance::of(&to.coordinates, self.radius).joint + turn * self.radius;
        let way = Way::new(cranks, [&arms, &end], bend, farthest + 0.5 * duration * speed.linear, 0.0);
        let rate = to.legs.velocity.iter().fold(0.0, |most, rate| max(rate.abs(), most));
        let per_time = 1.0 / duration;
        self.arms_certify_way(&way, [0.0; 2], 0.0)
            && way.arc_bend(0.5 * duration * rate).is_some_and(|bend| {
                per_time * (rate + 4.0 * per_time * bend) <= self.limits.acceleration
                    && rate + 0.8 * per_time * bend <= self.limits.velocity
            })
    }

    /// True if the arms keep speed and acceleration within a transition, as their rates at both
    /// ends show. The candidate has this smallest transmission. The proof is that of
    /// [`Certifier::rates_comply_with_acceleration_limit`]. Here, the transmission is what is left,
    /// and rates are the real ones.
    fn rates_certify_transition(
        &self,
        cranks: &Cranks,
        transmission: f64,
        from: &PlatformState,
        to: &PlatformState,
        step: f64,
    ) -> bool {
        let (now, next) = (&from.coordinates, &to.coordinates);
        let per_step = 1.0 / step;
        let (change, gap) = change_and_gap(&now.linear, &next.linear, step);
        let (turn, angle_gap) = change_and_gap(&now.angles, &next.angles, step);
        let gap = 2.0 * per_step * per_step * (sum_of_magnitudes(&gap) + sum_of_magnitudes(&angle_gap) * self.radius);
        let (before, after) = (Speed::of(now), Speed::of(next));
        let turning = max(before.angular, after.angular);
        let fastest = max(before.of_joints(self.radius), after.of_joints(self.radius)) + 0.5 * step * gap;
        let assumed = cranks.assumed(transmission);
        let left = transmission - step * fastest * cranks.transmission_slope(assumed);
        let accelerations = [per_step * change.norm(), per_step * sum_of_magnitudes(&turn)];
        let bounds =
            JointBounds { velocity: fastest, ..JointBounds::new([fastest, turning], accelerations, self.radius) };
        let gap = gap * (1.0 + step * (fastest * cranks.turning(left) + turning)) / left;
        let [mut mean, mut rate] = [0.0; 2];
        for (before, after) in from.legs.velocity.iter().zip(&to.legs.velocity) {
            mean = max((after - before).abs(), mean);
            rate = max(max(before.abs(), after.abs()), rate);
        }
        let jerk = cranks.arc_jerk(&bounds, left, cranks.rate_after(&bounds, left, rate, step));
        let acceleration = per_step * mean + gap + step * jerk;
        left >= assumed
            && acceleration <= self.limits.acceleration
            && rate + 0.5 * step * acceleration <= self.limits.velocity
    }

    /// True if the rates of the arms at both ends show that accelerations keep their limit within a
    /// transition. The joints keep the bounds, and the rates of both ends are off by at most `gap`
    /// times the step \[m/s2\].
    ///
    /// The mean of an acceleration is the change of the rate over the step, and somewhere in it the
    /// acceleration is that mean.
    pub(super) fn rates_comply_with_acceleration_limit(
        &self,
        joint_limits: &JointLimits,
        rates: [&[f64; 6]; 2],
        bounds: &JointBounds,
        gap: f64,
        step: f64,
    ) -> bool {
        let Some(cranks) = &self.geometry.cranks else { return false };
        let mean = (0..6).fold(0.0, |most, i| max((rates[1][i] - rates[0][i]).abs(), most)) / step;
        mean + gap
            + step * cranks.arc_jerk(bounds, joint_limits.transmission, bounds.velocity / joint_limits.transmission)
            <= self.limits.acceleration
    }

    /// The smallest transmission that a stop and the way home need at the fraction `s` of that way.
    fn transmission_needed(&self, cranks: &Cranks, s: f64) -> f64 {
        // From a rest at the very limit no first step home could be certified.
        const LEFT_AT_REST: f64 = 1e-9;
        let least = cranks.least_transmission + LEFT_AT_REST;
        least + HOME_MARGIN_FRACTION * s * (self.home.transmission - least)
    }
}
