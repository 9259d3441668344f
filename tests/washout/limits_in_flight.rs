//! Limits changed in motion, and machines slower than their demand: all limits hold.

use moris_washout::interface::RollPitchYaw;
use moris_washout::{Input, Parameters, Washout};
use nalgebra::Vector3;

use crate::common::limits::Watch;
use crate::common::random::Random;
use crate::common::{G, accelerating, parameters};

/// Pushes along one axis for `change_at` seconds, changes a parameter, and pushes on for 4 s. The
/// legs and the platform keep their limits all the time. The platform's old limits apply until it
/// can have come to rest within the new ones.
fn push_and_change(set: &[(&str, f64)], push: Vector3<f64>, change_at: f64, name: &str, value: f64) {
    const STEP: f64 = 0.001;
    let before = parameters(set);
    let mut washout = Washout::new(&before).unwrap();
    let mut watch = Watch::new(&before, &washout.output());
    let input = accelerating(push.x, push.y, push.z);
    for _ in 0..(change_at / STEP).round() as usize {
        washout.step(&input, STEP);
        watch.check(&washout.output(), STEP);
    }
    let moving = washout.output().velocity;
    assert!(moving.norm() > 0.5, "{moving} m/s are too slow for this test");
    let changed: Vec<_> = set.iter().copied().chain([(name, value)]).collect();
    let after = parameters(&changed);
    washout.retune(&after).unwrap();
    // The old limits stop the platform from 1 m/s in 0.1 s, the legs' in about twice that.
    for step in 0..4000 {
        if step == 600 {
            watch = Watch::new(&after, &washout.output());
        }
        washout.step(&input, STEP);
        let output = washout.output();
        watch.check(&output, STEP);
        assert!(output.stroke_margin >= 0.0, "{name} = {value}: a stroke margin of {} m", output.stroke_margin);
    }
}

#[test]
fn a_tighter_acceleration_limit_in_motion_throws_no_leg_out_of_its_stroke() {
    let slow_x = [("splitter.x.omega1", 1.0), ("splitter.x.omega2", 1.0)];
    for limit in [1.0, 0.5, 0.1, 0.01] {
        push_and_change(&slow_x, Vector3::new(6.0, 0.0, 0.0), 0.25, "safety.x.accelerationLimit", limit);
    }
    let slow_z = [("splitter.z.omega1", 1.0), ("splitter.z.omega2", 1.0)];
    push_and_change(&slow_z, Vector3::new(0.0, 0.0, 6.0), 0.25, "safety.z.accelerationLimit", 1.0);
    push_and_change(&[], Vector3::new(8.0, 0.0, 0.0), 0.2, "safety.x.accelerationLimit", 0.2);
}

#[test]
fn a_tighter_limit_of_position_or_velocity_in_motion_throws_no_leg_out_of_its_stroke() {
    let slow_x = [("splitter.x.omega1", 1.0), ("splitter.x.omega2", 1.0)];
    for limit in [0.3, 0.03, 0.0003] {
        for name in ["safety.x.positionLimit", "safety.x.velocityLimit"] {
            push_and_change(&slow_x, Vector3::new(6.0, 0.0, 0.0), 0.25, name, limit);
        }
    }
}

#[test]
fn a_limit_of_velocity_below_the_speed_slows_the_platform_with_all_of_its_acceleration() {
    let set = [("splitter.x.omega1", 1.0), ("splitter.x.omega2", 1.0)];
    let (parameters_before, lowered) =
        (parameters(&set), parameters(&[&set[..], &[("safety.x.velocityLimit", 0.7)]].concat()));
    let mut washout = Washout::new(&parameters_before).unwrap();
    let input = accelerating(6.0, 0.0, 0.0);
    for _ in 0..230 {
        washout.step(&input, 0.001);
    }
    let mut fastest = washout.output().velocity.x;
    assert!(fastest > 0.85, "{fastest}");
    washout.retune(&lowered).unwrap();
    for _ in 0..100 {
        washout.step(&input, 0.001);
        let output = washout.output();
        let expected = (fastest - 10.0 * 0.001).max(0.7);
        assert!((output.velocity.x - expected).abs() < 1e-9, "{} m/s, not {expected}", output.velocity.x);
        assert!(output.safety_active, "the limit shows in the status");
        fastest = output.velocity.x;
    }
}

/// Square waves far beyond the machine: the sign of a sine.
fn square(amplitude: f64, omega: f64, time: f64) -> f64 {
    amplitude.copysign((omega * time).sin())
}

#[test]
fn a_slow_machine_keeps_its_limits_against_bang_bang_rates() {
    let slow = [
        ("actuator.accelerationLimit", 5.4),
        ("actuator.velocityLimit", 2.0),
        ("safety.x.positionLimit", 0.04),
        ("safety.y.positionLimit", 0.04),
        ("safety.z.positionLimit", 0.08),
    ];
    let parameters = parameters(&slow);
    const STEP: f64 = 0.000_999;
    for omegas in [[2.0, 3.0, 5.0], [7.0, 5.3, 3.1], [11.0, 2.3, 17.0], [1.1, 1.7, 0.7]] {
        let mut washout = Washout::new(&parameters).unwrap();
        let mut watch = Watch::new(&parameters, &washout.output());
        for step in 0..4500 {
            let time = f64::from(step) * STEP;
            let input = Input {
                angular_velocity: Vector3::from(omegas.map(|omega| square(159.0, omega, time))),
                orientation: RollPitchYaw::new(0.0, 1.57 * time.sin(), 0.0),
                lean: square(0.5, 4.1, time),
                ..Input::default()
            };
            washout.step(&input, STEP);
            watch.check(&washout.output(), STEP);
        }
    }
}

#[test]
fn a_slow_machine_keeps_its_limits_at_irregular_steps() {
    let slow = [
        ("actuator.accelerationLimit", 2.2),
        ("actuator.velocityLimit", 0.65),
        ("safety.x.accelerationLimit", 1.5),
        ("safety.y.accelerationLimit", 2.7),
        ("safety.z.accelerationLimit", 3.7),
    ];
    let parameters = parameters(&slow);
    for seed in 0..crate::cases::cases(20, 6) {
        ride_irregularly(&parameters, seed);
    }
}

/// 1500 steps of 1e-6 to 0.1 s, each of which the input goes through linearly.
fn ride_irregularly(parameters: &Parameters, seed: u64) {
    let mut washout = Washout::new(parameters).unwrap();
    let mut watch = Watch::new(parameters, &washout.output());
    let mut random = Random::new(seed);
    let omegas = [random.between(1.0, 6.0), random.between(1.0, 6.0), random.between(1.0, 6.0)];
    let (mut time, mut start) = (0.0, Input::default());
    for _ in 0..1500 {
        let step = 1e-6 * 1e5_f64.powf(random.between(0.0, 1.0));
        time += step;
        let [x, y, z] = omegas.map(|omega| square(1.0, omega, time));
        let end = Input {
            specific_force: Vector3::new(20.0 * x, 20.0 * y, G + 20.0 * z),
            angular_velocity: Vector3::new(9.0 * y, 9.0 * z, 9.0 * x),
            lean: 0.4 * z,
            ..Input::default()
        };
        washout.step_between(&start, &end, step);
        watch.check(&washout.output(), step);
        start = end;
    }
}
