//! A simulation with its measures: rows and findings.

use crate::measures::statistics::rms;
use crate::measures::{Axes, Measures, Row, bound_rows};
use moris_washout::interface::STANDARD_GRAVITY;

use crate::Simulation;
use crate::advice::Advice;

/// A simulation, its measures, and the least possible errors.
#[derive(Clone, Copy, Debug)]
pub struct Evaluated<'a> {
    /// All inputs and outputs.
    pub simulation: &'a Simulation,
    /// The measures.
    pub measures: &'a Measures,
    /// The least RMS error of the specific force that a controller could reach, by axis \[m/s2\];
    /// none where it is not known.
    pub bounds: Axes<Option<f64>>,
    /// Simulated alternatives; none where nothing is wrong, or none were simulated.
    pub advice: Option<&'a Advice>,
}

impl Evaluated<'_> {
    /// The rows of the measures, and of the bounds with the felt error.
    pub fn rows(&self) -> Vec<Row> {
        let on_axis = |axis: usize| {
            let felt = self.measures.force[axis]?.rms_error;
            Some(bound_rows(["x", "y", "z"][axis], self.desired_rms(axis), felt, self.bounds[axis]?))
        };
        self.measured_rows().into_iter().chain((0..3).filter_map(on_axis).flatten()).collect()
    }

    /// The rows of the measures alone; of another washout's motion, without values that are not
    /// known.
    pub fn measured_rows(&self) -> Vec<Row> {
        let rows = self.measures.rows();
        match &self.simulation.foreign {
            Some(foreign) => rows.into_iter().map(|row| foreign.known(row)).collect(),
            None => rows,
        }
    }

    /// RMS of the desired specific force as a deviation from rest \[m/s2\]: the error
    /// of a platform at rest.
    pub fn desired_rms(&self, axis: usize) -> f64 {
        let rest = [0.0, 0.0, STANDARD_GRAVITY][axis];
        rms(self.simulation.inputs.iter().map(|input| input.specific_force[axis] - rest))
    }

    /// RMS of the desired angular velocity \[rad/s\].
    pub fn desired_rate_rms(&self, axis: usize) -> f64 {
        rms(self.simulation.desired_rates().iter().map(|rate| rate[axis]))
    }
}

/// A text with its first letter in upper case.
pub fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
