//! Memory that a long recording takes.

use std::sync::Arc;

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
