//! The paper's three runs, and its claims about them.

use moris_washout::{Input, Output, Washout, presets};

use crate::common::manoeuvres::*;
use crate::common::{correlation, from_neutral, parameters, rms_difference, washout};

const STEP: f64 = 0.001;

/// Simulates a run with the paper's parameters, and checks what holds in all
/// runs. Returns the outputs.
fn simulated(duration: f64, input: impl Fn(f64) -> Input) -> Vec<Output> {
    let mut washout = washout(&[]);
    let tilt = parameters(&[]).tilt;
    let mut outputs: Vec<Output> = vec![washout.output()];
    for k in 0..(duration / STEP).round() as usize {
        let t = k as f64 * STEP;
        washout.step_between(&input(t), &input(t + STEP), STEP);
        let output = washout.output();
        let before = outputs[k];
        assert!(output.length.iter().all(|length| (1.0..=1.6).contains(length)), "legs at {t}");
        for (rate, rate_before) in
            [(output.tilt_roll_rate, before.tilt_roll_rate), (output.tilt_pitch_rate, before.tilt_pitch_rate)]
        {
            assert!(rate.abs() <= 3.0_f64.to_radians() * (1.0 + 1e-9), "tilt rate at {t}");
            let acceleration = (rate - rate_before) / STEP;
            assert!(acceleration.abs() <= tilt.acceleration_limit * (1.0 + 1e-9), "tilt acceleration at {t}");
        }
        outputs.push(output);
    }
    outputs.remove(0);
    outputs
}

fn desired(duration: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
    (1..=(duration / STEP).round() as usize).map(|k| f(k as f64 * STEP)).collect()
}

fn felt_surge(outputs: &[Output]) -> Vec<f64> {
    outputs.iter().map(|output| output.felt_specific_force.x).collect()
}

#[test]
fn accelerating_and_braking_is_tracked() {
    let outputs = simulated(ACCELERATE_AND_BRAKE_TIME, surging(accelerate_and_brake));
    let (felt, desired) = (felt_surge(&outputs), desired(ACCELERATE_AND_BRAKE_TIME, accelerate_and_brake));
    let (correlation, error) = (correlation(&felt, &desired), rms_difference(&felt, &desired));
    println!("run a: correlation {correlation}, rms error {error}");
    assert!(correlation >= 0.99, "{correlation}");
    assert!(error <= 0.08, "{error}");
}

#[test]
fn accelerating_and_braking_briskly_stays_in_the_stroke() {
    let outputs = simulated(ACCELERATE_AND_BRAKE_TIME, surging(accelerate_and_brake_briskly));
    assert!(from_neutral(&outputs[outputs.len() - 1]).norm() < 1e-3);
}

#[test]
fn a_brusque_stop_is_hardly_simulated_and_ends_at_neutral() {
    let outputs = simulated(BRUSQUE_STOP_TIME, surging(brusque_stop));
    let (felt, desired) = (felt_surge(&outputs), desired(BRUSQUE_STOP_TIME, brusque_stop));
    let after = ((STOP + 0.01) / STEP) as usize;
    let peak = felt[after..].iter().zip(&desired[after..]).map(|(f, d)| (f - d).abs()).fold(0.0, f64::max);
    println!("run c: peak error after the stop {peak}");
    assert!(peak > 1.0, "{peak}");
    let before = (STOP / STEP) as usize - 10;
    let error = rms_difference(&felt[..before], &desired[..before]);
    assert!(error < 0.15, "until the stop it is tracked: {error}");
    let last = &outputs[outputs.len() - 1];
    assert!(from_neutral(last).norm() < 1e-3 && last.orientation.to_vector().norm() < 1e-3);
}

#[test]
fn the_wake_is_ridden_inside_the_stroke_with_the_default_set() {
    simulated(WAKE_TIME, wake_with_roll);
}

#[test]
fn the_wake_is_tracked_with_its_own_set() {
    let mut washout =
        Washout::new(&presets::parameters(include_str!("../../examples/paper-runs/small-motions.toml"))).unwrap();
    let (mut felt, mut desired) = ([vec![], vec![]], [vec![], vec![]]);
    for k in 0..(WAKE_TIME / STEP) as usize {
        let t = k as f64 * STEP;
        let end = wake_with_roll(t + STEP);
        washout.step_between(&wake_with_roll(t), &end, STEP);
        let output = washout.output();
        assert!(output.length.iter().all(|length| (1.0..=1.6).contains(length)), "legs at {t}");
        for axis in 0..2 {
            felt[axis].push(output.felt_specific_force[axis]);
            desired[axis].push(end.specific_force[axis]);
        }
    }
    for axis in 0..2 {
        let correlation = correlation(&felt[axis], &desired[axis]);
        println!("run b, axis {axis}: correlation {correlation}");
        assert!(correlation >= 0.9, "axis {axis}: {correlation}");
    }
}
