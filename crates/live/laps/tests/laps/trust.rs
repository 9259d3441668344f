//! Rides on which earlier passes are no forecast, felt with and without the memory.

use moris_laps::Sample;
use moris_simulation::measures::shape::below_cue_frequency;
use moris_washout::{Input, Parameters, presets};

use crate::cases::cases;
use crate::felt::{felt, previews};
use crate::track::{LAP, STEP, busy_laps, laps};
use crate::wrong;

/// RMS error of surge and sway together below the frequency of cues, and the shape of each.
#[derive(Debug)]
struct Figures {
    error: f64,
    shapes: [f64; 2],
}

/// Figures from so many seconds on, without and with the memory.
fn figures(samples: &[Sample], parameters: &Parameters, from: f64) -> [Figures; 2] {
    let previews = previews(samples);
    let scale = parameters.conditioning.force_scale;
    let input = |sample: &Sample| {
        let mut input = Input::default();
        [input.specific_force.x, input.specific_force.y] = sample.force;
        input
    };
    let inputs: Vec<Input> = samples.iter().map(input).collect();
    let from = (from / STEP) as usize;
    [None, Some(&previews[..])].map(|previews| {
        let felt = felt(inputs.clone(), parameters, previews);
        let mut squares = 0.0;
        let shapes = [0, 1].map(|axis| {
            let desired = inputs[1..].iter().map(|input| scale[axis] * input.specific_force[axis]);
            let slow = |values: Vec<f64>| below_cue_frequency(&values, STEP).unwrap()[from..].to_vec();
            let [desired, felt] = [slow(desired.collect()), slow(felt.iter().map(|felt| felt[axis]).collect())];
            let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let (dd, df, ff) = (product(&desired, &desired), product(&desired, &felt), product(&felt, &felt));
            squares += (dd - 2.0 * df + ff) / desired.len() as f64;
            df / (dd * ff).sqrt()
        });
        Figures { error: squares.sqrt(), shapes }
    })
}

/// Asserts that the memory costs at most 2 % of the error or 0.01 m/s2, and 0.01 of each shape.
fn assert_no_worse(name: &str, samples: &[Sample], parameters: &Parameters, from: f64) {
    let [plain, learned] = figures(samples, parameters, from);
    assert!(learned.error <= (1.02 * plain.error).max(plain.error + 0.01), "{name}: {plain:?} {learned:?}");
    let is_kept = plain.shapes.iter().zip(&learned.shapes).all(|(plain, learned)| *learned >= plain - 0.01);
    assert!(is_kept, "{name}: {plain:?} {learned:?}");
}

#[test]
fn wrong_passes_cost_nothing_on_a_smooth_ride() {
    let parameters = presets::parameters(presets::PREVIEW);
    for (name, samples) in wrong::all(&laps(3.0, 1.0), LAP).into_iter().step_by(cases(1, 4)) {
        assert_no_worse(name, &samples, &parameters, 90.0);
    }
}

#[test]
fn wrong_passes_cost_nothing_on_a_busy_ride() {
    let parameters = presets::parameters(presets::PREVIEW);
    for (name, samples) in wrong::all(&busy_laps(3.0), LAP).into_iter().skip(cases(0, 1)).step_by(cases(1, 4)) {
        assert_no_worse(name, &samples, &parameters, 90.0);
    }
}

#[test]
fn a_vehicle_that_betrays_each_preview_costs_nothing_in_the_long_run() {
    let parameters = presets::parameters(presets::PREVIEW);
    for patience in [1.0, 5.0] {
        let samples = wrong::betrayed(&busy_laps(7.0), patience);
        assert_no_worse(&format!("betrayed after {patience} s"), &samples, &parameters, 90.0);
    }
}
