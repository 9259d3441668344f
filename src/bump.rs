//! Bumpless changes: what a new parameter would make jump is held, and fades away.

use serde::{Deserialize, Serialize};

/// A correction to a filter's input that decays to zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bump {
    value: f64,
}

/// Time constant with which a bump fades \[s\].
const TIME_CONSTANT: f64 = 0.5;
/// Bumps below this are over.
const OVER: f64 = 1e-15;

impl Bump {
    /// Adds a correction.
    pub fn add(&mut self, value: f64) {
        self.value += value;
    }

    /// Lets `step` seconds pass; the correction at their start and end.
    pub fn advance(&mut self, step: f64) -> (f64, f64) {
        if self.value == 0.0 {
            return (0.0, 0.0);
        }
        let start = self.value;
        let end = start * libm::exp(-step / TIME_CONSTANT);
        self.value = if end.abs() < OVER { 0.0 } else { end };
        (start, self.value)
    }
}
