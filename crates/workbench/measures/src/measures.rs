//! All measures of a run.

use crate::comfort::{Comfort, comfort};
use crate::cues::{Cues, FORCE_THRESHOLDS, RATE_THRESHOLDS, cues};
use crate::effort::{Effort, effort};
use crate::fidelity::{Fidelity, fidelity};
use crate::run::{Run, RunError, axis};
use crate::vestibular::{CANALS, OTOLITHS, SensorModel, sensed};

/// Standard gravity, at which the otoliths are at rest \[m/s2\].
const STANDARD_GRAVITY: f64 = 9.80665;

/// Something of each axis x, y, z.
pub type Axes<T> = [T; 3];

/// All measures of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Measures {
    /// Specific force, felt against desired; none on an axis on which nothing is
    /// desired and nothing felt.
    pub force: Axes<Option<Fidelity>>,
    /// Comfort of the specific force; none where `force` has none.
    pub comfort: Axes<Option<Comfort>>,
    /// Angular velocity, felt against desired.
    pub rate: Axes<Option<Fidelity>>,
    /// The same of the specific force that the otoliths sense.
    pub sensed_force: Axes<Option<Fidelity>>,
    /// The same of the angular velocity that the semicircular canals sense.
    pub sensed_rate: Axes<Option<Fidelity>>,
    /// False and missing cues of specific force.
    pub force_cues: Axes<Cues>,
    /// False and missing cues of angular velocity.
    pub rate_cues: Axes<Cues>,
    /// Effort of the platform.
    pub effort: Effort,
}

impl Measures {
    /// Measures a run.
    ///
    /// # Errors
    /// The run's series do not fit together or hold something that is no number.
    pub fn of(run: &Run) -> Result<Self, RunError> {
        run.check()?;
        let upright = [0.0, 0.0, STANDARD_GRAVITY];
        let force = Channel { sensor: &OTOLITHS, rest: upright, thresholds: FORCE_THRESHOLDS, step: run.step };
        let rate = Channel { sensor: &CANALS, rest: [0.0; 3], thresholds: RATE_THRESHOLDS, step: run.step };
        let [force_x, force_y, force_z] = force.compare(run.desired_force, run.felt_force);
        let [rate_x, rate_y, rate_z] = rate.compare(run.desired_rate, run.felt_rate);
        let comfort_of = |k: usize| {
            let (desired, felt) = (axis(run.desired_force, k), axis(run.felt_force_within_steps, k));
            comfort(&desired, &felt, upright[k], run.step)
        };
        let is_felt = [&force_x, &force_y, &force_z].map(|axis| axis.raw.is_some());
        Ok(Measures {
            comfort: std::array::from_fn(|k| is_felt[k].then(|| comfort_of(k))),
            force: [force_x.raw, force_y.raw, force_z.raw],
            rate: [rate_x.raw, rate_y.raw, rate_z.raw],
            sensed_force: [force_x.sensed, force_y.sensed, force_z.sensed],
            sensed_rate: [rate_x.sensed, rate_y.sensed, rate_z.sensed],
            force_cues: [force_x.cues, force_y.cues, force_z.cues],
            rate_cues: [rate_x.cues, rate_y.cues, rate_z.cues],
            effort: effort(&run.platform),
        })
    }
}

/// Sensed vector signal.
struct Channel<'a> {
    sensor: &'a SensorModel,
    rest: [f64; 3],
    thresholds: [f64; 3],
    step: f64,
}

/// One axis, felt against desired.
struct Comparison {
    raw: Option<Fidelity>,
    sensed: Option<Fidelity>,
    cues: Cues,
}

impl Channel<'_> {
    fn compare(&self, desired: &[[f64; 3]], felt: &[[f64; 3]]) -> [Comparison; 3] {
        std::array::from_fn(|k| self.compare_axis(k, &axis(desired, k), &axis(felt, k)))
    }

    fn compare_axis(&self, k: usize, desired: &[f64], felt: &[f64]) -> Comparison {
        let sense = |signal| sensed(self.sensor, signal, self.rest[k], self.step);
        let (sensed_desired, sensed_felt) = (sense(desired), sense(felt));
        Comparison {
            raw: fidelity(desired, felt, self.step),
            sensed: fidelity(&sensed_desired, &sensed_felt, self.step),
            cues: cues(&sensed_desired, &sensed_felt, self.thresholds[k]),
        }
    }
}
