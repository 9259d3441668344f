//! Memory that a long recording takes.

use std::sync::Arc;

use moris_simulation::measures::{Limits, Measures, Platform, Run};
use moris_simulation::{Manoeuvre, Replay, Simulation, measures};
use moris_washout::{Input, Parameters};

/// Bytes for each internal step: two sums on one axis. There are ten to a sample.
const BYTES: usize = 26;

#[test]
fn measures_copy_no_series_of_a_simulation() {
    let manoeuvre = Manoeuvre::sampled(0.01, 40.0, |time| {
        let mut input = Input::default();
        input.specific_force.x = (0.5 * time).sin();
        input
    });
    let simulation = Simulation::of(&Replay::new(&manoeuvre), &Parameters::default(), || ()).unwrap();
    assert!(Arc::ptr_eq(&simulation.inputs, &manoeuvre.shared_inputs()));
    let steps = simulation.felt_within_steps.len();
    assert_eq!(steps, 40_001);
    let taken = allocation_counter::measure(|| _ = measures(&simulation).unwrap());
    assert!(taken.bytes_max < (BYTES * steps) as u64, "{} bytes a step", taken.bytes_max / steps as u64);
}

#[test]
fn comfort_keeps_no_series_of_internal_steps() {
    let (count, divisions) = (20_001, 200);
    let force = |step: f64| move |k: usize| [(0.5 * step * k as f64).sin(), 0.0, 9.80665];
    let (rest, limited) = ((count, |_| [0.0; 3]), vec![Limits::default(); count]);
    let steps = divisions * (count - 1) + 1;
    let run = Run {
        step: 0.2,
        desired_force: &(count, force(0.2)),
        felt_force: &(count, force(0.2)),
        felt_force_within_steps: &(steps, force(0.001)),
        desired_rate: &rest,
        scale: [1.0; 2],
        felt_rate: &rest,
        platform: Platform {
            legs: &(count, |_| [1.3; 6]),
            stroke: [1.0, 1.6],
            displacement: &rest,
            tilt_rate: &(count, |_| [0.0; 2]),
            limited: &limited,
        },
    };
    let taken = allocation_counter::measure(|| assert!(Measures::of(&run).unwrap().comfort[0].is_some()));
    assert!(taken.bytes_max < 3 * steps as u64, "{} bytes", taken.bytes_max);
}
