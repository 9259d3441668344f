//! The steady state: a lasting input is felt exactly, and the platform is back at neutral.

use crate::common::manoeuvres::smooth_step;
use crate::common::{accelerating, displacement, from_neutral, ride, ride_between, washout};

#[test]
fn lasting_surge_or_sway_is_felt_with_the_platform_at_neutral() {
    for (x, y) in [(2.0, 0.0), (-2.0, 0.0), (0.0, 2.0), (0.0, -2.0)] {
        let mut washout = washout(&[]);
        ride(&mut washout, 60.0, 0.01, |_| accelerating(x, y, 0.0), |_, _| {});
        let output = washout.output();
        assert!((output.felt_specific_force.x - x).abs() < 1e-4);
        assert!((output.felt_specific_force.y - y).abs() < 1e-4);
        assert!(from_neutral(&output).norm() < 1e-4, "{}", output.position);
    }
}

#[test]
fn lasting_surge_and_sway_together_are_felt_with_the_platform_at_neutral() {
    let mut washout = washout(&[]);
    ride(&mut washout, 60.0, 0.01, |_| accelerating(2.0, -1.5, 0.0), |_, _| {});
    let output = washout.output();
    assert!((output.felt_specific_force.x - 2.0).abs() < 1e-4);
    assert!((output.felt_specific_force.y + 1.5).abs() < 1e-4);
    assert!(from_neutral(&output).norm() < 1e-4, "{}", output.position);
}

#[test]
fn a_ramp_leaves_the_platform_at_neutral() {
    // Slow enough for the tilt to keep up: beyond that the head's axes turn relative to the force's.
    for (x, y) in [(1.0, 0.0), (0.0, 1.0)] {
        let mut washout = washout(&[]);
        let ramp = |t: f64| 0.05 * t;
        ride_between(&mut washout, 40.0, 0.01, |t| accelerating(x * ramp(t), y * ramp(t), 0.0), |_, _| {});
        let offset = from_neutral(&washout.output());
        assert!(offset.x.abs() < 1e-3 && offset.y.abs() < 1e-3, "{offset}");
    }
}

#[test]
fn an_hour_at_rest_is_neutral() {
    let mut washout = washout(&[("solver.maxStep", 0.01)]);
    ride(
        &mut washout,
        3600.0,
        0.01,
        |_| accelerating(0.0, 0.0, 0.0),
        |t, output| assert!(displacement(output) < 1e-12, "at {t}"),
    );
}

#[test]
fn an_hour_at_rest_after_a_ride_is_neutral() {
    let mut washout = washout(&[("solver.maxStep", 0.01)]);
    let input = |t: f64| {
        let fading = 1.0 - smooth_step(t, 20.0, 2.0);
        accelerating(2.0 * fading * t.sin(), fading * (0.7 * t).cos(), fading * (3.0 * t).sin())
    };
    ride(&mut washout, 3600.0, 0.01, input, |_, _| {});
    assert!(displacement(&washout.output()) < 1e-12, "{}", displacement(&washout.output()));
}

#[test]
fn a_minute_at_rest_in_millisecond_steps_is_neutral() {
    let mut washout = washout(&[]);
    ride(
        &mut washout,
        60.0,
        0.001,
        |_| accelerating(0.0, 0.0, 0.0),
        |t, output| assert!(displacement(output) < 1e-12, "at {t}"),
    );
}

#[test]
fn other_orders_and_low_passes_also_end_with_what_lasts() {
    let sets: [&[(&str, f64)]; 3] = [
        &[("splitter.order", 3.0), ("angular.order", 3.0)],
        &[("splitter.lowPass", 2.0)],
        &[("splitter.order", 3.0), ("splitter.lowPass", 2.0)],
    ];
    for set in sets {
        let mut washout = washout(set);
        ride(&mut washout, 60.0, 0.01, |_| accelerating(1.5, 1.0, 0.0), |_, _| {});
        let output = washout.output();
        assert!((output.felt_specific_force.x - 1.5).abs() < 1e-4, "{set:?}");
        assert!((output.felt_specific_force.y - 1.0).abs() < 1e-4, "{set:?}");
        assert!(from_neutral(&output).norm() < 1e-4, "{set:?}: {}", output.position);
    }
}
