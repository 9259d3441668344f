//! The tilt tracker: limits never exceeded, no overshoot, hardly slower than possible, and no
//! lag inside the limits.

use moris_washout::cueing::gravitational::{GravitationalStrategy, tilt_target};
use moris_washout::interface::{TiltParameters, TiltTracking};
use moris_washout::{Washout, presets};
use nalgebra::Vector3;
use proptest::prelude::*;

use crate::common::random::Random;
use crate::common::{G, accelerating, cases, parameters, ride_between};

/// The force at the head for which the pitch target is this, with no sway.
fn force_for_pitch(pitch: f64) -> Vector3<f64> {
    Vector3::new(-G * pitch.sin(), 0.0, 0.0)
}

fn tracker_after(seconds: f64, step: f64, limits: &TiltParameters, pitch: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut tracker = GravitationalStrategy::default();
    (0..(seconds / step).round() as usize)
        .map(|k| {
            tracker.advance(force_for_pitch(pitch((k + 1) as f64 * step)), G, 0.0, limits, step, step);
            tracker.pitch.position
        })
        .collect()
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn limits_hold_for_hostile_targets(
        seed: u64, rate_limit in 0.01..0.5, acceleration_limit in 0.02..3.0, step in 0.0005..0.02, hold in 1..400_u64,
        smooth: bool,
    ) {
        let tracking = if smooth { TiltTracking::Smooth } else { TiltTracking::Exact };
        let limits = TiltParameters { rate_limit, acceleration_limit, angle_limit: 0.35, tracking };
        let mut tracker = GravitationalStrategy::default();
        let mut random = Random::new(seed);
        let (mut force, mut lean) = (Vector3::zeros(), 0.0);
        let mut last = tracker;
        for k in 0..3000 {
            if k % hold == 0 {
                force = Vector3::from_fn(|_, _| random.between(-20.0, 20.0));
                lean = random.between(-0.6, 0.6);
            }
            tracker.advance(force, G, lean, &limits, step, step);
            for (now, before) in [(tracker.pitch, last.pitch), (tracker.roll, last.roll)] {
                let rounding = 1.0 + 1e-9;
                prop_assert!(now.velocity.abs() <= rate_limit * rounding);
                prop_assert!(now.acceleration.abs() <= acceleration_limit * rounding);
                prop_assert!(now.position.abs() <= 0.35);
                prop_assert!((now.velocity - before.velocity).abs() <= acceleration_limit * step * rounding);
                // What is reported is what is done.
                let moved = now.position - before.position;
                prop_assert!((moved - 0.5 * (now.velocity + before.velocity) * step).abs() < 1e-15);
            }
            last = tracker;
        }
    }

    #[test]
    fn a_step_is_reached_without_overshoot_in_nearly_the_shortest_time(
        angle in 0.002..0.34, rate_limit in 0.02..0.3, acceleration_limit in 0.05..2.0,
    ) {
        let tracking = TiltTracking::Exact;
        let limits = TiltParameters { rate_limit, acceleration_limit, angle_limit: 0.35, tracking };
        let to_full_rate = rate_limit * rate_limit / acceleration_limit;
        let shortest = if angle >= to_full_rate {
            angle / rate_limit + rate_limit / acceleration_limit
        } else {
            2.0 * f64::sqrt(angle / acceleration_limit)
        };
        let positions = tracker_after(1.5 * shortest + 1.0, 0.001, &limits, |_| angle);
        let farthest = positions.iter().copied().fold(0.0, f64::max);
        prop_assert!(farthest <= 1.005 * angle, "overshoot to {farthest} of {angle}");
        let arrived = positions.iter().rposition(|p| (p - angle).abs() > 0.002 * angle).unwrap() + 1;
        let time = arrived as f64 * 0.001;
        prop_assert!(time <= 1.05 * shortest + 0.001, "{time} s, at best {shortest} s");
    }
}

#[test]
fn a_target_inside_the_limits_is_followed_within_20_ms() {
    let limits = parameters(&[]).tilt;
    for (amplitude, omega) in [(0.03_f64, 1.2_f64), (0.1, 0.5), (0.01, 4.0)] {
        assert!(amplitude * omega < limits.rate_limit && amplitude * omega * omega < limits.acceleration_limit);
        for (tracking, step) in TiltTracking::ALL.iter().flat_map(|&law| [(law, 0.001), (law, 0.01)]) {
            let limits = TiltParameters { tracking, ..limits };
            let positions = tracker_after(30.0, step, &limits, |t| amplitude * (omega * t).sin());
            for (k, position) in positions.iter().enumerate().skip((10.0 / step) as usize) {
                let target = amplitude * (omega * (k + 1) as f64 * step).sin();
                assert!((position - target).abs() < 0.020 * amplitude * omega, "{tracking:?}, step {step}, {k}");
            }
        }
    }
}

/// A smooth tilt reaches a target that jumps without overshoot, and its acceleration has no jump.
#[test]
fn a_smooth_tilt_reaches_what_jumps_without_overshoot_and_without_a_jump_of_its_own() {
    let tracking = TiltTracking::Smooth;
    let limits = TiltParameters { rate_limit: 0.0524, acceleration_limit: 0.4, angle_limit: 0.257, tracking };
    for (angle, step) in [(0.01, 0.001), (0.1, 0.001), (0.25, 0.001), (0.1, 0.01)] {
        let positions = tracker_after(12.0, step, &limits, |_| angle);
        let farthest = positions.iter().copied().fold(0.0, f64::max);
        assert!(farthest <= 1.01 * angle, "overshoot to {farthest} of {angle}");
        assert!((positions[positions.len() - 1] - angle).abs() < 1e-6, "{angle}");
        let thirds = positions.windows(4).map(|p| p[3] - 3.0 * p[2] + 3.0 * p[1] - p[0]);
        let slope = thirds.fold(0.0_f64, |most, third| most.max(third.abs())) / step.powi(3);
        assert!(slope <= 6.5, "slope of the acceleration: {slope} rad/s3");
    }
}

#[test]
fn the_target_is_eq_8_kept_inside_the_angle_limit() {
    let (target, clipped) = tilt_target(Vector3::new(2.0, 1.0, 0.3), G, 0.1, 0.35);
    let pitch = -(2.0 / G).asin();
    assert!((target.pitch - pitch).abs() < 1e-15);
    assert!((target.roll - ((1.0 / (G * pitch.cos())).asin() - 0.1)).abs() < 1e-15);
    assert!(!clipped);
    for force in [Vector3::new(50.0, 50.0, 0.0), Vector3::new(-50.0, -50.0, 0.0), Vector3::new(9.9, -9.9, 0.0)] {
        let (target, clipped) = tilt_target(force, G, 0.0, 0.35);
        assert!(target.pitch.abs() <= 0.35 && target.roll.abs() <= 0.35 && clipped);
    }
}

/// Each angle's tracker and the limit of the angles can limit the tilt alone.
#[test]
fn a_limit_of_one_angle_alone_is_reported() {
    let quick =
        TiltParameters { rate_limit: 1e3, acceleration_limit: 1e6, angle_limit: 0.35, tracking: TiltTracking::Exact };
    let slow = TiltParameters { rate_limit: 0.05, ..quick };
    let limited = |force: [f64; 2], limits: &TiltParameters| {
        let mut tracker = GravitationalStrategy::default();
        // Fast limits reach the target, an angle limit included, within these steps.
        for _ in 0..20 {
            tracker.advance(Vector3::new(force[0], force[1], 0.0), G, 0.0, limits, 0.01, 0.01);
        }
        tracker.limited
    };
    assert!(!limited([1.0, 1.0], &quick));
    assert!(limited([1.0, 0.0], &slow));
    assert!(limited([0.0, 1.0], &slow));
    assert!(limited([8.0, 0.0], &quick));
}

/// Tilt that is tracked turns the vertical part of the low-frequency force into the tilt's own
/// target.
#[test]
fn a_vertical_force_makes_no_tilt_go_to_and_fro() {
    for set in [presets::PAPER, presets::CLASSICAL] {
        for (heave, omega) in [(1.5, 3.0), (4.0, 3.0), (-5.0, 0.7)] {
            let mut washout = Washout::new(&presets::parameters(set)).unwrap();
            let input = |time: f64| {
                accelerating(0.3 * (0.4 * time).sin(), 0.05 * (1.3 * time).cos(), heave * (omega * time).sin())
            };
            let (mut turns, mut rate, mut before) = (0, 0.0, 0.0);
            ride_between(&mut washout, 15.0, 0.001, input, |_, output| {
                let change = output.tilt_roll_rate - rate;
                turns += usize::from(change * before < 0.0);
                (rate, before) = (output.tilt_roll_rate, change);
            });
            assert!(turns < 150, "heave of {heave} m/s2: {turns} changes of direction in 15,000 steps");
        }
    }
}
