//! One channel of a recording: desired and felt signals, and errors.

use moris_measures::comfort::Comfort;
use moris_measures::cues::Cues;
use moris_measures::fidelity::rms_error;
use moris_measures::{Axes, Measures};
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::Vector3;

use crate::simulate::{AxisBound, Simulation};

/// Quantity of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Specific force along x, y or z \[m/s2\].
    Force(usize),
    /// Angular velocity about x, y or z \[rad/s\].
    Rate(usize),
}

impl Quantity {
    /// The three forces, then the three rates.
    pub const ALL: [Quantity; 6] = [
        Quantity::Force(0),
        Quantity::Force(1),
        Quantity::Force(2),
        Quantity::Rate(0),
        Quantity::Rate(1),
        Quantity::Rate(2),
    ];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Force(axis) => ["surge", "sway", "heave"][axis],
            Quantity::Rate(axis) => ["roll rate", "pitch rate", "yaw rate"][axis],
        }
    }
}

/// A channel's figures, in m/s2 or rad/s.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Quantity.
    pub quantity: Quantity,
    /// RMS of the desired signal, as a deviation from rest: the error of a platform at rest.
    pub at_rest: f64,
    /// The least RMS error that any controller could reach; none where it was not computed.
    pub bound: Option<f64>,
    /// RMS error of the felt signal.
    pub error: f64,
    /// RMS error of the vestibular model's response.
    pub sensed_error: f64,
    /// Shake, jolt and peak of a force; none of a rate.
    pub comfort: Option<Comfort>,
    /// Fractions of the time with a cue in the vehicle, a false one and a
    /// missing one on the platform.
    pub cues: Cues,
}

impl Channel {
    /// The error as a multiple of that of a platform at rest.
    pub fn ratio(&self) -> f64 {
        self.error / self.at_rest
    }
}

/// The channels of a recording on which something is desired or felt.
pub fn channels(simulation: &Simulation, measures: &Measures, bounds: &Axes<Option<AxisBound>>) -> Vec<Channel> {
    let rest = Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
    let forces: Vec<Vector3<f64>> = simulation.inputs.iter().map(|input| input.specific_force - rest).collect();
    let rates = simulation.desired_rates();
    let rms = |desired: &[Vector3<f64>], axis: usize| {
        rms_error(&vec![0.0; desired.len()], &desired.iter().map(|sample| sample[axis]).collect::<Vec<_>>())
    };
    let channel = |quantity| {
        let (desired, raw, sensed, cues, axis) = match quantity {
            Quantity::Force(k) => (&forces, measures.force, measures.sensed_force, measures.force_cues, k),
            Quantity::Rate(k) => (&rates, measures.rate, measures.sensed_rate, measures.rate_cues, k),
        };
        let is_force = matches!(quantity, Quantity::Force(_));
        Some(Channel {
            quantity,
            at_rest: rms(desired, axis),
            bound: bounds[axis].as_ref().filter(|_| is_force).map(|bound| bound.bound.rms_error),
            error: raw[axis]?.rms_error,
            sensed_error: sensed[axis].map_or(0.0, |sensed| sensed.rms_error),
            comfort: measures.comfort[axis].filter(|_| is_force),
            cues: cues[axis],
        })
    };
    Quantity::ALL.into_iter().filter_map(channel).collect()
}
