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
