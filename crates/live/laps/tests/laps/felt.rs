//! The felt force with and without the memory.

use moris_laps::{Laps, Preview, Sample};
use moris_simulation::{Manoeuvre, Replay};
use moris_washout::{Input, Parameters, Washout, presets};

use crate::cases::cases;
use crate::motorcycle;
use crate::track::{LAP, STEP, busy_laps, laps, mirrored};

/// The previews beside a ride.
pub fn previews(samples: &[Sample]) -> Vec<Preview> {
    let mut memory = Laps::new();
    let step = |sample: &Sample| {
        memory.step(sample);
        memory.preview()
    };
    samples.iter().map(step).collect()
}

/// RMS error of surge and sway together in each lap, with these previews.
fn errors(samples: &[Sample], previews: Option<&[Preview]>) -> Vec<f64> {
    let input = |sample: &Sample| {
        let mut input = Input::default();
        [input.specific_force.x, input.specific_force.y] = sample.force;
        input
    };
    let squares = squares(samples.iter().map(input).collect(), &presets::parameters(presets::PREVIEW), previews);
    squares.chunks((LAP / STEP) as usize).map(rms).collect()
}

/// Squared error of surge and sway together at each sample.
fn squares(inputs: Vec<Input>, parameters: &Parameters, previews: Option<&[Preview]>) -> Vec<f64> {
    let desired = inputs.clone();
    let felt = felt(inputs, parameters, previews);
    let error = |([x, y], input): (&[f64; 2], &Input)| {
        (x - input.specific_force.x).powi(2) + (y - input.specific_force.y).powi(2)
    };
    felt.iter().zip(&desired[1..]).map(error).collect()
}

/// Felt force of surge and sway at each sample but the first.
pub fn felt(inputs: Vec<Input>, parameters: &Parameters, previews: Option<&[Preview]>) -> Vec<[f64; 2]> {
    let mut washout = Washout::new(parameters).unwrap().starting_with(&inputs[0]);
    let mut felt = Vec::new();
    Replay::new(&Manoeuvre::new(STEP, inputs)).run_part(
        0..usize::MAX,
        &mut washout,
        |washout, time| {
            if let Some(previews) = previews {
                washout.preview(&previews[(time / STEP).round() as usize]);
            }
        },
        |_| (),
        |_, output| felt.push([output.felt_specific_force.x, output.felt_specific_force.y]),
    );
    felt
}

fn rms(squares: &[f64]) -> f64 {
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn the_second_lap_is_felt_with_at_most_six_tenths_of_the_first_one_s_error() {
    let samples = busy_laps(3.0);
    let plain = errors(&samples, None);
    let learned = errors(&samples, Some(&previews(&samples)));
    assert_eq!(plain[0], learned[0], "nothing is known in the first lap");
    assert!(learned[1] <= 0.6 * learned[0], "{learned:?} {plain:?}");
    assert!(learned[2] <= 0.55 * learned[0], "{learned:?} {plain:?}");
}

#[test]
fn the_motorcycle_s_lap_is_felt_better_from_its_second_round_on() {
    let (inputs, samples, begins) = motorcycle::ride(cases(5, 2));
    // As in examples/10_lap.toml.
    let parameters = presets::with(presets::PREVIEW, &[("scale.angularVelocity.x", 0.1)]);
    let by_lap = |squares: Vec<f64>| -> Vec<f64> {
        begins.windows(2).map(|ends| rms(&squares[ends[0]..ends[1].min(squares.len())])).collect()
    };
    let plain = by_lap(squares(inputs.clone(), &parameters, None));
    let learned = by_lap(squares(inputs, &parameters, Some(&previews(&samples))));
    assert_eq!(plain[0], learned[0]);
    assert!(learned[1] <= 0.6 * learned[0], "{learned:?} {plain:?}");
    assert!(learned[2..].iter().all(|error| *error <= 0.55 * learned[0]), "{learned:?} {plain:?}");
}

#[test]
fn the_automatic_scale_is_larger_once_the_road_is_known() {
    let samples = busy_laps(3.0);
    let parameters = presets::with(presets::PREVIEW, &[("scale.automatic", 2.0)]);
    let previews = previews(&samples);
    let factors = [false, true].map(|learns| {
        let mut washout = Washout::new(&parameters).unwrap();
        let mut sum = 0.0;
        for (sample, preview) in samples.iter().zip(&previews) {
            let mut input = Input::default();
            [input.specific_force.x, input.specific_force.y] = sample.force;
            if learns {
                washout.preview(preview);
            }
            washout.step(&input, STEP);
            sum += washout.output().scale_factor;
        }
        sum / samples.len() as f64
    });
    assert!(factors[1] > 1.3 * factors[0], "{factors:?}");
}

/// Forces in stretches of 9 s in another order, at the same positions.
fn shuffled(samples: &[Sample]) -> Vec<Sample> {
    let stretch = (9.0 / STEP) as usize;
    let count = samples.len() / stretch;
    let force = |k: usize| samples[(k / stretch * 7 % count * stretch + k % stretch) % samples.len()].force;
    samples.iter().enumerate().map(|(k, sample)| Sample { force: force(k), ..*sample }).collect()
}

#[test]
fn forces_that_do_not_belong_to_their_places_are_felt_no_worse_than_without_memory() {
    let whole = laps(4.0, 1.0);
    let mirror_from = |lap: f64| {
        let from = (lap * LAP / STEP) as usize;
        move |(k, sample): (usize, &Sample)| if k < from { *sample } else { mirrored(*sample) }
    };
    let alternating = |(k, sample): (usize, &Sample)| {
        let is_odd = (k as f64 * STEP / LAP) as usize % 2 == 1;
        let sign = if is_odd { -1.0 } else { 1.0 };
        Sample { force: sample.force.map(|force| sign * force), ..*sample }
    };
    let rides: [(&str, Vec<Sample>); 4] = [
        ("as it is", whole.clone()),
        ("shuffled", shuffled(&whole)),
        ("mirrored", whole.iter().enumerate().map(mirror_from(1.0)).collect()),
        ("alternating", whole.iter().enumerate().map(alternating).collect()),
    ];
    for (name, samples) in rides {
        let rms = |laps: Vec<f64>| laps.iter().map(|error| error * error).sum::<f64>().sqrt();
        let plain = rms(errors(&samples, None));
        let learned = rms(errors(&samples, Some(&previews(&samples))));
        assert!(learned <= 1.02 * plain, "{name}: {learned} {plain}");
    }
}
