//! Conditioning of the vehicle's motion ahead of the filters.

use moris_washout::Input;
use moris_washout::cueing::conditioning::{Cue, InputFilter, cue, cue_force, forward_acceleration, soft_limit};
use moris_washout::interface::{AngularVelocityFrame, ConditioningParameters, GravityRemoval, RollPitchYaw};
use nalgebra::Vector3;
use proptest::prelude::*;

use crate::common::rotation::{Vec3, to_base, to_platform, turn};
use crate::common::{G, cases, parameters, rk4, washout};

/// Nothing scaled or limited.
fn unlimited(gravity_removal: GravityRemoval, angular_velocity_frame: AngularVelocityFrame) -> ConditioningParameters {
    ConditioningParameters {
        force_limit: Vector3::repeat(1e6),
        rate_limit: Vector3::repeat(1e6),
        gravity_removal,
        angular_velocity_frame,
        ..parameters(&[]).conditioning
    }
}

fn oriented([roll, pitch, yaw]: Vec3, force: Vec3, angular_velocity: Vec3) -> Input {
    Input {
        specific_force: force.into(),
        angular_velocity: angular_velocity.into(),
        orientation: RollPitchYaw::new(roll, pitch, yaw),
        ..Input::default()
    }
}

proptest! {
    #![proptest_config(cases(1000))]

    #[test]
    fn gravity_is_removed_in_three_ways(
        angles in [-1.2..1.2, -1.2..1.2, -3.0..3.0], lean in -0.4..0.4, force in [-5.0..5.0, -5.0..5.0, 5.0..15.0],
    ) {
        let removed = |removal| {
            let parameters = unlimited(removal, AngularVelocityFrame::World);
            cue(&oriented(angles, force, [0.0; 3]), &parameters, G, lean).force
        };
        // Lean adds to the vehicle's roll, which is the rotation next to the head.
        let gravity = Vector3::from(to_platform([angles[0] + lean, angles[1], angles[2]], [0.0, 0.0, -G]));
        let force = Vector3::from(force);
        prop_assert_eq!(removed(GravityRemoval::None), force);
        prop_assert!((removed(GravityRemoval::Full) - (force + gravity)).amax() < 1e-13);
        let vertical = force + Vector3::new(0.0, 0.0, gravity.z);
        prop_assert!((removed(GravityRemoval::HeadVertical) - vertical).amax() < 1e-13);
    }

    #[test]
    fn world_and_body_rates_of_one_motion_are_the_same(
        angles in [-0.8..0.8, -0.8..0.8, -3.0..3.0], rates in [-1.0..1.0, -1.0..1.0, -1.0..1.0],
    ) {
        const H: f64 = 1e-5;
        let at = |t: f64| std::array::from_fn(|k| angles[k] + t * rates[k]);
        let world = turn(at(-H), at(H), 2.0 * H);
        let body = to_platform(angles, world);
        let through = |frame, omega| {
            cue(&oriented(angles, [0.0; 3], omega), &unlimited(GravityRemoval::None, frame), G, 0.0).rates
        };
        let from_world = through(AngularVelocityFrame::World, world);
        let from_body = through(AngularVelocityFrame::Body, body);
        prop_assert!((from_world - from_body).amax() < 1e-13);
        // And they are the rates of the angles, but for the difference that made the angular velocity.
        prop_assert!((from_world - Vector3::from(rates)).amax() < 1e-8);
    }

    #[test]
    fn the_limit_is_smooth_and_changes_nothing_up_to_80_percent(value in -30.0..30.0, limit in 0.1..10.0) {
        let limited = soft_limit(value, limit);
        prop_assert!(limited.abs() <= limit && limited.abs() <= f64::abs(value));
        prop_assert_eq!(soft_limit(-value, limit), -limited);
        if value.abs() <= 0.8 * limit {
            prop_assert_eq!(limited, value);
        }
        const H: f64 = 1e-4;
        let slope = |at: f64| (soft_limit(at + H, limit) - soft_limit(at - H, limit)) / (2.0 * H);
        prop_assert!(slope(value) >= -1e-12 && slope(value) <= 1.0 + 1e-9);
        // No corner: the curvature is nowhere above that of the hyperbolic tangent, below 0.77 over its room.
        prop_assert!((slope(value + H) - slope(value)).abs() <= H * 0.8 / (0.2 * limit) + 1e-9);
    }

    #[test]
    fn the_input_filter_is_a_first_order_low_pass(cutoff in 0.5..50.0, step in 0.001..0.02, held: bool) {
        let mut filter = InputFilter::default();
        let parameters = ConditioningParameters { cutoff, ..parameters(&[]).conditioning };
        let (mut x, mut last) = ([0.0], 0.0);
        for k in 0..100 {
            let end = (f64::from(k) * 0.3).sin();
            let start = if held { end } else { last };
            let cue = |value| Cue { force: Vector3::repeat(value), rates: Vector3::repeat(-value) };
            let (_, filtered) = filter.advance(cue(start), cue(end), &parameters, step);
            for part in 0..20 {
                let at = |t: f64| start + (end - start) * t / step;
                x = rk4(f64::from(part) * step / 20.0, x, step / 20.0, |t, x| [cutoff * (at(t) - x[0])]);
            }
            prop_assert!((filtered.force - Vector3::repeat(x[0])).amax() < 1e-7);
            prop_assert!((filtered.rates + Vector3::repeat(x[0])).amax() < 1e-7);
            last = end;
        }
    }
}

proptest! {
    #![proptest_config(cases(40))]

    #[test]
    fn the_rate_filter_is_a_double_pole_on_the_rates_alone(
        rate_cutoff in 0.5..50.0, step in 0.001..0.02, held: bool,
    ) {
        let mut filter = InputFilter::default();
        let parameters = ConditioningParameters { rate_cutoff, ..parameters(&[]).conditioning };
        let (mut x, mut last) = ([0.0, 0.0], 0.0);
        for k in 0..100 {
            let end = (f64::from(k) * 0.3).sin();
            let start = if held { end } else { last };
            let cue = |value| Cue { force: Vector3::repeat(value), rates: Vector3::repeat(-value) };
            let (before, filtered) = filter.advance(cue(start), cue(end), &parameters, step);
            prop_assert!((before.rates + Vector3::repeat(x[0])).amax() < 1e-7);
            for part in 0..20 {
                let at = |t: f64| start + (end - start) * t / step;
                let acceleration =
                    |t, x: &[f64; 2]| rate_cutoff * (rate_cutoff * (at(t) - x[0]) - 2.0 * x[1]);
                x = rk4(f64::from(part) * step / 20.0, x, step / 20.0, |t, x| [x[1], acceleration(t, x)]);
            }
            prop_assert_eq!(filtered.force, Vector3::repeat(end));
            prop_assert!((filtered.rates + Vector3::repeat(x[0])).amax() < 1e-7);
            last = end;
        }
    }
}

#[test]
fn a_rate_filter_switched_on_begins_at_the_present_rates() {
    let off = ConditioningParameters { rate_cutoff: 0.0, ..parameters(&[]).conditioning };
    let on = ConditioningParameters { rate_cutoff: 5.0, ..off };
    let cue = Cue { force: Vector3::zeros(), rates: Vector3::new(0.1, -0.2, 0.3) };
    let mut filter = InputFilter::default();
    assert_eq!(filter.advance(cue, cue, &off, 0.01).1, cue);
    let (before, after) = filter.advance(cue, cue, &on, 0.01);
    assert_eq!(before.rates, cue.rates);
    assert!((after.rates - cue.rates).amax() < 1e-15);
}

#[test]
fn what_the_rate_filter_forgets_is_rest_in_the_end() {
    let mut filter = InputFilter::default();
    let parameters = ConditioningParameters { rate_cutoff: 20.0, ..parameters(&[]).conditioning };
    let cue = Cue { force: Vector3::zeros(), rates: Vector3::new(1.0, -2.0, 3.0) };
    filter.advance(cue, cue, &parameters, 0.1);
    for _ in 0..10_000 {
        filter.advance(Cue::default(), Cue::default(), &parameters, 0.001);
    }
    assert_eq!(filter.cue(), Cue::default());
}

#[test]
fn at_rest_in_any_orientation_nothing_is_left_with_full_removal() {
    for angles in [[0.3, -0.2, 1.0], [-0.5, 0.4, -2.0]] {
        let reading = to_platform(angles, [0.0, 0.0, G]);
        let parameters = unlimited(GravityRemoval::Full, AngularVelocityFrame::World);
        assert!(cue(&oriented(angles, reading, [0.0; 3]), &parameters, G, 0.0).force.amax() < 1e-14);
    }
}

#[test]
fn a_previewed_force_is_conditioned_as_the_present_one() {
    for removal in [GravityRemoval::HeadVertical, GravityRemoval::Full, GravityRemoval::None] {
        let parameters = ConditioningParameters { gravity_removal: removal, ..parameters(&[]).conditioning };
        let input = oriented([0.3, -0.2, 1.0], [2.0, -1.0, 9.0], [0.0; 3]);
        let present = cue(&input, &parameters, G, 0.4).force;
        assert_eq!(cue_force(input.specific_force, &input, &parameters, G, 0.4, 1.0), present);
        let upright = cue_force(input.specific_force, &input, &parameters, G, 0.0, 1.0);
        assert!((removal == GravityRemoval::None) == (upright == present));
    }
}

#[test]
fn a_pitched_vehicle_at_rest_has_no_forward_acceleration() {
    let input = oriented([0.3, -0.2, 1.0], to_platform([0.3, -0.2, 1.0], [0.0, 0.0, G]), [0.0; 3]);
    for removal in [GravityRemoval::HeadVertical, GravityRemoval::Full] {
        let found = forward_acceleration(&input, &unlimited(removal, AngularVelocityFrame::World), G);
        assert!(found.abs() < 1e-14, "{found}");
    }
    let given = forward_acceleration(&input, &unlimited(GravityRemoval::None, AngularVelocityFrame::World), G);
    assert_eq!(given, input.specific_force.x);
}

#[test]
fn a_balanced_turn_cues_no_lateral_force() {
    // At a lean of 0.5 rad in balance the force is along the motorcycle's own vertical: g / cos(0.5).
    let input = oriented([0.5, 0.0, 0.0], [0.0, 0.0, G / 0.5_f64.cos()], [0.0; 3]);
    let mut washout = washout(&[]);
    for _ in 0..2000 {
        washout.step(&input, 0.01);
    }
    let output = washout.output();
    assert!(output.tilt_roll.abs() < 1e-12 && output.tilt_pitch.abs() < 1e-12);
    assert!(output.position.y.abs() < 1e-12);
}

#[test]
fn world_and_body_frames_ride_alike() {
    let mut world = washout(&[("angularVelocityFrame", 1.0)]);
    let mut body = washout(&[("angularVelocityFrame", 2.0)]);
    let angles = |t: f64| [0.3 * (0.9 * t).sin(), 0.2 * (1.3 * t).sin(), 2.0 * (0.3 * t).sin()];
    for k in 0..5000 {
        let t = f64::from(k) * 0.002;
        let omega = turn(angles(t - 1e-5), angles(t + 1e-5), 2e-5);
        let force = to_platform(angles(t), [0.0, 0.0, G]);
        world.step(&oriented(angles(t), force, omega), 0.002);
        body.step(&oriented(angles(t), force, to_platform(angles(t), omega)), 0.002);
    }
    let (a, b) = (world.output(), body.output());
    assert!(a.orientation.to_vector().norm() > 0.05);
    assert!((a.position - b.position).amax() < 1e-9);
    assert!((a.orientation.to_vector() - b.orientation.to_vector()).amax() < 1e-9);
}

#[test]
fn rotations_of_these_tests_are_inverse_to_each_other() {
    let (angles, v) = ([0.3, -0.7, 2.0], [1.0, 2.0, 3.0]);
    let back = to_platform(angles, to_base(angles, v));
    assert!((0..3).all(|k| (back[k] - v[k]).abs() < 1e-14));
}
