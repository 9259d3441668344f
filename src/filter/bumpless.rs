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
    /// The correction now.
    pub fn value(&self) -> Vector3<f64> {
        self.value
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_offset_decays_with_its_time_constant_and_ends() {
        let mut offset = FadingOffset::default();
        offset.add(Vector3::new(1.0, -2.0, 0.0));
        for k in 0..100 {
            let (start, end) = offset.advance(0.02);
            let expected = |steps: i32| Vector3::new(1.0, -2.0, 0.0) * (-0.04 * f64::from(steps)).exp();
            assert!((start - expected(k)).amax() < 1e-12 && (end - expected(k + 1)).amax() < 1e-12);
        }
        // 1e-15 is reached after 35 time constants.
        offset.advance(17.0);
        assert_eq!(offset.advance(0.02), (Vector3::zeros(), Vector3::zeros()));
    }
}
