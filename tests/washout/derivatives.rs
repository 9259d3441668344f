//! The output's derivative against differences of outputs.

use moris_washout::{Input, Output};
use nalgebra::Vector3;

use crate::common::{G, washout};

/// One internal step.
const STEP: f64 = 0.001;

fn moving(time: f64) -> Input {
    let wave = |amplitude: f64, omega: f64, phase: f64| amplitude * (omega * time + phase).sin();
    Input {
        specific_force: Vector3::new(wave(1.0, 0.9, 0.0), wave(0.8, 1.7, 1.0), G + wave(1.5, 3.0, 2.0)),
        angular_velocity: Vector3::new(wave(0.1, 1.5, 0.0), wave(0.05, 1.1, 1.0), wave(0.1, 0.9, 2.0)),
        ..Input::default()
    }
}

/// The real outputs with an exact derivative, by name.
fn exact(output: &Output) -> Vec<(&'static str, f64)> {
    let vectors = [
        ("position", output.position),
        ("velocity", output.velocity),
        ("orientation", output.orientation.to_vector()),
        ("angular velocity", output.angular_velocity),
    ];
    let mut values = vec![
        ("tilt roll", output.tilt_roll),
        ("tilt pitch", output.tilt_pitch),
        ("tilt roll rate", output.tilt_roll_rate),
        ("tilt pitch rate", output.tilt_pitch_rate),
        ("stroke margin", output.stroke_margin),
    ];
    values.extend(vectors.into_iter().flat_map(|(name, vector)| [0, 1, 2].map(|k: usize| (name, vector[k]))));
    values.extend(output.length.map(|length| ("length", length)));
    values.extend(output.leg_velocity.map(|velocity| ("leg velocity", velocity)));
    values
}

/// The outputs whose derivative is a mean over the last internal step.
fn mean(output: &Output) -> [Vector3<f64>; 3] {
    [output.acceleration, output.felt_specific_force, output.felt_angular_velocity]
}

#[test]
fn derivatives_are_those_of_differences() {
    let mut washout = washout(&[("tilt.rateLimit", 1.0), ("tilt.accelerationLimit", 20.0)]);
    assert_eq!(mean(&washout.output_derivative()), [Vector3::zeros(); 3], "before the first step");
    let mut before = washout.output();
    let mut largest: Vec<f64> = exact(&before).iter().map(|_| 0.0).collect();
    for k in 0..4000 {
        washout.step_between(&moving(k as f64 * STEP), &moving((k + 1) as f64 * STEP), STEP);
        let (output, derivative) = (washout.output(), washout.output_derivative());
        for ((value, start), found) in mean(&output).iter().zip(mean(&before)).zip(mean(&derivative)) {
            assert!((found - (value - start) / STEP).amax() < 1e-9 * (1.0 + found.amax()), "step {k}");
        }
        let earlier = std::mem::replace(&mut before, output);
        if k < 1000 {
            // The ride begins with jumps.
            continue;
        }
        let mut next = washout.clone();
        next.step_between(&moving((k + 1) as f64 * STEP), &moving((k + 2) as f64 * STEP), STEP);
        let values = exact(&earlier).into_iter().zip(exact(&next.output())).zip(exact(&derivative));
        for ((((name, start), (_, end)), (_, found)), largest) in values.zip(&mut largest) {
            let difference = (end - start) / (2.0 * STEP);
            *largest = largest.max(found.abs());
            // The acceleration changes from step to step, and the nearest end of a stroke changes.
            let tolerance = if name == "stroke margin" { 0.2 } else { 0.01 };
            assert!((found - difference).abs() < tolerance, "step {k}, {name}: {found} beside {difference}");
        }
    }
    assert!(largest.iter().all(|largest| *largest > 0.02), "every output moves: {largest:?}");
}

#[test]
fn a_plans_age_grows_with_time() {
    for (strategy, rate) in [(1.0, 0.0), (3.0, 0.0), (4.0, 1.0)] {
        assert_eq!(washout(&[("strategy", strategy)]).output_derivative().plan_age, rate);
    }
}
