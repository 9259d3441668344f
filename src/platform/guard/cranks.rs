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

use super::bounds::JointBounds;
use super::certifier::{Certifier, HOME_MARGIN_FRACTION, STOP_FRACTION, Speed};
use super::home::{Distance, Point, chords_are_clear};
use crate::interface::SafetyParameters;
use crate::motion::min_max::{max, min};
use crate::motion::square_root::square_root;
use crate::platform::PlatformState;
use crate::platform::crank::{Arms, Cranks};
use crate::platform::inverse::LegMotion;

/// The transmission that is assumed, relative to that of a state: what is left is for the motion.
const ASSUMED_PART: f64 = 0.8;
/// Largest turn of an arm within a piece \[rad\]. Angles are within 2 rad from level, so from a
/// larger one to another turn of it is more than 2 rad: none is taken for another.
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
        let second = (bounds.acceleration + bounds.velocity * bounds.velocity * self.turning(left)) / left;
        let rate = min(rate + half * second, bounds.velocity / left);
        (left >= transmission && turns <= LARGEST_TURN).then(|| self.arc_jerk(bounds, left, rate) * half)
    }

    /// Bound on the second derivative of any transmission's square on a way. The joints' vectors
    /// have derivatives of at most `joint` and `bend`, and lengths of at most `farthest`. Their g
    /// is nowhere smaller than `least_g`.
    ///
    /// The square is (e² + f² - g²)/(2 a s)². e and f are linear in the joint's vector l, and
    /// g'' = 2 |l'|² + 2 l·l''. The square of g' makes the second derivative only smaller, and so
    /// does |l'|² where g is positive.
    fn square_bend(&self, joint: f64, bend: f64, farthest: f64, least_g: f64) -> f64 {
        let Cranks { arm, rod, .. } = *self;
        let (below, above) = (max(-least_g, 0.0), max(farthest * farthest + arm * arm - rod * rod, 0.0));
        let (square, turned) = (joint * joint, farthest * bend);
        let scale = 1.0 / (2.0 * arm * rod);
        ((8.0 * arm * arm + 4.0 * below) * (square + turned) + 4.0 * above * turned) * scale * scale
    }
}

/// Bounds on the straight way to neutral.
pub(super) struct Way {
    /// Bound on the second derivative of any transmission's square.
    pub(super) square_bend: f64,
    /// Bounds on the first and second derivatives of the joints' vectors, and on those vectors
    /// \[m\].
    joint: f64,
    bend: f64,
    farthest: f64,
}

impl Way {
    /// Bound on |q''| on a part of the way with these transmissions at its ends, if one can be
    /// given.
    fn arc_bend(&self, cranks: &Cranks, ends: [f64; 2], part: f64) -> Option<f64> {
        let smaller = min(ends[0], ends[1]);
        let square = smaller * smaller - 0.125 * self.square_bend * part * part;
        let transmission = square_root(square);
        let turning = self.joint * self.joint * cranks.turning(transmission);
        (square > 0.0).then_some((self.bend + turning) / transmission)
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
        self.arms_have_way_home_by_bounds(cranks, &arms, &joint_limits, to, duration).then_some(duration)
    }

    /// As [`Certifier::has_way_home_by_bounds`], for cranks.
    #[inline(never)]
    pub(super) fn cranks_have_way_home_by_bounds(&self, cranks: &Cranks, to: &PlatformState, duration: f64) -> bool {
        let arms = cranks.arms_in(&self.geometry, &to.motion.pose());
        self.arms_have_way_home_by_bounds(
            cranks,
            &arms,
            &self.joint_limits_of_cranks(cranks, arms.least_transmission()),
            to,
            duration,
        )
    }

    /// The same, where the arms are known. An angle stays inside its range while the joint
    /// keeps its side of a sphere: about the end of an arm at the range's end, with the rod
    /// as radius. Such distances are lengths of legs, whose squares have the second
    /// derivatives that `home.rs` has.
    #[inline(always)]
    fn arms_have_way_home_by_bounds(
        &self,
        cranks: &Cranks,
        arms: &Arms,
        joint_limits: &JointLimits,
        to: &PlatformState,
        duration: f64,
    ) -> bool {
        let speed = Speed::of(&to.coordinates);
        let travel = 0.5 * duration * speed.of_joints(self.radius);
        let turn = 0.5 * duration * speed.angular;
        let from = Distance::of(&to.coordinates, self.radius);
        let way = self.way(cranks, arms, Distance { joint: from.joint + travel, angular: from.angular + turn }, travel);
        // Squares of transmissions beyond what is needed at either end of the way.
        let [start, needed] = [cranks.least_transmission, self.transmission_needed(cranks, 1.0)];
        let left = arms.least_transmission() - travel * cranks.transmission_slope(joint_limits.transmission);
        let start = left * left - start * start;
        let neutral = self.home.transmission * self.home.transmission - needed * needed;
        let farthest = way.farthest + cranks.arm;
        let [below, above] = arms.clear_of(self.home.ends);
        let below = below - 2.0 * travel * farthest;
        let above = above - travel * (2.0 * cranks.rod + travel);
        let turned = farthest * way.bend;
        travel <= joint_limits.travel
            && left > 0.0
            && start >= 0.0
            && start + neutral >= 0.5 * way.square_bend
            && below >= 0.0
            && below + self.home.joints_beyond_margin[0] >= way.joint * way.joint + turned
            && above >= 0.0
            && above + self.home.joints_beyond_margin[1] >= turned
    }

    /// Bounds on the way home over this distance, from within `travel` of where the arms are.
    ///
    /// A joint's way is its chord but for its second derivative b. So |l'| is no more than b/2
    /// above the chord. There, g is no more than (|l'|² + |l| b)/4 below its values at the ends.
    pub(super) fn way(&self, cranks: &Cranks, arms: &Arms, distance: Distance, travel: f64) -> Way {
        let bend = distance.angular * distance.angular * self.radius;
        let [nearest, farthest] = self.home.joints;
        let farthest = farthest + distance.joint;
        let joint =
            min(arms.farthest_from_neutral(&self.geometry, self.neutral_height) + travel + 0.5 * bend, distance.joint);
        let neutral_g = nearest * nearest + cranks.arm * cranks.arm - cranks.rod * cranks.rod;
        let least_g = min(arms.least_g() - 2.0 * farthest * travel, neutral_g);
        let least_g = least_g - 0.25 * (joint * joint + farthest * bend);
        Way { square_bend: cranks.square_bend(joint, bend, farthest, least_g), joint, bend, farthest }
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

    /// True if a part of the way home is certified by its ends, which are at these fractions of the
    /// way.
    pub(super) fn cranks_certify_part(
        &self,
        cranks: &Cranks,
        way: &Way,
        fractions: [f64; 2],
        points: [&Point; 2],
    ) -> bool {
        let part = fractions[1] - fractions[0];
        let transmissions = points.map(|point| point.transmission);
        let [left, right] = [0, 1].map(|k: usize| {
            let needed = self.transmission_needed(cranks, fractions[k]);
            transmissions[k] * transmissions[k] - needed * needed
        });
        let least = 0.5 * way.square_bend * part * part;
        let complies = left >= 0.0 && right >= 0.0 && left + right >= least;
        let bend = way.arc_bend(cranks, transmissions, part).filter(|_| complies);
        bend.is_some_and(|bend| chords_are_clear(&points[0].beyond, &points[1].beyond, [0.5 * bend * part * part; 2]))
    }

    /// The smallest transmission that the way home needs at the fraction `s` of it.
    fn transmission_needed(&self, cranks: &Cranks, s: f64) -> f64 {
        let least = cranks.least_transmission;
        least + HOME_MARGIN_FRACTION * s * (self.home.transmission - least)
    }
}
