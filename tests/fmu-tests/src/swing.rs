//! Inputs of the washout that shake every axis.

use moris_washout::Input;
use moris_washout::interface::RollPitchYaw;

/// Values at a time: specific force, angular velocity, orientation, speed, lean.
pub fn values(time: f64) -> [f64; 11] {
    let mut values = std::array::from_fn(|k| (0.3 + 0.1 * k as f64) * ((1.0 + 0.7 * k as f64) * time).sin());
    values[2] += 9.80665;
    values
}

/// The same values as the Rust API has them.
pub fn input(values: &[f64; 11]) -> Input {
    let u = values;
    Input {
        specific_force: [u[0], u[1], u[2]].into(),
        angular_velocity: [u[3], u[4], u[5]].into(),
        orientation: RollPitchYaw::new(u[6], u[7], u[8]),
        speed: u[9],
        lean: u[10],
        engaged: true,
    }
}
