//! The trace of one simulated run.

use moris_simulation::measures::effort::{Effort, effort};
use moris_simulation::measures::{Limits, Platform};

/// Everything that the tables and figures need of one communication point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Time \[s\].
    pub time: f64,
    /// Specific force that the vehicle's rider would feel, in head axes \[m/s2\].
    pub desired_force: [f64; 3],
    /// Angular velocity that the vehicle's rider would feel \[rad/s\].
    pub desired_rate: [f64; 3],
    /// Specific force that the rider on the platform feels, in head axes \[m/s2\].
    pub felt_force: [f64; 3],
    /// Angular velocity that the rider on the platform feels, in head axes \[rad/s\].
    pub felt_rate: [f64; 3],
    /// The actuators' lengths \[m\].
    pub legs: [f64; 6],
    /// Position of the platform in the base frame \[m\].
    pub position: [f64; 3],
    /// Rates of tilt coordination's roll and pitch \[rad/s\].
    pub tilt_rate: [f64; 2],
    /// Limits active during the step before this sample.
    pub limited: Limits<bool>,
}

/// One run with one set of parameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// The manoeuvre's name.
    pub run: &'static str,
    /// The parameter set's name.
    pub parameters: &'static str,
    /// Time from one sample to the next \[s\].
    pub step: f64,
    /// Height of the platform in the base frame at neutral \[m\].
    pub neutral_height: f64,
    /// Shortest and longest length that an actuator may have \[m\].
    pub stroke: [f64; 2],
    /// The samples, the first of them before the first step.
    pub samples: Vec<Sample>,
}

impl Trace {
    /// One quantity at all samples.
    pub fn series<T>(&self, quantity: impl Fn(&Sample) -> T) -> Vec<T> {
        self.samples.iter().map(quantity).collect()
    }

    /// Summary of the platform's motion.
    pub fn effort(&self) -> Effort {
        effort(&Platform {
            legs: &self.series(|sample| sample.legs),
            stroke: self.stroke,
            displacement: &self.series(|Sample { position: [x, y, z], .. }| [*x, *y, z - self.neutral_height]),
            tilt_rate: &self.series(|sample| sample.tilt_rate),
            limited: &self.series(|sample| sample.limited),
        })
    }
}
