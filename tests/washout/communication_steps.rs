//! The host's communication step does not matter: the result is the same.

use moris_washout::{Input, Output};
use nalgebra::Vector3;

use crate::common::random::Random;
use crate::common::{G, washout};

/// From nothing to `to` between the times `from` and `until`, in a straight line.
fn ramp(t: f64, from: f64, until: f64, to: f64) -> f64 {
    to * ((t - from) / (until - from)).clamp(0.0, 1.0)
}

/// Ramps that begin and end at multiples of 50 ms, which every choice of steps here hits.
fn input(t: f64) -> Input {
    let turning = |from: f64, rate: f64| ramp(t, from, from + 0.5, rate) - ramp(t, from + 1.0, from + 1.5, rate);
    let force = Vector3::new(
        ramp(t, 0.5, 4.5, 1.5) - ramp(t, 10.0, 13.0, 2.0),
        ramp(t, 2.0, 6.0, -1.0) + ramp(t, 12.0, 14.0, 0.8),
        G + ramp(t, 1.0, 1.5, 0.8) - ramp(t, 2.0, 3.0, 0.8),
    );
    Input {
        specific_force: force,
        angular_velocity: Vector3::new(turning(1.0, 0.2), turning(3.0, -0.1), turning(5.0, 0.3)),
        lean: 0.1 + ramp(t, 6.0, 8.0, 0.04) - ramp(t, 15.0, 16.0, 0.02),
        ..Input::default()
    }
}

/// The compared outputs, in m, rad and m/s2.
fn quantities(output: &Output) -> Vec<f64> {
    let mut all = output.length.to_vec();
    all.extend_from_slice(output.position.as_slice());
    all.extend_from_slice(output.orientation.to_vector().as_slice());
    all.extend_from_slice(output.felt_specific_force.as_slice());
    all.extend([output.tilt_roll, output.tilt_pitch]);
    all
}

/// Rides 20 s; `parts` gives the shares of each 50 ms that the steps in it take. Returns the
/// output at every 50 ms.
fn simulated(mut parts: impl FnMut() -> Vec<f64>) -> Vec<Vec<f64>> {
    let mut washout = washout(&[]);
    let mut seen = Vec::new();
    for k in 0..400 {
        let (mut t, parts) = (f64::from(k) * 0.05, parts());
        let whole: f64 = parts.iter().sum();
        for part in parts {
            let step = 0.05 * part / whole;
            washout.step_between(&input(t), &input(t + step), step);
            t += step;
        }
        seen.push(quantities(&washout.output()));
    }
    seen
}

#[test]
fn steps_of_1_5_10_ms_and_irregular_ones_agree() {
    let reference = simulated(|| vec![1.0; 50]);
    let mut random = Random::new(7);
    let others = [
        ("5 ms", simulated(|| vec![1.0; 10])),
        ("10 ms", simulated(|| vec![1.0; 5])),
        ("50 ms", simulated(|| vec![1.0])),
        ("irregular coarse", simulated(|| (0..8).map(|_| random.between(1.0, 10.0)).collect())),
        ("irregular fine", simulated(|| (0..80).map(|_| random.between(1.0, 2.0)).collect())),
    ];
    for (name, other) in others {
        for (k, (a, b)) in reference.iter().zip(&other).enumerate() {
            for (q, (a, b)) in a.iter().zip(b).enumerate() {
                assert!((a - b).abs() < 1e-3, "{name} steps, quantity {q} at {k}: {a} and {b}");
            }
        }
    }
}
