//! Preaction: an abrupt stop is felt far better. A braking that is released before the stop is felt
//! as without preaction.

use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::{Input, Output, Parameters, Washout};
use nalgebra::Vector3;
use proptest::prelude::*;

use crate::common::limits::Watch;
use crate::common::random::Random;
use crate::common::{cases, displacement, parameters};

const STEP: f64 = 0.001;
/// The travel of the paper's rig, which this braking takes.
const TRAVEL: &[(&str, f64)] = &[("safety.x.positionLimit", 0.45)];

fn preaction(on: bool) -> Parameters {
    parameters(&[TRAVEL, &[("preaction", if on { 2.0 } else { 1.0 })]].concat())
}

/// Motion of a vehicle: acceleration \[m/s2\] and speed \[m/s\] at a time \[s\].
type Motion = fn(f64) -> (f64, f64);

/// Rides from rest at `preaction` on or off. Returns the accelerations asked for and the outputs.
fn simulated(on: bool, duration: f64, motion: Motion) -> (Vec<f64>, Vec<Output>) {
    let mut washout = Washout::new(&preaction(on)).unwrap();
    let mut watch = Watch::new(washout.parameters(), &washout.output());
    let steps = (1..=(duration / STEP).round() as usize).map(|k| {
        let (acceleration, speed) = motion(k as f64 * STEP);
        let specific_force = Vector3::new(acceleration, 0.0, STANDARD_GRAVITY);
        washout.step(&Input { specific_force, speed, ..Input::default() }, STEP);
        watch.check(&washout.output(), STEP);
        (acceleration, washout.output())
    });
    steps.unzip()
}

/// x^2 (3 - 2x) of the time since `start` in parts of `duration`, and the
/// integral of that over time.
fn smooth(t: f64, start: f64, duration: f64) -> (f64, f64) {
    let x = ((t - start) / duration).clamp(0.0, 1.0);
    (x * x * (3.0 - 2.0 * x), duration * (x * x * x - 0.5 * x * x * x * x) + (t - start - duration).max(0.0))
}

/// When the paper's third run stops \[s\].
const STOP: f64 = 22.0 + 10.5 / 2.0 + 2.2 * 11.0 / 3.5;

/// The paper's third run: accelerate, and brake with 3.5 m/s2 to an abrupt stop.
fn run_c(t: f64) -> (f64, f64) {
    if t >= STOP {
        return (0.0, 0.0);
    }
    let (up, gained) = smooth(t, 1.0, 6.6);
    let (down, held) = smooth(t, 12.0, 6.6);
    let (brake, lost) = smooth(t, 22.0, 10.5);
    (2.2 * (up - down) - 3.5 * brake, 2.2 * (gained - held) - 3.5 * lost)
}

/// From 28 m/s, braked with 3 m/s2 from 2 s on. `RELEASE` tenths of a second later the brake is
/// released within another tenth.
fn braked<const RELEASE: u32>(t: f64) -> (f64, f64) {
    let (brake, lost) = smooth(t, 2.0, 1.0);
    let (release, kept) = smooth(t, 2.0 + 0.1 * f64::from(RELEASE), 0.1);
    (-3.0 * (brake - release), 28.0 - 3.0 * (lost - kept))
}

/// RMS and largest error of the felt surge force over some of the steps.
fn errors(asked: &[f64], outputs: &[Output], steps: std::ops::Range<usize>) -> (f64, f64) {
    let count = steps.len() as f64;
    let squares = steps.map(|k| (outputs[k].felt_specific_force.x - asked[k]).powi(2));
    let (sum, largest) = squares.fold((0.0, 0.0_f64), |(sum, largest), square| (sum + square, largest.max(square)));
    ((sum / count).sqrt(), largest.sqrt())
}

#[test]
fn a_brusque_stop_is_felt_with_less_than_half_of_the_error() {
    let stop = (STOP / STEP) as usize;
    let (around, after) = (stop - 5000..stop + 5000, stop + 1..stop + 8000);
    let measured = [false, true].map(|on| {
        let (asked, outputs) = simulated(on, 50.0, run_c);
        assert!(outputs.iter().all(|output| !output.actuator_limited && !output.safety_active));
        assert!(displacement(outputs.last().unwrap()) < 1e-3);
        let whole = errors(&asked, &outputs, 0..outputs.len());
        (errors(&asked, &outputs, around.clone()).0, errors(&asked, &outputs, after.clone()).1, whole.0)
    });
    let [(rms_off, peak_off, whole_off), (rms, peak, whole)] = measured;
    println!("around the stop {rms_off} {rms}, peak after it {peak_off} {peak}, whole run {whole_off} {whole}");
    assert!(rms < 0.4 * rms_off, "{rms_off} {rms}");
    assert!(peak < 0.3 * peak_off, "{peak_off} {peak}");
}

#[test]
fn a_braking_released_early_changes_nothing() {
    let on = simulated(true, 20.0, braked::<0>);
    assert_eq!(on.1, simulated(false, 20.0, braked::<0>).1);
}

#[test]
fn a_braking_released_with_the_stop_in_sight_is_felt_as_without() {
    // 5 s before the stop the platform has moved forward, and nothing else has happened.
    let (_, on) = simulated(true, 40.0, braked::<50>);
    let (_, off) = simulated(false, 40.0, braked::<50>);
    let mut moved = 0.0_f64;
    for (on, off) in on.iter().zip(&off) {
        let difference = (on.felt_specific_force - off.felt_specific_force).amax();
        assert!(difference < 0.06, "{difference}");
        moved = moved.max((on.position - off.position).amax());
    }
    assert!(moved > 0.05, "{moved}");
    assert!(displacement(on.last().unwrap()) < 1e-3);
}

#[test]
fn a_braking_released_at_the_last_moment_is_forgotten() {
    let (asked, outputs) = simulated(true, 40.0, braked::<80>);
    let (_, without) = simulated(false, 40.0, braked::<80>);
    assert!(outputs.iter().all(|output| !output.actuator_limited && !output.safety_active));
    // No worse than without: the release is as abrupt as a stop.
    let all = 0..outputs.len();
    assert!(errors(&asked, &outputs, all.clone()).0 < errors(&asked, &without, all).0);
    assert!(displacement(outputs.last().unwrap()) < 1e-3);
}

#[test]
fn a_launch_given_up_while_the_platform_still_goes_forward_does_not_jolt() {
    // From standstill late in the positioning: half a second of hard braking, let go at each of many moments.
    for release in 1..30 {
        let mut washout = Washout::new(&preaction(true)).unwrap();
        let mut before = washout.output();
        for k in 0..20_000 {
            let time = f64::from(k) * STEP;
            let braking = time < 1.0 + 0.1 * f64::from(release);
            let force = if braking { -2.0 } else { 0.0 };
            let speed = if braking { 4.0 - 2.0 * (time - 1.0).max(0.0) } else { 2.0 };
            let specific_force = Vector3::new(if time < 1.0 { 0.0 } else { force }, 0.0, STANDARD_GRAVITY);
            washout.step(&Input { specific_force, speed: speed.max(0.1), ..Input::default() }, STEP);
            let now = washout.output();
            assert!(!now.safety_active && !now.actuator_limited, "released at {release}: {time} s");
            let jerk = (now.velocity - before.velocity).x / STEP;
            assert!(jerk.abs() < 4.0, "released at {release}: {jerk} m/s2 at {time} s");
            before = now;
        }
    }
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn limits_hold_for_vehicles_that_stop_as_nothing_can(seed: u64, held in 20..2000_usize) {
        let mut washout = Washout::new(&preaction(true)).unwrap();
        let mut watch = Watch::new(washout.parameters(), &washout.output());
        let mut random = Random::new(seed);
        let mut input = Input::default();
        for k in 0..20_000 {
            if k % held == 0 {
                input.specific_force.x = random.between(-8.0, 4.0);
                input.speed = random.between(-1.0, 20.0);
            }
            input.speed += input.specific_force.x * STEP;
            washout.step(&input, STEP);
            watch.check(&washout.output(), STEP);
        }
        for _ in 0..40_000 {
            washout.step(&Input::default(), STEP);
            watch.check(&washout.output(), STEP);
        }
        prop_assert!(displacement(&washout.output()) < 1e-3);
    }
}
