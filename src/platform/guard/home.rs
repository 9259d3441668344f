//! The way home: from where the platform comes to rest, straight to neutral.
//!
//! On the way all coordinates are 1 - s times those of its start, s from 0 to 1. Every safety limit
//! of position holds on it. Let D be the distance that a joint moves on it at most, W the sum of
//! the angles' magnitudes and r the farthest joint. The vector g of a leg has |g'| <= D and
//! |g''| <= W² r. The leg's length L = |g| therefore has
//!
//! (L²)'' <= 2 c with c = D² + L W² r, and L'' >= -W² r.
//!
//! Take two points of the way, a and b. A function whose second derivative is at most 2 c is no
//! more than c (s - a)(b - s) below the line between its ends. The function stays above zero if its
//! values at the ends add up to c (b - a)² or more. Cranks have a weaker condition
//! (`is_nowhere_negative`), and margins of squares and transmissions (`Way`), both in `cranks.rs`.
//!
//! The way is certified if every leg is inside its stroke by at least s times a margin. From any
//! point of a certified way the rest of it is certified as well.

use super::certifier::{Certifier, Home, Speed, sum_of_magnitudes};
use super::cranks::{JointLimits, Way};
use crate::interface::SafetyParameters;
use crate::motion::Motion;
use crate::motion::braking_law::Limits;
use crate::motion::min_max::{max, min};
use crate::motion::square_root::square_root;
use crate::platform::{PlatformCoordinates, PlatformState};

/// The largest number of points of a way that are looked at, and the largest number of parts into
/// which it is divided.
const MOST_POINTS: usize = 16;
const MOST_PARTS: f64 = 32.0;

/// Distances on the straight way to neutral.
#[derive(Clone, Copy)]
pub(super) struct Distance {
    /// Largest distance that any joint may have from its place at neutral \[m\].
    pub(super) joint: f64,
    /// Sum of the angles' magnitudes \[rad\].
    pub(super) angular: f64,
}

impl Distance {
    #[inline(always)]
    pub(super) fn of(coordinates: &PlatformCoordinates, radius: f64) -> Self {
        let angular = sum_of_magnitudes(&coordinates.angles.position);
        Distance { joint: coordinates.linear.position.norm() + angular * radius, angular }
    }
}

/// True if what the ends of a part have beyond their limits is not negative, and adds up to
/// `least`.
fn chords_are_clear(left: &[[f64; 2]; 6], right: &[[f64; 2]; 6], least: [f64; 2]) -> bool {
    (0..6).all(|i| (0..2).all(|k| left[i][k] >= 0.0 && right[i][k] >= 0.0 && left[i][k] + right[i][k] >= least[k]))
}

/// True if a way is certified part by part. `at` gives the point at a fraction of it, `neutral` is
/// the point at its end, and `certifies` is true of a part between two points that is certified.
#[inline(always)]
fn divided<T: Copy>(at: impl Fn(f64) -> T, neutral: &T, certifies: impl Fn([f64; 2], [&T; 2]) -> bool) -> bool {
    let (mut begin, mut left, mut part) = (0.0, at(0.0), 1.0);
    for _ in 1..MOST_POINTS {
        let end = begin + part;
        let right = if end < 1.0 { at(end) } else { *neutral };
        let certified = certifies([begin, end], [&left, &right]);
        if certified && end >= 1.0 {
            return true;
        }
        if certified {
            (begin, left) = (end, right);
            part = (2.0 * part).min(1.0 - begin);
        } else if part * MOST_PARTS > 1.0 {
            part *= 0.5;
        } else {
            return false;
        }
    }
    false
}

impl Certifier {
    /// True if bounds are enough to certify the way home of legs from the end of a stop that
    /// takes this duration from the candidate. That stop moves no joint by more than half the
    /// duration times its speed.
    #[inline(always)]
    pub fn has_way_home_by_bounds(&self, to: &PlatformState, duration: f64) -> bool {
        let Home { longest, beyond_margin: [below, above], per_two_lengths, .. } = self.home;
        let speed = Speed::of(&to.coordinates);
        let (travel, turn) = (0.5 * duration * speed.of_joints(self.radius), 0.5 * duration * speed.angular);
        let distance = Distance::of(&to.coordinates, self.radius);
        let (joint, angular) = (distance.joint + travel, distance.angular + turn);
        let turning = angular * angular * self.radius;
        let chord_gap = (joint * joint + (longest + joint) * turning) * per_two_lengths;
        let lowest = self.limits.min + travel + max(chord_gap - below, 0.0);
        let highest = self.limits.max - travel - max(0.5 * turning - above, 0.0);
        let [least, greatest] = to.legs.extremes();
        least >= lowest && greatest <= highest
    }

    /// True if the way home from rest in these coordinates is certified.
    pub fn has_way_home(&self, rest: &PlatformCoordinates) -> bool {
        let distance = Distance::of(rest, self.radius);
        let turning = distance.angular * distance.angular * self.radius;
        let coordinates_at = |s: f64| PlatformCoordinates {
            linear: Motion { position: rest.linear.position * (1.0 - s), ..Motion::default() },
            angles: Motion { position: rest.angles.position * (1.0 - s), ..Motion::default() },
        };
        if let Some(cranks) = &self.geometry.cranks {
            let Some(neutral) = &self.home.arms else { return false };
            let farthest = self.home.joints[1] + distance.joint;
            let at = |s: f64| cranks.arms_in(&self.geometry, &coordinates_at(s).motion(self.neutral_height).pose());
            return divided(at, neutral, |fractions, ends| {
                let part = fractions[1] - fractions[0];
                self.arms_certify_way(&Way::new(cranks, ends, turning * part * part, farthest, 0.0), fractions, 0.0)
            });
        }
        let chord_gap = distance.joint * distance.joint + (self.home.longest + distance.joint) * turning;
        let [low, high] = self.home.margin;
        // Beyond the margins, at the fraction s of the way: squares of lengths, and lengths.
        let beyond = |s: f64, lengths: &[f64; 6]| {
            let shortest = self.limits.min + low * s;
            let longest = self.limits.max - high * s;
            lengths.map(|length| [length * length - shortest * shortest, longest - length])
        };
        let at = |s: f64| beyond(s, &self.state(coordinates_at(s)).legs.position);
        divided(at, &beyond(1.0, &self.home.length), |[begin, end], ends| {
            let part = end - begin;
            chords_are_clear(ends[0], ends[1], [chord_gap * part * part, 0.5 * turning * part * part])
        })
    }

    /// The state `step` seconds later on the straight way to neutral. The platform is at rest, or
    /// moves along that way already. `fraction` reduces speed and acceleration.
    pub fn step_towards_neutral(
        &self,
        now: &PlatformCoordinates,
        safety: &SafetyParameters,
        fraction: f64,
        step: f64,
    ) -> PlatformCoordinates {
        let distance = Distance::of(now, self.radius).joint;
        // Of the legs' acceleration a part remains for their turning, of every limit a part for rounding.
        let joint_limits = self.joint_limits(min(self.transmission_at(now), self.home.transmission));
        let JointLimits { turning_length, velocity, acceleration, .. } = joint_limits;
        let max_step = self.limits.max_step;
        let mut hardest = 0.25 * acceleration;
        let mut fastest = min(0.5 * velocity, square_root(0.1 * acceleration * turning_length));
        let SafetyParameters { position_limit: _, velocity_limit, acceleration_limit } = safety;
        for k in 0..3 {
            // The joints' travel for each metre on this axis.
            let ratio = 0.5 * distance / max(now.linear.position[k].abs(), f64::MIN_POSITIVE);
            hardest = min(acceleration_limit[k] * ratio, hardest);
            fastest = min(velocity_limit[k] * ratio, fastest);
        }
        let along = Limits::symmetric(f64::INFINITY, fraction * fastest, fraction * hardest, max_step);
        let travelled =
            Motion { position: -distance, velocity: Speed::of(now).of_joints(self.radius), acceleration: 0.0 };
        let speed = along.follow(&travelled, &Motion::default(), along.acceleration, step).velocity;
        let rate = if distance > 0.0 { max(speed, 0.0) / distance } else { 0.0 };
        PlatformCoordinates {
            linear: now.linear.at_velocity(-rate * now.linear.position, step),
            angles: now.angles.at_velocity(-rate * now.angles.position, step),
        }
    }
}
