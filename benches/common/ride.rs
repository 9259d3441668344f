//! A recording for benchmarks and profilers.

use std::f64::consts::TAU;

use moris_washout::Input;

/// A smooth ride on all axes that comes back to its start after 8192 steps of 1 ms.
pub fn smooth() -> Vec<Input> {
    (0..8192)
        .map(|k| {
            let phase = TAU * f64::from(k) / 8192.0;
            let mut input = Input::default();
            input.specific_force.x = 0.5 * phase.sin();
            input.specific_force.y = 0.3 * (2.0 * phase).sin();
            input.specific_force.z += 0.2 * (3.0 * phase).sin();
            input.angular_velocity.x = 0.02 * (2.0 * phase).sin();
            input.orientation.roll = 0.1 * (2.0 * phase).sin();
            input.orientation.pitch = 0.02 * phase.sin();
            input
        })
        .collect()
}

/// Starts, stops and bends of two minutes that never repeat, with an engine's and a road's
/// vibration, in steps of 1 ms.
pub fn brisk() -> Vec<Input> {
    let waves = |t: f64, waves: &[(f64, f64)]| -> f64 { waves.iter().map(|(a, f)| a * (TAU * f * t).sin()).sum() };
    (0..120_000)
        .map(|k| {
            let t = f64::from(k) * 1e-3;
            let mut input = Input::default();
            input.specific_force.x += waves(t, &[(2.0, 0.031), (1.5, 0.083), (1.0, 0.217), (0.4, 11.3), (0.3, 23.7)]);
            input.specific_force.y += waves(t, &[(1.5, 0.047), (1.2, 0.113), (0.8, 0.307), (0.4, 13.1), (0.3, 27.1)]);
            input.specific_force.z += waves(t, &[(0.8, 1.7), (1.0, 9.1)]);
            input.angular_velocity.x = waves(t, &[(0.1, 0.2), (0.2, 12.7)]);
            input.angular_velocity.y = waves(t, &[(0.05, 0.3), (0.1, 15.1)]);
            input
        })
        .collect()
}
