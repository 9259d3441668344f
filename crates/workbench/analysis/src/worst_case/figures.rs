//! Error and comfort of what is felt, on a ride and over all rides.

use moris_simulation::measures::comfort::Reference;
use moris_simulation::measures::fidelity::rms_error;
use moris_washout::nalgebra::Vector3;

use super::commands::Commands;
use crate::measure::targets::{LEAST_FORCE, geometric_mean_of};
use crate::recording::Recording;

/// Surge and sway.
const AXES: [usize; 2] = [0, 1];

/// The desired force of a ride, prepared for comparisons with many felt ones.
#[derive(Clone, Debug)]
pub struct Desired {
    axes: [DesiredAxis; 2],
    /// Samples of the felt force to a sample of the recording.
    divisions: usize,
}

#[derive(Clone, Debug)]
struct DesiredAxis {
    force: Vec<f64>,
    comfort: Reference,
    /// True where enough is desired for the error to count.
    counts: bool,
}

/// The figures of a ride.
#[derive(Clone, Debug, PartialEq)]
pub struct RideFigures {
    /// RMS errors of surge and sway, where they count \[m/s2\].
    errors: Vec<f64>,
    /// The larger shake and the larger jolt of both \[m/s2\].
    comfort: [f64; 2],
}

/// Measure of which the worst case is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Geometric mean of the RMS errors.
    Error,
    /// Largest shake of surge and sway.
    Shake,
    /// Largest jolt of surge and sway.
    Jolt,
}

impl Measure {
    /// All measures, in the table's order.
    pub const ALL: [Measure; 3] = [Measure::Error, Measure::Shake, Measure::Jolt];
}

/// The figures of all rides, in the order of [`Measure::ALL`] \[m/s2\].
pub type Figures = [f64; 3];

impl Desired {
    /// The desired force of a recording, for forces felt at the steps of these commands.
    pub fn of(recording: &Recording, commands: &Commands) -> Self {
        let axis = |axis: usize| {
            let force: Vec<f64> = recording.inputs().iter().map(|input| input.specific_force[axis]).collect();
            let at_rest = rms_error(&vec![0.0; force.len()], &force);
            let comfort = Reference::new(&force, commands.divisions, 0.0, recording.step());
            DesiredAxis { force, comfort, counts: at_rest >= LEAST_FORCE }
        };
        Desired { axes: AXES.map(axis), divisions: commands.divisions }
    }

    /// Compares what is felt, errors at the recording's samples and comfort at all.
    pub fn compared_with(&self, felt: &[Vector3<f64>]) -> RideFigures {
        let (mut errors, mut comfort) = (Vec::new(), [0.0f64; 2]);
        for (axis, desired) in AXES.into_iter().zip(&self.axes) {
            let felt: Vec<f64> = felt.iter().map(|felt| felt[axis]).collect();
            if desired.counts {
                let samples: Vec<f64> = felt.iter().step_by(self.divisions).copied().collect();
                errors.push(rms_error(&desired.force, &samples));
            }
            let [shake, jolt, _] = desired.comfort.comfort(felt.into_iter()).values();
            comfort = [comfort[0].max(shake), comfort[1].max(jolt)];
        }
        RideFigures { errors, comfort }
    }
}

/// The figures over all rides; none where no channel counts.
pub fn over_rides<'a>(rides: impl Iterator<Item = &'a RideFigures> + Clone) -> Option<Figures> {
    let (error, count) = geometric_mean_of(rides.clone().flat_map(|ride| ride.errors.iter().copied()));
    let largest = |index: usize| rides.clone().map(|ride| ride.comfort[index]).fold(0.0, f64::max);
    (count > 0).then(|| [error, largest(0), largest(1)])
}
