//! The washout's behaviour where the paper is silent, contradicts itself or errs. Each
//! erratum has one test.

use moris_washout::cueing::compensation::{added_gravity, centripetal, tangential};
use moris_washout::cueing::gravitational::Tilt;
use moris_washout::interface::{RollPitchYaw, StructureParameters};
use moris_washout::motion::orientation::Orientation;
use moris_washout::platform::LocationFrame;
use moris_washout::{Input, Washout};
use nalgebra::Vector3;

use crate::common::rotation::rotate_x;
use crate::common::{G, accelerating, from_neutral, ride, washout};

#[test]
fn forward_force_raises_the_nose() {
    // Eq. (8), not eqs. (5) and (7) with the nomenclature's g = (0, 0, g). Positive pitch is nose down.
    let mut washout = washout(&[]);
    ride(&mut washout, 30.0, 0.01, |_| accelerating(1.0, 0.0, 0.0), |_, _| {});
    assert!((washout.output().orientation.pitch + (1.0 / G).asin()).abs() < 1e-6);
    assert!((washout.output().felt_specific_force.x - 1.0).abs() < 1e-6);
}

#[test]
fn force_to_the_left_rolls_to_the_right() {
    let mut washout = washout(&[]);
    ride(&mut washout, 30.0, 0.01, |_| accelerating(0.0, 1.0, 0.0), |_, _| {});
    assert!((washout.output().orientation.roll - (1.0 / G).asin()).abs() < 1e-6);
    assert!((washout.output().felt_specific_force.y - 1.0).abs() < 1e-6);
}

#[test]
fn at_rest_the_specific_force_is_gravity_upward() {
    assert_eq!(washout(&[]).output().felt_specific_force, Vector3::new(0.0, 0.0, G));
}

#[test]
fn an_upright_head_is_above_the_platforms_origin() {
    // Eq. (4) as printed has y = (h - b) + b sin(lean).
    let structure = StructureParameters::default();
    assert_eq!(LocationFrame::new(&structure, 0.0).point, Vector3::new(0.0, 0.0, 1.2));
    for lean in [-0.5, -0.1, 0.2, 0.6] {
        let [x, y, z] = rotate_x(lean, [0.0, 0.0, structure.torso_length]);
        let seat = structure.head_height - structure.torso_length;
        let head = LocationFrame::new(&structure, lean);
        assert!((head.point - Vector3::new(x, y, seat + z)).norm() < 1e-15);
        // Leaning to the right moves the head to the right, which is -y.
        assert_eq!(head.point.y < 0.0, lean > 0.0);
    }
}

/// The largest disturbance of the felt surge by pitching alone, with this item of `compensation`.
/// The platform pitches because the vehicle does. Gravity's part of the felt surge is subtracted.
fn disturbance_by_pitching(compensation: f64) -> f64 {
    let mut washout =
        washout(&[("compensation", compensation), ("splitter.x.omega1", 0.2), ("splitter.x.omega2", 0.2)]);
    let mut largest = 0.0_f64;
    let pitching =
        |t: f64| Input { angular_velocity: Vector3::new(0.0, 0.12 * (6.0 * t).sin(), 0.0), ..Input::default() };
    ride(&mut washout, 10.0, 0.001, pitching, |t, output| {
        assert!(!output.safety_active && !output.actuator_limited);
        if t > 5.0 {
            largest = largest.max((output.felt_specific_force.x + G * output.orientation.pitch.sin()).abs());
        }
    });
    largest
}

/// The largest error of the felt surge and sway on a vehicle that turns without acceleration.
/// The vehicle pitches and rolls.
fn error_of_turning(compensation: f64) -> f64 {
    let slow = [
        ("splitter.x.omega1", 0.03),
        ("splitter.x.omega2", 0.03),
        ("splitter.y.omega1", 0.03),
        ("splitter.y.omega2", 0.03),
    ];
    let mut washout = washout(&[&slow[..], &[("compensation", compensation), ("tilt.angleLimit", 1e-6)]].concat());
    let mut largest = 0.0_f64;
    // The angles swing about zero from the beginning.
    let turning = |t: f64| {
        let rates = (t / 5.0).min(1.0).powi(2) * Vector3::new(0.1 * (4.0 * t).cos(), 0.12 * (5.0 * t).cos(), 0.0);
        Input { angular_velocity: rates, ..Input::default() }
    };
    ride(&mut washout, 20.0, 0.001, turning, |t, output| {
        assert!(!output.safety_active && !output.actuator_limited);
        if t > 10.0 {
            largest = largest.max(output.felt_specific_force.xy().amax());
        }
    });
    largest
}

#[test]
fn the_gravity_that_the_angular_channel_s_tilt_adds_is_compensated() {
    let (full, gravity) = (error_of_turning(3.0), error_of_turning(4.0));
    assert!(full > 0.15, "{full}");
    assert!(gravity < 0.15 * full, "{gravity} of {full}");
}

#[test]
fn gravity_that_tilt_coordination_asks_for_is_not_compensated() {
    // The tilt alone: nothing is added, whatever its angles.
    for (roll, pitch) in [(0.0, 0.0), (0.3, -0.2), (-0.38, 0.38)] {
        let rotation = Orientation::new(RollPitchYaw::new(roll, pitch, 0.0)).rotation;
        assert!(added_gravity(&rotation, &Tilt { roll, pitch }, G).amax() < 1e-14);
    }
    // A small angle more about x or y: g times the angle, across.
    let turned = |roll, pitch| {
        added_gravity(&Orientation::new(RollPitchYaw::new(roll, pitch, 0.0)).rotation, &Tilt::default(), G)
    };
    assert!((turned(0.0, 1e-6) - Vector3::new(-1e-6 * G, 0.0, 0.0)).amax() < 1e-10);
    assert!((turned(1e-6, 0.0) - Vector3::new(0.0, 1e-6 * G, 0.0)).amax() < 1e-10);
}

#[test]
fn the_tangential_term_is_the_larger_and_is_compensated() {
    let (none, paper, full) =
        (disturbance_by_pitching(1.0), disturbance_by_pitching(2.0), disturbance_by_pitching(3.0));
    assert!(none > 0.7, "{none}");
    assert!(paper > 0.9 * none, "what the paper compensates hardly matters: {paper} of {none}");
    assert!(full < 0.2 * none, "{full} of {none}");
}

#[test]
fn tangential_and_centripetal_terms_are_those_of_circular_motion() {
    // A point on a circle of radius 2 in the x-y plane, at the angle `angle`: p'' from the second
    // derivatives of the coordinates.
    let (radius, angle, rate, acceleration) = (2.0, 0.7_f64, 1.3, -0.4);
    let (s, c) = angle.sin_cos();
    let arm = Vector3::new(radius * c, radius * s, 0.0);
    let expected = Vector3::new(
        radius * (-c * rate * rate - s * acceleration),
        radius * (-s * rate * rate + c * acceleration),
        0.0,
    );
    let ours = tangential(Vector3::new(0.0, 0.0, acceleration), arm) + centripetal(Vector3::new(0.0, 0.0, rate), arm);
    assert!((ours - expected).norm() < 1e-15);
}

#[test]
fn eq_8_takes_the_components_in_the_heads_axes() {
    // In the head's axes the steady state is exact; in the base's it is far from that.
    let mut washout = washout(&[]);
    ride(&mut washout, 60.0, 0.01, |_| accelerating(2.5, 2.0, 0.0), |_, _| {});
    let output = washout.output();
    assert!((output.felt_specific_force.x - 2.5).abs() < 1e-4);
    assert!((output.felt_specific_force.y - 2.0).abs() < 1e-4);
    let in_base = washout.motion().orientation.rotation * Vector3::new(2.5, 2.0, 0.0);
    let pitch_from_base = -(in_base.x / G).asin();
    assert!((-G * pitch_from_base.sin() - 2.5).abs() > 0.05);
}

#[test]
fn compensation_does_not_drift() {
    // Ten minutes of tilting to and fro, lopsided, so that the compensated acceleration has a mean.
    let mut washout: Washout = washout(&[("solver.maxStep", 0.005)]);
    let input = |t: f64| accelerating(1.0 + 1.5 * (0.4 * t).sin(), 0.7 + 1.2 * (0.55 * t).sin(), 0.0);
    let mut mean = Vector3::zeros();
    let mut count = 0.0;
    ride(&mut washout, 600.0, 0.005, input, |t, output| {
        assert!(!output.safety_active && !output.actuator_limited, "at {t}");
        if t > 60.0 {
            mean += from_neutral(output);
            count += 1.0;
        }
    });
    mean /= count;
    assert!(mean.amax() < 0.01, "{mean}");
}
