//! Fit of felt to desired motion, as an observer that keeps sums only.

use moris_washout::{Input, Output};
use nalgebra::Vector3;

use crate::Observer;

/// Errors of the felt specific force, and stroke used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    steps: usize,
    squared_error: Vector3<f64>,
    peak_error: Vector3<f64>,
    smallest_margin: f64,
}

impl Default for Fit {
    fn default() -> Self {
        Fit { steps: 0, squared_error: Vector3::zeros(), peak_error: Vector3::zeros(), smallest_margin: f64::INFINITY }
    }
}

impl Observer for Fit {
    fn observe(&mut self, input: &Input, output: &Output) {
        let error = output.felt_specific_force - input.specific_force;
        self.steps += 1;
        self.squared_error += error.component_mul(&error);
        self.peak_error = self.peak_error.sup(&error.abs());
        self.smallest_margin = self.smallest_margin.min(output.stroke_margin);
    }
}

impl Fit {
    /// RMS error of the felt specific force, by axis of the head frame \[m/s2\]; zero before the
    /// first step.
    pub fn rms_error(&self) -> Vector3<f64> {
        (self.squared_error / self.steps.max(1) as f64).map(f64::sqrt)
    }

    /// Largest error of the felt specific force, by axis of the head frame \[m/s2\].
    pub fn peak_error(&self) -> Vector3<f64> {
        self.peak_error
    }

    /// The least stroke that was left to any actuator \[m\]; infinite before the first step.
    pub fn smallest_margin(&self) -> f64 {
        self.smallest_margin
    }
}
