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
