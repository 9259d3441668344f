//! The evaluator's output, against the commanded pose differentiated numerically.

use moris_washout::interface::RollPitchYaw;
use moris_washout::{Input, Output, Parameters};
use nalgebra::Vector3;

use crate::common::manoeuvres::smooth_step;
use crate::common::rotation::{Vec3, rotate_x, to_base, to_platform, turn};
use crate::common::{G, parameters, washout};

const STEP: f64 = 0.001;

/// Everything moves, slowly enough for the tilt to follow.
fn moving(t: f64, lean: f64) -> Input {
    let wave =
        |amplitude: f64, omega: f64, phase: f64| smooth_step(t, 0.0, 4.0) * amplitude * (omega * t + phase).sin();
    Input {
        specific_force: Vector3::new(wave(0.6, 0.7, 0.0), wave(0.5, 0.5, 1.0), G + wave(0.8, 3.0, 2.0)),
        angular_velocity: Vector3::new(wave(0.15, 1.5, 0.0), wave(0.1, 1.1, 1.0), wave(0.2, 0.9, 2.0)),
        orientation: RollPitchYaw::new(wave(0.1, 1.5, 1.6), wave(0.08, 1.1, 2.6), wave(0.2, 0.9, 3.6)),
        lean,
        ..Input::default()
    }
}

fn angles(output: &Output) -> Vec3 {
    let RollPitchYaw { roll, pitch, yaw } = output.orientation;
    [roll, pitch, yaw]
}

/// The location in the platform frame, and the lean of the frame there.
fn location(parameters: &Parameters, name: &str, lean: f64) -> (Vec3, f64) {
    match name {
        "head" => {
            let (h, b) = (parameters.structure.head_height, parameters.structure.torso_length);
            let [x, y, z] = rotate_x(lean, [0.0, 0.0, b]);
            ([x, y, h - b + z], lean)
        }
        "platform" => ([0.0; 3], 0.0),
        _ => ([0.1, -0.2, 0.9], 0.0),
    }
}

/// Rides, and compares what is felt in the middle of every three outputs with the
/// differences of the three.
fn compare(item: f64, name: &str, lean: f64) {
    let changed =
        [("washoutLocation", item), ("washoutPoint.x", 0.1), ("washoutPoint.y", -0.2), ("washoutPoint.z", 0.9)];
    let parameters = parameters(&changed);
    let mut washout = washout(&changed);
    let (point, frame_lean) = location(&parameters, name, lean);
    let at = |output: &Output| {
        let arm = to_base(angles(output), point);
        output.position + Vector3::from(arm)
    };
    let mut outputs = Vec::new();
    let mut largest = [0.0_f64; 6];
    for k in 0..20_000 {
        let t = f64::from(k) * STEP;
        washout.step_between(&moving(t, lean), &moving(t + STEP, lean), STEP);
        outputs.push(washout.output());
        let output = outputs[outputs.len() - 1];
        assert!(!output.safety_active && !output.actuator_limited);
        for (largest, moved) in largest.iter_mut().zip(output.velocity.iter().chain(output.angular_velocity.iter())) {
            *largest = largest.max(moved.abs());
        }
    }
    assert!(largest.iter().all(|&l| l > 0.005), "something stands still: {largest:?}");
    // The lean is there at once; the tilt needs a moment to take it off.
    for three in outputs[5000..].windows(3) {
        let acceleration = (at(&three[2]) - 2.0 * at(&three[1]) + at(&three[0])) / (STEP * STEP);
        let force = acceleration + Vector3::new(0.0, 0.0, G);
        let in_head = rotate_x(-frame_lean, to_platform(angles(&three[1]), force.into()));
        let error = (three[1].felt_specific_force - Vector3::from(in_head)).amax();
        assert!(error < 5e-3, "{name}, lean {lean}: {error} m/s2");
        let omega = turn(angles(&three[0]), angles(&three[2]), 2.0 * STEP);
        let in_head = rotate_x(-frame_lean, to_platform(angles(&three[1]), omega));
        let error = (three[1].felt_angular_velocity - Vector3::from(in_head)).amax();
        assert!(error < 1e-4, "{name}, lean {lean}: {error} rad/s");
    }
}

#[test]
fn agrees_at_the_head() {
    compare(1.0, "head", 0.0);
    compare(1.0, "head", 0.2);
}

#[test]
fn agrees_at_the_platforms_origin() {
    compare(2.0, "platform", 0.0);
    compare(2.0, "platform", 0.2);
}

#[test]
fn agrees_at_another_point() {
    compare(3.0, "custom", 0.0);
    compare(3.0, "custom", 0.2);
}
