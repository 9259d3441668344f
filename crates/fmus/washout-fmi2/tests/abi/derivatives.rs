//! Derivatives of inputs and outputs, against motion that is known in closed form.

use moris_fmu_host::{Instance, Status};
use moris_washout::presets;

use crate::fixture::*;

/// Break frequency of all poles of the surge's high-pass filter, and of the yaw's \[rad/s\].
const A: f64 = 2.0;
/// The slope of the input.
const SLOPE: f64 = 0.3;
/// Communication step \[s\]; the washout divides it.
const STEP: f64 = 0.02;

/// The paper's set without tilt and without compensation, so that its channels are plain
/// filters s^4/(s + A)^4.
fn plain_filters() -> Instance {
    let mut instance = open().instantiate("washout").unwrap();
    let parameters = [
        ("splitter.x.omega1", A),
        ("splitter.x.omega2", A),
        ("angular.yaw.omega1", A),
        ("angular.yaw.omega2", A),
        ("tilt.angleLimit", 1e-9),
        ("compensation", 1.0),
        ("washoutLocation", 2.0),
    ];
    instance.initialize(&[&presets::values(presets::PAPER)[..], &parameters].concat(), None).unwrap();
    instance
}

/// Ramps an input from 0 by [`SLOPE`], with or without telling the slope; calls `look` with the
/// time after each step.
fn ramp(instance: &mut Instance, name: &str, with_slope: bool, mut look: impl FnMut(&mut Instance, f64)) {
    let input = [reference(name)];
    for step in 0..100 {
        let time = f64::from(step) * STEP;
        assert_eq!(instance.set_real(&input, &[SLOPE * time]), Status::Ok);
        if with_slope {
            assert_eq!(instance.set_real_input_derivatives(&input, &[SLOPE]), Status::Ok);
        }
        instance.step(time, STEP).unwrap();
        look(instance, time + STEP);
    }
}

/// Response of 1/(s + A)^4 to an impulse of [`SLOPE`], and its first three time derivatives.
fn response(time: f64) -> [f64; 4] {
    let factor = SLOPE / 6.0 * (-A * time).exp();
    let (t, t2, t3) = (time, time * time, time * time * time);
    [
        factor * t3,
        factor * (3.0 * t2 - A * t3),
        factor * (6.0 * t - 6.0 * A * t2 + A * A * t3),
        factor * (6.0 - 18.0 * A * t + 9.0 * A * A * t2 - A * A * A * t3),
    ]
}

fn derivative(instance: &mut Instance, name: &str) -> f64 {
    let mut value = [f64::NAN];
    assert_eq!(instance.get_real_output_derivatives(&[reference(name)], &mut value), Status::Ok);
    value[0]
}

#[track_caller]
fn assert_near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value}, not {expected}");
}

/// A ramp SLOPE/s^2 of surge makes the position SLOPE/(s + A)^4.
#[test]
fn a_ramp_of_surge_moves_the_platform_as_the_closed_form_says() {
    let mut instance = plain_filters();
    ramp(&mut instance, "vehicle.specificForce.x", true, |instance, time| {
        let [position, velocity, acceleration, jerk] = response(time);
        assert_near(instance.get("platform.position.x").unwrap(), position, 1e-12);
        assert_near(derivative(instance, "platform.position.x"), velocity, 1e-12);
        assert_near(instance.get("platform.velocity.x").unwrap(), velocity, 1e-12);
        assert_near(derivative(instance, "platform.velocity.x"), acceleration, 1e-12);
        assert_near(instance.get("platform.acceleration.x").unwrap(), acceleration, 1e-12);
        // Differenced over an internal step of 1 ms: off by half a step's change of it, at most 4 A SLOPE a second.
        assert_near(derivative(instance, "platform.acceleration.x"), jerk, 0.5e-3 * 4.0 * A * SLOPE);
        assert_eq!(instance.get("status.actuatorLimited").unwrap(), 0.0);
    });
}

/// The legs of a platform that only surges: L = |p + c|, with c from platform joint,
/// base joint and height.
#[test]
fn the_legs_derivatives_are_those_of_their_lengths() {
    let mut instance = plain_filters();
    let mut value = |name: String| instance.get(&name).unwrap();
    let joints: [[f64; 3]; 6] = std::array::from_fn(|leg| {
        ["x", "y", "z"].map(|axis| {
            let [platform, base] = ["platform", "base"].map(|end| value(format!("rig.{end}[{}].{axis}", leg + 1)));
            let height = if axis == "z" { value("rig.neutralHeight".into()) } else { 0.0 };
            platform - base + height
        })
    });
    ramp(&mut instance, "vehicle.specificForce.x", true, |instance, time| {
        let [position, velocity, acceleration, _] = response(time);
        for (leg, [x, y, z]) in joints.into_iter().enumerate() {
            let along = position + x;
            let length = (along * along + y * y + z * z).sqrt();
            let rate = along * velocity / length;
            let rate_of_rate = (velocity * velocity + along * acceleration - rate * rate) / length;
            let [length_name, velocity_name] =
                ["length", "velocity"].map(|what| format!("actuator[{}].{what}", leg + 1));
            assert_near(instance.get(&length_name).unwrap(), length, 1e-8);
            assert_near(derivative(instance, &length_name), rate, 1e-8);
            assert_near(derivative(instance, &velocity_name), rate_of_rate, 1e-8);
        }
    });
}

/// A ramp SLOPE/s^2 of the yaw rate makes the yaw s SLOPE/(s + A)^4.
#[test]
fn a_ramp_of_the_yaw_rate_turns_the_platform_as_the_closed_form_says() {
    let mut instance = plain_filters();
    ramp(&mut instance, "vehicle.angularVelocity.z", true, |instance, time| {
        let [_, yaw, rate, _] = response(time);
        assert_near(instance.get("platform.orientation.yaw").unwrap(), yaw, 1e-12);
        assert_near(derivative(instance, "platform.orientation.yaw"), rate, 1e-12);
        assert_near(instance.get("platform.angularVelocity.z").unwrap(), rate, 1e-12);
        // The mean over the last internal step, of 1 ms.
        let mean = (rate - response(time - 1e-3)[2]) / 1e-3;
        assert_near(derivative(instance, "platform.angularVelocity.z"), mean, 1e-10);
    });
}

/// Without its slope a ramp is a staircase, which is another motion.
#[test]
fn a_slope_that_is_not_told_is_missed() {
    let mut instance = plain_filters();
    let mut farthest: f64 = 0.0;
    ramp(&mut instance, "vehicle.specificForce.x", false, |instance, time| {
        farthest = farthest.max((instance.get("platform.position.x").unwrap() - response(time)[0]).abs());
    });
    assert!(farthest > 1e-5, "{farthest}");
}
