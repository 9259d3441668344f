//! The tilt's acceleration without jumps.
//!
//! The rider's head is H above the platform. Where a limit keeps travel from making up for it, a
//! jump of the tilt's acceleration is felt as a jump of H times its size. The acceleration
//! therefore builds up to its limit A in no less than the time 1/c, and the limits of rate and
//! angle are approached no faster than that allows:
//!
//! ```text
//!     |alpha'| <= c A        alpha <= c (W - w)        alpha <= p^2 (Q - q) - 2 p w
//! ```
//!
//! with the rate w and its limit W, and the angle q and its limit Q; likewise on the other side.
//! From W the angle's bound takes at most W p/e of acceleration and W p^2 of its slope.

use super::AxisState;
use crate::motion::min_max::{max, min};
use crate::motion::square_root::square_root;

/// The tilt's limits of angle \[rad\], rate \[rad/s\] and acceleration \[rad/s2\], and how they
/// are approached.
#[derive(Clone, Copy, Debug)]
pub struct TiltLimits {
    angle: f64,
    rate: f64,
    acceleration: f64,
    /// Pace c at which the acceleration builds up and the rate's limit is approached \[1/s\].
    build_up: f64,
    /// Pace p at which the angle's limit is approached \[rad/s\].
    pace: f64,
}

/// Slope of the acceleration that is always allowed \[rad/s3\]: with a head 1.2 m above the
/// platform 7 m/s3 are felt.
const ALLOWED_JERK: f64 = 6.0;
/// Large accelerations build up in at most the inverse of this \[1/s\].
const LEAST_BUILD_UP: f64 = 15.0;
/// Largest pace of the angle \[rad/s\] ...
const LARGEST_PACE: f64 = 10.0;
/// ... relative to the pace of the build-up ...
const PACE_OF_BUILD_UP: f64 = 1.0 / 3.0;
/// ... and to A/W, with W at most what A reaches on the way; e would take all of the acceleration.
const PACE_OF_LIMITS: f64 = 2.5;

impl TiltLimits {
    /// The limits of angle, rate and acceleration.
    pub fn new(angle: f64, rate: f64, acceleration: f64) -> Self {
        let build_up = max(ALLOWED_JERK / acceleration, LEAST_BUILD_UP);
        let fastest = min(rate, square_root(acceleration * angle));
        let pace = min(min(PACE_OF_BUILD_UP * build_up, PACE_OF_LIMITS * acceleration / fastest), LARGEST_PACE);
        TiltLimits { angle, rate, acceleration, build_up, pace }
    }

    /// Acceleration over a step for each rad/s by which the rate is to change \[1/s\].
    pub fn by_rate(&self, step: f64) -> f64 {
        self.build_up / (1.0 + self.build_up * step)
    }

    /// The acceleration over a step that is nearest to the demanded one. The bounds hold at the
    /// step's end, so that they are stable for steps of any length.
    pub fn nearest_acceleration(&self, state: &AxisState, demanded: f64, step: f64) -> f64 {
        let AxisState { tilt, tilt_rate, tilt_acceleration, .. } = *state;
        let (by_rate, pace) = (self.by_rate(step), self.pace);
        let by_angle = pace / (1.0 + pace * step * (2.0 + pace * step));
        let largest = |side: f64| {
            let (rate, coasted) = (side * tilt_rate, side * (tilt + step * tilt_rate));
            let approach = by_angle * (pace * (self.angle - coasted) - 2.0 * rate);
            min(min(by_rate * (self.rate - rate), approach), self.acceleration)
        };
        let within = max(min(demanded, largest(1.0)), -largest(-1.0));
        let change = self.build_up * self.acceleration * step;
        max(min(within, tilt_acceleration + change), tilt_acceleration - change)
    }

    /// The angle and the rate that must be within their limits, for this acceleration to be within
    /// the bounds: q + 2 w/p + alpha/p^2 and w + alpha/c.
    pub fn approached(&self, angle: f64, rate: f64, acceleration: f64) -> [f64; 2] {
        let TiltLimits { build_up, pace, .. } = *self;
        [angle + (2.0 * rate + acceleration / pace) / pace, rate + acceleration / build_up]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: [[f64; 3]; 4] = [[0.257, 0.05236, 0.4], [0.38, 0.052, 0.2], [0.2, 0.045, 0.11], [0.5, 2.0, 5.0]];

    /// A tilt that follows random demands, and what it does at most.
    fn driven([angle, rate, acceleration]: [f64; 3], step: f64) -> [f64; 4] {
        let limits = TiltLimits::new(angle, rate, acceleration);
        let mut state = AxisState::default();
        let (mut largest, mut demand) = ([0.0_f64; 4], 0.0);
        let mut random = 1_u64;
        for k in 0..200_000 {
            if k % 50 == 0 {
                random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                demand = acceleration * [-3.0, -0.3, 0.3, 3.0, 3.0, -3.0, 50.0, -50.0][(random >> 61) as usize];
            }
            let next = limits.nearest_acceleration(&state, demand, step);
            let slope = (next - state.tilt_acceleration) / step;
            let tilt_rate = state.tilt_rate + step * next;
            let tilt = state.tilt + 0.5 * step * (state.tilt_rate + tilt_rate);
            state = AxisState { tilt, tilt_rate, tilt_acceleration: next, ..state };
            let reached =
                [tilt / angle, tilt_rate / rate, next / acceleration, slope / (limits.build_up * acceleration)];
            largest = core::array::from_fn(|i| largest[i].max(reached[i].abs()));
        }
        largest
    }

    #[test]
    fn all_limits_are_kept_and_reached_under_any_demand() {
        for limits in LIMITS {
            for step in [0.0005, 0.002, 0.01] {
                let largest = driven(limits, step);
                for (value, over) in largest.into_iter().zip([1e-3, 1e-3, 1e-12, 1e-9]) {
                    assert!((0.7..1.0 + over).contains(&value), "{largest:?} of {limits:?}, {step} s");
                }
            }
        }
    }

    #[test]
    fn demands_within_all_bounds_are_not_changed() {
        let limits = TiltLimits::new(0.257, 0.05, 0.4);
        let state = AxisState { tilt: 0.1, tilt_rate: 0.02, tilt_acceleration: 0.1, ..AxisState::default() };
        for demanded in [0.1, 0.104, 0.096] {
            assert_eq!(limits.nearest_acceleration(&state, demanded, 0.001), demanded);
        }
        assert_eq!(limits.nearest_acceleration(&state, 1.0, 0.001), 0.1 + 15.0 * 0.4 * 0.001);
    }

    #[test]
    fn what_is_approached_is_at_its_limit_where_an_acceleration_is_at_its_bound() {
        let limits = TiltLimits::new(0.257, 0.05, 0.4);
        let step = 1e-9;
        let fast = AxisState { tilt: 0.0, tilt_rate: 0.04, tilt_acceleration: 0.2, ..AxisState::default() };
        let far = AxisState { tilt: 0.25, tilt_rate: 0.01, tilt_acceleration: 0.1, ..AxisState::default() };
        for (state, limited, limit) in [(fast, 1, 0.05), (far, 0, 0.257)] {
            let without_acceleration = AxisState { tilt_acceleration: 0.0, ..state };
            let largest = limits.nearest_acceleration(&without_acceleration, 0.0, step);
            assert_eq!(largest, 0.0, "there is room");
            let bound = TiltLimits { build_up: 1e12, ..limits };
            let by = |demanded| {
                TiltLimits { acceleration: 1e12, ..if limited == 1 { limits } else { bound } }
                    .nearest_acceleration(&state, demanded, step)
            };
            let found = limits.approached(state.tilt, state.tilt_rate, by(1e6))[limited];
            assert!((found - limit).abs() < 1e-6, "{found} beside {limit}");
        }
    }
}
