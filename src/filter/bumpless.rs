//! Bumpless transfer: a jump that a new parameter would cause is held as a
//! correction, and fades away.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// A correction to the inputs of three filters that decays to zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FadingOffset {
    value: Vector3<f64>,
}

/// Time constant of the decay of an offset \[s\].
const TIME_CONSTANT: f64 = 0.5;
/// Offsets below this become zero.
const OVER: f64 = 1e-15;

impl FadingOffset {
    /// Adds a correction.
    pub fn add(&mut self, value: Vector3<f64>) {
        self.value += value;
    }

    /// Advances by `step` seconds. Returns the correction at their start and end.
    pub fn advance(&mut self, step: f64) -> (Vector3<f64>, Vector3<f64>) {
        let start = self.value;
        if start != Vector3::zeros() {
            let end = start * libm::exp(-step / TIME_CONSTANT);
            self.value = end.map(|value| if value.abs() < OVER { 0.0 } else { value });
        }
        (start, self.value)
    }
}
