//! Equal rotations give equal motion, whatever angles describe them.

use std::f64::consts::{PI, TAU};

use moris_washout::cueing::conditioning::{cue, forward_acceleration};
use moris_washout::interface::{AngularVelocityFrame, ConditioningParameters, GravityRemoval, RollPitchYaw};
use moris_washout::{Input, Output};
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

use crate::common::rotation::{Vec3, to_base, to_platform};
use crate::common::{G, cases, parameters, washout};

const REMOVALS: [GravityRemoval; 3] = [GravityRemoval::None, GravityRemoval::HeadVertical, GravityRemoval::Full];
const FRAMES: [AngularVelocityFrame; 2] = [AngularVelocityFrame::World, AngularVelocityFrame::Body];

/// The other angles of the same rotation.
fn flipped([roll, pitch, yaw]: Vec3) -> Vec3 {
    [roll + PI, PI - pitch, yaw + PI]
}

/// The same rotation with angles from -pi to pi, pitch from -pi/2 to pi/2.
fn principal(angles: Vec3) -> Vec3 {
    let angles = if angles[1].cos() < 0.0 { flipped(angles) } else { angles };
    angles.map(|angle| angle - TAU * (angle / TAU).round())
}

fn oriented([roll, pitch, yaw]: Vec3, force: Vec3, angular_velocity: Vec3) -> Input {
    Input {
        specific_force: force.into(),
        angular_velocity: angular_velocity.into(),
        orientation: RollPitchYaw::new(roll, pitch, yaw),
        ..Input::default()
    }
}

fn rotation(angles: RollPitchYaw) -> Rotation3<f64> {
    Rotation3::from_euler_angles(angles.roll, angles.pitch, angles.yaw)
}

/// The rates cued of an angular velocity, nothing scaled or limited.
fn rates(frame: AngularVelocityFrame, angles: Vec3, omega: Vec3) -> Vector3<f64> {
    let unlimited = ConditioningParameters {
        rate_limit: Vector3::repeat(1e6),
        angular_velocity_frame: frame,
        ..parameters(&[]).conditioning
    };
    cue(&oriented(angles, [0.0; 3], omega), &unlimited, G, 0.0).rates
}

proptest! {
    #![proptest_config(cases(2000))]

    #[test]
    fn a_cue_depends_on_the_rotation_alone(
        angles in [-3.0..3.0, -4.0..4.0, -3.0..3.0], omega in [-1.0..1.0, -1.0..1.0, -1.0..1.0],
        force in [-9.0..9.0, -9.0..9.0, -9.0..15.0], turns in [-3..3, -3..3, -3..3], lean in -0.4..0.4,
    ) {
        let shifted = |angles: Vec3| std::array::from_fn(|k| angles[k] + TAU * f64::from(turns[k]));
        for gravity_removal in REMOVALS {
            for angular_velocity_frame in FRAMES {
                let parameters =
                    ConditioningParameters { gravity_removal, angular_velocity_frame, ..parameters(&[]).conditioning };
                let found = |angles| {
                    let input = oriented(angles, force, omega);
                    (cue(&input, &parameters, G, lean), forward_acceleration(&input, &parameters, G))
                };
                let (expected, ahead) = found(angles);
                for others in [flipped(angles), shifted(angles), shifted(flipped(angles)), principal(angles)] {
                    let (cue, forward) = found(others);
                    prop_assert!((cue.force - expected.force).amax() < 1e-12);
                    prop_assert!((cue.rates - expected.rates).amax() < 1e-12);
                    prop_assert!((forward - ahead).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn rates_are_never_amplified_much_and_equal_in_both_frames(
        angles in [-PI..PI, -PI..PI, -PI..PI], omega in [-1.0..1.0, -1.0..1.0, -1.0..1.0],
    ) {
        let world = rates(AngularVelocityFrame::World, angles, to_base(angles, omega));
        let body = rates(AngularVelocityFrame::Body, angles, omega);
        prop_assert!((world - body).amax() < 1e-12);
        // Within 6 degrees of lying on its side or on end, and upside down: the angular velocity itself.
        let upright = to_base(angles, [0.0, 0.0, 1.0])[2];
        if upright <= 0.1 {
            prop_assert!((body - Vector3::from(omega)).amax() < 1e-12);
        }
        prop_assert!(body.norm() <= 4.0 * Vector3::from(omega).norm());
    }

    #[test]
    fn between_two_rotations_the_way_is_the_same_for_all_angles(
        angles in [-3.0..3.0, -4.0..4.0, -3.0..3.0], turn in [-0.2..0.2, -0.2..0.2, -0.2..0.2], fraction in 0.0..1.0,
    ) {
        let start = rotation(RollPitchYaw::new(angles[0], angles[1], angles[2]));
        let (roll, pitch, yaw) = (start * Rotation3::new(Vector3::from(turn))).euler_angles();
        let end = [roll, pitch, yaw];
        let at = |from, to| {
            let [from, to] = [from, to].map(|angles| oriented(angles, [0.0; 3], [0.0; 3]));
            rotation(from.towards(&to, fraction).orientation)
        };
        let expected = at(principal(angles), principal(end));
        for (from, to) in [(angles, end), (flipped(angles), end), (angles, flipped(end)), (flipped(angles), flipped(end))] {
            prop_assert!((at(from, to).matrix() - expected.matrix()).amax() < 1e-12);
        }
    }
}

#[test]
fn near_the_vertical_a_yaw_rate_stays_what_it_is() {
    for pitch in [84.5_f64, 87.0, 89.9, 90.0, 90.1, 95.0] {
        let angles = [0.0, pitch.to_radians(), 0.4];
        for frame in FRAMES {
            let omega = [0.0, 0.0, 0.05];
            let world = if frame == AngularVelocityFrame::World { to_base(angles, omega) } else { omega };
            assert!((rates(frame, angles, world) - Vector3::from(omega)).amax() < 1e-14, "{pitch}");
        }
    }
}

#[test]
fn through_a_loop_the_rate_is_that_of_the_loop() {
    for k in 0..1000 {
        let angles = [0.0, -0.02 * f64::from(k), 0.7];
        for angles in [angles, principal(angles)] {
            assert!(
                (rates(AngularVelocityFrame::Body, angles, [0.0, -0.6, 0.0]) - Vector3::new(0.0, -0.6, 0.0)).amax()
                    < 1e-12
            );
        }
    }
}

/// Attitudes of a loop, of a roll, and of both with a heading that turns.
fn manoeuvre(which: usize, t: f64) -> Vec3 {
    let t = t - 0.5;
    let (roll, pitch) = ([0.01, 0.5 * t, 0.3 * t][which], [-0.6 * t, 0.1, 0.55 * t][which]);
    [roll, pitch, [0.3, 0.0, 0.2 * t][which]]
}

/// The washout's outputs over a manoeuvre whose angles are written by `angles`.
fn ridden(
    which: usize,
    setting: &[(&str, f64)],
    frame: AngularVelocityFrame,
    step: f64,
    slopes: bool,
    write: fn(Vec3) -> Vec3,
) -> Vec<Output> {
    const H: f64 = 1e-5;
    let mut washout = washout(setting);
    let at = |t: f64| {
        let angles = manoeuvre(which, t);
        let axis = |k: usize| {
            let before = to_base(manoeuvre(which, t - H), std::array::from_fn(|j| f64::from(j == k)));
            let after = to_base(manoeuvre(which, t + H), std::array::from_fn(|j| f64::from(j == k)));
            Vector3::from(after) - Vector3::from(before)
        };
        let unit = |k: usize| Vector3::from(to_base(angles, std::array::from_fn(|j| f64::from(j == k))));
        let omega = (0..3).map(|k| unit(k).cross(&axis(k))).sum::<Vector3<f64>>() / (4.0 * H);
        let omega = if frame == AngularVelocityFrame::World { omega.into() } else { to_platform(angles, omega.into()) };
        oriented(write(angles), to_platform(angles, [0.2, 0.1, G]), omega)
    };
    (0..(12.0 / step) as usize)
        .map(|k| {
            let t = k as f64 * step;
            if slopes {
                washout.step_between(&at(t), &at(t + step), step)
            } else {
                washout.step(&at(t), step)
            }
            washout.output()
        })
        .collect()
}

#[test]
fn equal_rotations_give_equal_motion() {
    for which in 0..3 {
        for removal in 1..=3 {
            for (k, frame) in FRAMES.into_iter().enumerate() {
                for (step, ramp, slopes) in
                    [(0.002, 1.0, false), (0.02, 1.0, false), (0.02, 2.0, false), (0.02, 1.0, true)]
                {
                    let setting = [
                        ("gravityRemoval", f64::from(removal)),
                        ("angularVelocityFrame", (k + 1) as f64),
                        ("input.reconstruction", ramp),
                    ];
                    let run = |write| ridden(which, &setting, frame, step, slopes, write);
                    let (running, principal) = (run(|angles| angles), run(principal));
                    let mut most = [0.0_f64; 3];
                    for (a, b) in running.iter().zip(&principal) {
                        most[0] = most[0].max((a.position - b.position).amax());
                        most[1] = most[1].max((a.orientation.to_vector() - b.orientation.to_vector()).amax());
                        most[2] = most[2].max((a.felt_specific_force - b.felt_specific_force).amax());
                    }
                    // Rounding of 1e-15, which the guard's search amplifies where a limit acts.
                    assert!(most[0] < 1e-5 && most[1] < 1e-5 && most[2] < 0.02, "{setting:?} {step}: {most:?}");
                }
            }
        }
    }
}
