//! Fit of felt to desired motion, as an observer.

use moris_measures::comfort::comfort;
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::{Input, Output};
use nalgebra::Vector3;

use crate::{Manoeuvre, Observer};

/// Errors of the felt specific force, stroke used, and comfort if asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    steps: usize,
    squared_error: Vector3<f64>,
    peak_error: Vector3<f64>,
    smallest_margin: f64,
    comfort: Comfort,
}

/// Comfort, which needs the felt force of the whole run.
#[derive(Clone, Debug, PartialEq)]
enum Comfort {
    /// Not asked for.
    Off,
    /// The felt force so far \[m/s2\].
    Running(Vec<Vector3<f64>>),
    /// Shake, jolt and peak \[m/s2\].
    Known([f64; 3]),
}

impl Default for Fit {
    /// Errors and stroke alone, of which it keeps sums only.
    fn default() -> Self {
        Fit {
            steps: 0,
            squared_error: Vector3::zeros(),
            peak_error: Vector3::zeros(),
            smallest_margin: f64::INFINITY,
            comfort: Comfort::Off,
        }
    }
}

impl Observer for Fit {
    fn feel(&mut self, felt: &Vector3<f64>) {
        if let Comfort::Running(series) = &mut self.comfort {
            series.push(*felt);
        }
    }

    fn observe(&mut self, input: &Input, output: &Output) {
        let error = output.felt_specific_force - input.specific_force;
        self.steps += 1;
        self.squared_error += error.component_mul(&error);
        self.peak_error = self.peak_error.sup(&error.abs());
        self.smallest_margin = self.smallest_margin.min(output.stroke_margin);
    }

    fn finish(&mut self, manoeuvre: &Manoeuvre) {
        if let Comfort::Running(felt) = &self.comfort {
            self.comfort = Comfort::Known(worst_comfort(manoeuvre, felt));
        }
    }
}

/// Shake, jolt and peak, the largest of the axes \[m/s2\].
fn worst_comfort(manoeuvre: &Manoeuvre, felt: &[Vector3<f64>]) -> [f64; 3] {
    let of_axis = |k: usize| {
        let desired: Vec<f64> = manoeuvre.inputs().iter().map(|input| input.specific_force[k]).collect();
        let felt: Vec<f64> = felt.iter().map(|felt| felt[k]).collect();
        comfort(&desired, &felt, [0.0, 0.0, STANDARD_GRAVITY][k], manoeuvre.step()).values()
    };
    let axes: [[f64; 3]; 3] = std::array::from_fn(of_axis);
    std::array::from_fn(|measure| axes.iter().map(|values| values[measure]).fold(0.0, f64::max))
}

impl Fit {
    /// As the default, with comfort. It keeps the felt force until the simulation ends.
    pub fn with_comfort() -> Self {
        Fit { comfort: Comfort::Running(Vec::new()), ..Fit::default() }
    }

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

    /// Shake, jolt and peak of the felt specific force beyond the desired one, the largest of the
    /// axes, and 0 where one is not available \[m/s2\]; see [`moris_measures::comfort`]. None
    /// unless constructed by [`Fit::with_comfort`] and finished.
    pub fn comfort(&self) -> Option<[f64; 3]> {
        match self.comfort {
            Comfort::Known(values) => Some(values),
            Comfort::Off | Comfort::Running(_) => None,
        }
    }
}
