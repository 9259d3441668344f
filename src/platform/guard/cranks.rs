//! What the certificate and the way home need beside the legs' proofs where the
//! actuators are cranks.
//!
//! Let G1, G2, G3 be the bounds on the derivatives of the joints' vectors ([`JointBounds`]), a the
//! arm and s the rod. While no transmission is smaller than k, an arc q has
//!
//! ```text
//!     |q'|   <= F1 = G1/k                                     Q1 = G1 + F1
//!     |q''|  <= F2 = (G2 + F1²/a + Q1²/s)/k                   Q2 = G2 + F1²/a + F2
//!     |q'''| <= F3 = (G3 + F1³/a² + 3 F1 F2/a + 3 Q1 Q2/s)/k
//!     |k'|   <= Q1/s + F1/a
//! ```
//!
//! k is assumed, and shown afterwards. A transmission is continuous: from a larger value at an end
//! of the piece it cannot fall below k within the piece at that rate.
//!
//! In terms of the joints, F1 and F2 are G1/k and (G2 + G1²/c)/k with a length c, as a leg's are
//! with k = 1 and its length ([`Lever`]).

use super::bounds::JointBounds;
use super::home::{Distance, Point, keep_chords};
use super::machine::{CLEARANCE, Machine, STOP_FRACTION, Speed};
use crate::interface::SafetyParameters;
use crate::motion::min_max::{max, min};
use crate::motion::square_root::square_root;
use crate::platform::PlatformState;
use crate::platform::crank::Cranks;

/// The transmission that is assumed, relative to that of a state: what is left is for the motion.
const ASSUMED_PART: f64 = 0.8;
/// Largest turn of an arm within a piece \[rad\]. Angles are within 2 rad from level, so from a
/// larger one to another turn of it is more than 2 rad: none is taken for another.
const LARGEST_TURN: f64 = 2.0;

/// Limits of the actuators as limits of the joints.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lever {
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
        (1.0 + 1.0 / transmission) / self.rod + 1.0 / (self.arm * transmission)
    }

    /// What a joint's speed squared adds to its acceleration, as one over a length \[1/m\].
    pub(super) fn turning(&self, transmission: f64) -> f64 {
        let rod = 1.0 + 1.0 / transmission;
        1.0 / (self.arm * transmission * transmission) + rod * rod / self.rod
    }

    /// Bound on |q'''| with these bounds of the joints, where no transmission is smaller
    /// than this one \[m/s3\].
    pub(super) fn arc_jerk(&self, bounds: &JointBounds, transmission: f64) -> f64 {
        let JointBounds { velocity, acceleration, jerk } = *bounds;
        let Cranks { arm, rod, .. } = *self;
        let rate = velocity / transmission;
        let rod_rate = velocity + rate;
        let second = (acceleration + rate * rate / arm + rod_rate * rod_rate / rod) / transmission;
        let rod_second = acceleration + rate * rate / arm + second;
        let of_arm = rate * rate * rate / (arm * arm) + 3.0 * rate * second / arm;
        (jerk + of_arm + 3.0 * rod_rate * rod_second / rod) / transmission
    }

    /// The change of the arcs' accelerations within half of an interval,
    /// if every crank keeps its transmission there. `ends` is the smaller one at the ends.
    pub(super) fn spread(&self, bounds: &JointBounds, ends: f64, interval: f64) -> Option<f64> {
        let half = 0.5 * interval;
        let transmission = self.assumed(ends);
        let lost = bounds.velocity * half * self.transmission_slope(transmission);
        let turns = bounds.velocity / transmission * interval / self.arm;
        (ends - lost >= transmission && turns <= LARGEST_TURN).then(|| self.arc_jerk(bounds, transmission) * half)
    }

    /// Bound on the second derivative of any transmission's square on a line on which joints move
    /// by at most `joint`, with second derivatives of at most `bend`. All joints are `nearest` to
    /// `farthest` from their axles there.
    ///
    /// The square is (e² + f² - g²)/(2 a s)², and e, f, g are at most quadratic
    /// in the joint's vector.
    fn square_bend(&self, joint: f64, bend: f64, [nearest, farthest]: [f64; 2]) -> f64 {
        let Cranks { arm, rod, .. } = *self;
        let apart = |distance: f64| (distance * distance + arm * arm - rod * rod).abs();
        let g = max(apart(nearest), apart(farthest));
        let scale = 1.0 / (2.0 * arm * rod);
        (8.0 * arm * arm + 4.0 * g) * (joint * joint + farthest * bend) * scale * scale
    }
}

/// The cranks at neutral, and bounds on the straight way there.
struct Way {
    /// Bound on the second derivative of any transmission's square.
    square_bend: f64,
    joint: f64,
    bend: f64,
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

impl Machine {
    /// The lever of cranks with this smallest transmission in a state.
    pub(super) fn lever_of(&self, cranks: &Cranks, transmission: f64) -> Lever {
        let assumed = cranks.assumed(transmission);
        let acceleration = self.limits.acceleration * assumed;
        Lever {
            transmission: assumed,
            turning_length: 1.0 / cranks.turning(assumed),
            velocity: self.limits.velocity * assumed,
            acceleration,
            stop_time_per_speed: 1.0 / (STOP_FRACTION * acceleration),
            travel: (transmission - assumed) / cranks.transmission_slope(assumed),
        }
    }

    /// As [`Machine::certify_by_bounds`], for cranks.
    #[inline(never)]
    pub(super) fn certify_cranks_by_bounds(
        &self,
        cranks: &Cranks,
        from: &PlatformState,
        to: &PlatformState,
        safety: &SafetyParameters,
        step: f64,
    ) -> Option<f64> {
        let lever = self.lever_of(cranks, cranks.transmission(&self.geometry, &to.motion.pose()));
        self.certify_within::<true>(&lever, from, to, safety, step)
    }

    /// As [`Machine::sees_home_by_bounds`], for cranks.
    #[inline(never)]
    pub(super) fn cranks_see_home_by_bounds(&self, cranks: &Cranks, to: &PlatformState, duration: f64) -> bool {
        let speed = Speed::of(&to.coordinates);
        let travel = 0.5 * duration * speed.of_joints(self.radius);
        let turn = 0.5 * duration * speed.angular;
        let transmission = cranks.transmission(&self.geometry, &to.motion.pose());
        let lever = self.lever_of(cranks, transmission);
        let from = Distance::of(&to.coordinates, self.radius);
        let way = self.way(cranks, Distance { joint: from.joint + travel, angular: from.angular + turn });
        let ends = [lever.transmission, self.home.transmission];
        let smaller = min(ends[0], ends[1]);
        // Clear of the limit all the way by what is kept at neutral.
        let clear = self.transmission_needed(cranks, 1.0);
        let keeps = travel <= lever.travel && smaller * smaller - 0.125 * way.square_bend >= clear * clear;
        let Some(bend) = way.arc_bend(cranks, ends, 1.0).filter(|_| keeps) else { return false };
        let [below, above] = self.home.beyond_clearance;
        let moved = travel / lever.transmission;
        let [least, greatest] = to.legs.extremes();
        least - moved >= self.limits.min + max(0.5 * bend - below, 0.0)
            && greatest + moved <= self.limits.max - max(0.5 * bend - above, 0.0)
    }

    /// Bounds on the way home over this distance.
    fn way(&self, cranks: &Cranks, Distance { joint, angular }: Distance) -> Way {
        let bend = angular * angular * self.radius;
        let [nearest, farthest] = self.home.joints;
        let square_bend = cranks.square_bend(joint, bend, [max(nearest - joint, 0.0), farthest + joint]);
        Way { square_bend, joint, bend }
    }

    /// True if a part of the way home is certified by its ends, which are at these fractions of the
    /// way.
    pub(super) fn cranks_keep_part(
        &self,
        cranks: &Cranks,
        distance: &Distance,
        fractions: [f64; 2],
        points: [&Point; 2],
    ) -> bool {
        let way = self.way(cranks, *distance);
        let part = fractions[1] - fractions[0];
        let transmissions = points.map(|point| point.transmission);
        let [left, right] = [0, 1].map(|k: usize| {
            let needed = self.transmission_needed(cranks, fractions[k]);
            transmissions[k] * transmissions[k] - needed * needed
        });
        let least = 0.5 * way.square_bend * part * part;
        let keeps = left >= 0.0 && right >= 0.0 && left + right >= least;
        let bend = way.arc_bend(cranks, transmissions, part).filter(|_| keeps);
        bend.is_some_and(|bend| keep_chords(&points[0].beyond, &points[1].beyond, [0.5 * bend * part * part; 2]))
    }

    /// The smallest transmission that the way home needs at the fraction `s` of it.
    fn transmission_needed(&self, cranks: &Cranks, s: f64) -> f64 {
        let least = cranks.least_transmission;
        least + CLEARANCE * s * (self.home.transmission - least)
    }
}
