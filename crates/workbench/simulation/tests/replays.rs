//! A replay is the washout stepped by hand, on any number of cores.

use moris_simulation::{Manoeuvre, Replay};
use moris_washout::{Input, Output, Parameters, Washout};
use nalgebra::Vector3;
use rayon::prelude::*;

fn surge_and_back() -> Manoeuvre {
    Manoeuvre::sampled(0.01, 8.0, |time| {
        let mut input = Input::default();
        input.specific_force.x = 1.5 * (0.8 * time).sin();
        input
    })
}

fn outputs(manoeuvre: &Manoeuvre, parameters: &Parameters) -> Vec<Output> {
    let mut washout = Washout::new(parameters).expect("these parameters can be used");
    let mut outputs = Vec::new();
    Replay::new(manoeuvre).run(&mut washout, |_, output| outputs.push(*output));
    outputs
}

#[test]
fn a_ride_is_the_washout_stepped_by_hand() {
    let manoeuvre = surge_and_back();
    let mut washout = Washout::new(&Parameters::default()).expect("the default parameters can be used");
    let mut stepped = Vec::new();
    for pair in manoeuvre.inputs().windows(2) {
        washout.step_between(&pair[0], &pair[1], 0.01);
        stepped.push(washout.output());
    }
    assert_eq!(outputs(&manoeuvre, &Parameters::default()), stepped);
}

#[test]
fn the_number_of_cores_changes_nothing() {
    let manoeuvre = surge_and_back();
    let on = |threads: usize| -> Vec<Vec<Output>> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be had");
        let replay = |k: u32| {
            let mut parameters = Parameters::default();
            parameters.splitter.omega1 = Vector3::repeat(0.3 * f64::from(k));
            outputs(&manoeuvre, &parameters)
        };
        pool.install(|| (1..=20_u32).into_par_iter().map(replay).collect())
    };
    let alone = on(1);
    assert_eq!(alone, on(3));
    assert_ne!(alone[0], alone[19]);
}
