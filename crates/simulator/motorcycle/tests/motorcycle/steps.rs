//! Steps: convergence, agreement of step sizes, no allocation, and continuation from saved bytes.

use moris_motorcycle::{Input, MOST_MOTORCYCLE_STEPS, Model, Motorcycle, Parameters};

use crate::common::{at_speed, motorcycle};

fn input(time: f64) -> Input {
    Input {
        throttle: if time < 2.0 { 0.6 } else { 0.1 },
        brake: if time > 5.0 { 0.8 } else { 0.0 },
        lean: 0.3 * (1.5 * time).sin(),
        ..Input::default()
    }
}

/// The state after some seconds in steps of this size, with internal steps of at most that size.
fn vehicle(seconds: f64, step: f64, internal: f64) -> Motorcycle {
    let mut parameters = at_speed(10.0);
    parameters.run.max_step = internal;
    let mut vehicle = motorcycle(&parameters);
    for k in 0..(seconds / step).round() as u32 {
        let time = f64::from(k) * step;
        vehicle.step_between(&input(time), &input(time + step), step);
    }
    vehicle
}

#[test]
fn halving_the_step_changes_next_to_nothing() {
    let (coarse, fine) = (vehicle(4.5, 1e-3, 1e-3), vehicle(4.5, 1e-3, 2.5e-4));
    let (coarse, fine) = (coarse.output(), fine.output());
    assert!((coarse.head_position - fine.head_position).norm() < 1e-6);
    assert!((coarse.specific_force - fine.specific_force).norm() < 1e-5);
    assert!((coarse.orientation.roll - fine.orientation.roll).abs() < 1e-7);
}

#[test]
fn a_step_that_is_none_does_nothing() {
    let mut motorcycle = vehicle(1.0, 1e-3, 1e-3);
    let before = motorcycle.clone();
    for step in [f64::NAN, 0.0, -0.0, -1.0, f64::NEG_INFINITY, 1e-13] {
        motorcycle.step(&input(1.0), step);
        assert_eq!(motorcycle.state(), before.state(), "{step}");
        assert_eq!(motorcycle.output(), before.output(), "{step}");
        assert_eq!(motorcycle.output_derivative(), before.output_derivative(), "{step}");
    }
}

#[test]
fn a_step_that_is_too_long_is_cut_off() {
    let mut longest = motorcycle(&at_speed(10.0));
    let mut endless = longest.clone();
    longest.step(&input(0.0), MOST_MOTORCYCLE_STEPS * longest.parameters().run.max_step);
    endless.step(&input(0.0), f64::INFINITY);
    assert_eq!(endless.state(), longest.state());
    assert_eq!(endless.output_derivative(), longest.output_derivative());
}

#[test]
fn a_long_communication_step_is_divided() {
    let mut at_once = motorcycle(&at_speed(10.0));
    let mut one_by_one = at_once.clone();
    let input = Input { throttle: 0.5, lean: 0.2, ..Input::default() };
    at_once.step(&input, 0.5);
    (0..500).for_each(|_| one_by_one.step(&input, 0.001));
    assert!((at_once.output().head_position - one_by_one.output().head_position).norm() < 1e-9);
}

#[test]
fn a_stop_ends_at_the_same_place_for_any_step() {
    let (coarse, fine) = (vehicle(9.0, 1e-3, 1e-3), vehicle(9.0, 1e-3, 1e-4));
    assert_eq!(coarse.output().speed, 0.0);
    assert_eq!(fine.output().speed, 0.0);
    let off = (coarse.output().position - fine.output().position).norm();
    assert!(off < 1e-3, "{off} m");
}

#[test]
fn steps_allocate_nothing() {
    let mut vehicle = motorcycle(&Parameters::default());
    let input = Input { throttle: 1.0, lean: 0.5, ..Input::default() };
    let counted = allocation_counter::measure(|| (0..1000).for_each(|_| vehicle.step(&input, 0.004)));
    assert_eq!(counted.count_total, 0);
}

#[test]
fn from_saved_bytes_the_ride_goes_on_bit_for_bit() {
    let mut vehicle = vehicle(3.0, 1e-3, 1e-3);
    let bytes = postcard::to_allocvec(&vehicle).unwrap();
    let mut restored: Motorcycle = postcard::from_bytes(&bytes).unwrap();
    for k in 3000..6000 {
        let input = input(f64::from(k) * 1e-3);
        vehicle.step(&input, 1e-3);
        restored.step(&input, 1e-3);
        assert_eq!(vehicle.output(), restored.output());
    }
}
