//! Linearity of the washout for small signals on a single axis.
//!
//! - Position: s^2/D of the force.
//! - Angle: s^3/D of the rate.
//! - Tilt: the arcsine of 1 - s^4/D of the force, over gravity.

use moris_washout::Input;
use nalgebra::Vector3;

use crate::common::manoeuvres::smooth_step;
use crate::common::{G, accelerating, from_neutral, rk4, washout};

const STEP: f64 = 0.001;
/// 0.01 m/s2 or rad/s.
const AMPLITUDE: f64 = 0.01;

/// The paper's set has D(s) = (s + 2.5)^4 and (s + 1)^4, here as xi'''' = u - ... . The states
/// are xi''' down to xi.
fn chain_derivative(omega: f64, u: f64, [a, b, c, d]: &[f64; 4]) -> [f64; 4] {
    let (o2, o3, o4) = (omega * omega, omega.powi(3), omega.powi(4));
    [u - 4.0 * omega * a - 6.0 * o2 * b - 4.0 * o3 * c - o4 * d, *a, *b, *c]
}

/// The chain's states over 20 s, with the input held over each millisecond. Each has eight
/// steps of Runge-Kutta.
fn integrated(omega: f64, u: impl Fn(f64) -> f64) -> Vec<[f64; 4]> {
    let mut state = [0.0; 4];
    (0..20_000)
        .map(|k| {
            let held = u(f64::from(k) * STEP);
            for _ in 0..8 {
                state = rk4(0.0, state, STEP / 8.0, |_, x| chain_derivative(omega, held, x));
            }
            state
        })
        .collect()
}

/// A wave that begins gently, so that the tilt stays inside its limits.
fn wave(t: f64) -> f64 {
    AMPLITUDE * smooth_step(t, 0.0, 3.0) * (1.5 * t).sin()
}

fn step_signal(t: f64) -> f64 {
    if t >= 1.0 { AMPLITUDE } else { 0.0 }
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |largest, value| largest.max(value.abs()))
}

#[test]
fn position_is_s2_over_d_of_the_force() {
    for axis in 0..3 {
        for signal in [wave, step_signal] {
            let expected = integrated(2.5, signal);
            let mut washout = washout(&[("compensation", 1.0)]);
            let peak = largest(expected.iter().map(|state| state[1]));
            for (k, state) in expected.iter().enumerate() {
                let mut force = [0.0; 3];
                force[axis] = signal(k as f64 * STEP);
                washout.step(&accelerating(force[0], force[1], force[2]), STEP);
                let output = washout.output();
                let error = from_neutral(&output)[axis] - state[1];
                assert!(error.abs() < 1e-6 * peak, "axis {axis} at {k}: {error} of {peak}");
            }
        }
    }
}

#[test]
fn angle_is_s3_over_d_of_the_rate() {
    for axis in 0..3 {
        for signal in [wave, step_signal] {
            let expected = integrated(1.0, signal);
            let mut washout = washout(&[("compensation", 1.0), ("washoutLocation", 2.0)]);
            let peak = largest(expected.iter().map(|state| state[0]));
            for (k, state) in expected.iter().enumerate() {
                let mut angular_velocity = Vector3::zeros();
                angular_velocity[axis] = signal(k as f64 * STEP);
                washout.step(&Input { angular_velocity, ..Input::default() }, STEP);
                let error = washout.output().orientation.to_vector()[axis] - state[0];
                assert!(error.abs() < 1e-6 * peak, "axis {axis} at {k}: {error} of {peak}");
            }
        }
    }
}

#[test]
fn tilt_follows_the_low_pass_within_20_ms() {
    let low_pass = integrated(2.5, wave)
        .iter()
        .map(|[a, b, c, d]| 10.0 * a + 6.0 * 6.25 * b + 4.0 * 15.625 * c + 39.0625 * d)
        .collect::<Vec<_>>();
    let fastest = largest(low_pass.windows(2).map(|pair| (pair[1] - pair[0]) / STEP / G));
    let mut surge = washout(&[("compensation", 1.0)]);
    let mut sway = surge.clone();
    for (k, low) in low_pass.iter().enumerate() {
        let u = wave(k as f64 * STEP);
        surge.step(&accelerating(u, 0.0, 0.0), STEP);
        sway.step(&accelerating(0.0, u, 0.0), STEP);
        let (pitch, roll) = (surge.output().tilt_pitch, sway.output().tilt_roll);
        assert!((pitch + (low / G).asin()).abs() < 0.020 * fastest, "pitch at {k}");
        assert!((roll - (low / G).asin()).abs() < 0.020 * fastest, "roll at {k}");
    }
}
