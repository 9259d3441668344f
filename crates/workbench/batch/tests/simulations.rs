//! A batch gives the results of single simulations on any number of cores. It rejects
//! what cannot be simulated.

use moris_batch::{Fit, Manoeuvre, simulate, simulations};
use moris_washout::{Input, Parameters, Washout};
use nalgebra::Vector3;
use rayon::prelude::*;

fn surge_and_back() -> Manoeuvre {
    Manoeuvre::sampled(0.01, 8.0, |time| {
        let mut input = Input::default();
        input.specific_force.x = 1.5 * (0.8 * time).sin();
        input
    })
}

fn with_frequency(omega: f64) -> Parameters {
    let mut parameters = Parameters::default();
    parameters.splitter.omega1 = Vector3::repeat(omega);
    parameters
}

#[test]
fn a_ride_is_the_washout_stepped_by_hand() {
    let manoeuvre = surge_and_back();
    let fit = simulate(&manoeuvre, &Parameters::default(), Fit::default()).expect("the default parameters can be used");
    let mut washout = Washout::new(&Parameters::default()).expect("the default parameters can be used");
    let (mut sum, mut peak, mut margin) = (0.0, 0.0_f64, f64::INFINITY);
    for k in 0..800 {
        washout.step_between(&manoeuvre.inputs()[k], &manoeuvre.inputs()[k + 1], 0.01);
        let error = washout.output().felt_specific_force.x - manoeuvre.inputs()[k + 1].specific_force.x;
        sum += error * error;
        peak = peak.max(error.abs());
        margin = margin.min(washout.output().stroke_margin);
    }
    assert_eq!(fit.rms_error().x, (sum / 800.0_f64).sqrt());
    assert_eq!(fit.peak_error().x, peak);
    assert_eq!(fit.smallest_margin(), margin);
    assert!(peak > 0.01);
}

/// Largest difference between two values of 20 ms, of the 20 ms from each sample.
fn changes(signal: &[f64]) -> Vec<f64> {
    let span = |window: &[f64]| {
        let most = window.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        most - window.iter().copied().fold(f64::INFINITY, f64::min)
    };
    // Internal steps of 1 ms.
    signal.windows(21).map(span).collect()
}

#[test]
fn comfort_is_that_of_the_washout_stepped_by_hand() {
    // Sudden, and more than the platform's travel.
    let manoeuvre = Manoeuvre::sampled(0.01, 6.0, |time| {
        let mut input = Input::default();
        input.specific_force.x = if (1.0..1.5).contains(&time) { 9.0 } else { 0.0 };
        input
    });
    let mut parameters = Parameters::default();
    parameters.safety.position_limit /= 10.0;
    parameters.soft_limit.pace = 0.0;
    assert_eq!(parameters.structure.max_step, 0.001);
    let fit = simulate(&manoeuvre, &parameters, Fit::with_comfort()).expect("the default parameters can be used");
    let mut washout = Washout::new(&parameters).expect("the default parameters can be used");
    let (mut felt, mut desired) = (vec![washout.output().felt_specific_force.x], vec![0.0]);
    for pair in manoeuvre.inputs().windows(2) {
        let feel = |force: &Vector3<f64>| felt.push(force.x);
        washout.step_between_observed(&pair[0], &pair[1], 0.01, feel);
        let [from, to] = [pair[0].specific_force.x, pair[1].specific_force.x];
        desired.extend((1..=10).map(|k| from + (to - from) * f64::from(k) / 10.0));
    }
    let wanted = changes(&desired);
    let around =
        |k: usize| wanted[k.saturating_sub(20)..(k + 21).min(wanted.len())].iter().copied().fold(0.0, f64::max);
    let jolt = changes(&felt).iter().enumerate().map(|(k, change)| change - around(k)).fold(0.0, f64::max);
    let largest = |signal: &[f64]| signal.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let [shake, found_jolt, peak] = fit.comfort().expect("comfort was asked for");
    assert!(jolt > 0.1 && (found_jolt - jolt).abs() < 1e-9, "{found_jolt}, {jolt}");
    assert!((peak - (largest(&felt) - largest(&desired)).max(0.0)).abs() < 1e-9, "{peak}");
    assert!(shake.is_finite());
    let plain = simulate(&manoeuvre, &parameters, Fit::default()).expect("the default parameters can be used");
    assert_eq!((plain.comfort(), plain.rms_error()), (None, fit.rms_error()));
}

#[test]
fn the_number_of_cores_changes_nothing() {
    let manoeuvre = surge_and_back();
    let on = |threads: usize| -> Vec<Fit> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be had");
        pool.install(|| {
            let sets = (1..=20_u32).into_par_iter().map(|k| with_frequency(0.3 * f64::from(k)));
            simulations(&manoeuvre, sets, Fit::default)
                .map(|simulation| simulation.result.expect("can be used"))
                .collect()
        })
    };
    let alone = on(1);
    assert_eq!(alone, on(3));
    assert_ne!(alone[0], alone[19]);
}

#[test]
fn a_set_that_cannot_be_used_says_so_and_the_others_ride() {
    let manoeuvre = surge_and_back();
    let sets = [1.0, -1.0, 2.0].into_par_iter().map(with_frequency);
    let results: Vec<_> = simulations(&manoeuvre, sets, Fit::default).map(|simulation| simulation.result).collect();
    assert!(results[0].is_ok() && results[2].is_ok());
    let refusal = results[1].as_ref().expect_err("a negative frequency is refused");
    assert_eq!(refusal.variable, "splitter.x.omega1");
}
