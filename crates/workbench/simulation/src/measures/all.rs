//! All measures of a run.

use std::array::from_fn;

use moris_washout::interface::STANDARD_GRAVITY;

use super::comfort::{Comfort, Reference, comfort_once, divisions};
use super::cues::{Cues, FORCE_THRESHOLDS, RATE_THRESHOLDS, cues};
use super::effort::{Effort, effort};
use super::fidelity::{Fidelity, fidelity};
use super::incongruence::{Incongruence, incongruence};
use super::run::{Run, Series, axis};
use super::shape::{Desired, Shape};
use super::sickness::{dose, share_sick};
use super::vestibular::{CANALS, OTOLITHS, SensorModel, sensed};
use crate::Refusal;

/// Something of each axis x, y, z.
pub type Axes<T> = [T; 3];

/// The desired force on each axis, prepared for several runs.
pub type References = Axes<Option<Reference>>;

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
    /// Sign, time and proportion of the specific force of surge and sway.
    pub shape: Shape,
    /// Effort of the platform.
    pub effort: Effort,
    /// The rider's likely words on the whole run.
    pub rider: Rider,
}

/// Motion sickness and the worst moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Rider {
    /// Share of people who are sick after half an hour of such motion \[%\]: in the vehicle and on
    /// the platform.
    pub sick: [f64; 2],
    /// Dose of ISO 2631-1 \[m/s^1.5\]: in the vehicle and on the platform.
    pub dose: [f64; 2],
    /// None where nothing is desired along x and y.
    pub incongruence: Option<Incongruence>,
}

impl Rider {
    fn of([desired, felt]: [&[[f64; 3]]; 2], rates: [&dyn Series<3>; 2], step: f64) -> Self {
        let sick = |(force, rate)| share_sick(force, &series_vectors(rate), step);
        Rider {
            sick: [(desired, rates[0]), (felt, rates[1])].map(sick),
            dose: [desired, felt].map(|force| dose(force, step)),
            incongruence: incongruence(desired, felt, step),
        }
    }
}

impl Measures {
    /// Measures a run.
    ///
    /// # Errors
    /// The run's series do not fit together or hold something that is no number.
    pub fn of(run: &Run) -> Result<Self, Refusal> {
        Self::with(run, None)
    }

    /// As [`Measures::of`] for one of several runs with the same desired force, of which it keeps
    /// what costs most.
    ///
    /// # Errors
    /// As [`Measures::of`].
    pub fn with(run: &Run, mut references: Option<&mut References>) -> Result<Self, Refusal> {
        run.check()?;
        // The otoliths are at rest at standard gravity.
        let upright = [0.0, 0.0, STANDARD_GRAVITY];
        let force = SensedSignal { sensor: &OTOLITHS, rest: upright, thresholds: FORCE_THRESHOLDS, step: run.step };
        let rate = SensedSignal { sensor: &CANALS, rest: [0.0; 3], thresholds: RATE_THRESHOLDS, step: run.step };
        let force = force.compare(run.desired_force, run.felt_force);
        let rate = rate.compare(run.desired_rate, run.felt_rate);
        let divisions = divisions(run.desired_force.count(), run.felt_force_within_steps.count());
        let mut comfort_of = |k: usize| {
            let desired: Vec<f64> = axis(run.desired_force, k).collect();
            let felt = axis(run.felt_force_within_steps, k);
            let Some(references) = &mut references else { return comfort_once(&desired, felt, upright[k], run.step) };
            let new = || Reference::new(&desired, divisions, upright[k], run.step);
            let kept = references[k].take().filter(|kept| kept.is_for(divisions, run.step));
            references[k].insert(kept.unwrap_or_else(new)).comfort(felt)
        };
        let comfort = from_fn(|k| force[k].raw.is_some().then(|| comfort_of(k)));
        let [desired, felt] = [series_vectors(run.desired_force), series_vectors(run.felt_force)];
        Ok(Measures {
            comfort,
            force: force.each_ref().map(|axis| axis.raw),
            rate: rate.each_ref().map(|axis| axis.raw),
            sensed_force: force.each_ref().map(|axis| axis.sensed),
            sensed_rate: rate.each_ref().map(|axis| axis.sensed),
            force_cues: force.map(|axis| axis.cues),
            rate_cues: rate.map(|axis| axis.cues),
            shape: Desired::new(&desired, run.step).shape(&felt, run.scale),
            effort: effort(&run.platform),
            rider: Rider::of([&desired, &felt], [run.desired_rate, run.felt_rate], run.step),
        })
    }
}

/// The vectors of a series.
fn series_vectors(series: &dyn Series<3>) -> Vec<[f64; 3]> {
    (0..series.count()).map(|sample| series.at(sample)).collect()
}

/// A vector signal with the organ that senses it.
struct SensedSignal<'a> {
    sensor: &'a SensorModel,
    rest: [f64; 3],
    thresholds: [f64; 3],
    step: f64,
}

/// Felt against desired on an axis.
struct Comparison {
    raw: Option<Fidelity>,
    sensed: Option<Fidelity>,
    cues: Cues,
}

impl SensedSignal<'_> {
    fn compare(&self, desired: &dyn Series<3>, felt: &dyn Series<3>) -> Axes<Comparison> {
        from_fn(|k| {
            let [desired, felt] = [desired, felt].map(|signal| axis(signal, k).collect::<Vec<f64>>());
            let raw = fidelity(&desired, &felt, self.step);
            let [desired, felt] = [desired, felt].map(|signal| sensed(self.sensor, &signal, self.rest[k], self.step));
            Comparison {
                raw,
                sensed: fidelity(&desired, &felt, self.step),
                cues: cues(&desired, &felt, self.thresholds[k]),
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Limits, Platform};
    use super::*;

    #[test]
    fn kept_references_change_nothing() {
        let count = 400;
        let force = |scale: f64, step: f64, count: usize| -> Vec<[f64; 3]> {
            (0..count)
                .map(|k| step * k as f64)
                .map(|t| [scale * (3.0 * t).sin(), 0.1 * t, 9.8 + scale * t.cos()])
                .collect()
        };
        let desired = force(1.0, 0.01, count);
        let mut references = References::default();
        // Another number of samples to a step needs other references.
        for (scale, divisions) in [(0.5, 10), (0.7, 10), (0.7, 5)] {
            let (felt, rest) = (force(scale, 0.01, count), vec![[0.0; 3]; count]);
            let run = Run {
                step: 0.01,
                desired_force: &desired,
                felt_force: &felt,
                felt_force_within_steps: &force(scale, 0.01 / divisions as f64, divisions * (count - 1) + 1),
                desired_rate: &rest,
                scale: [1.0; 2],
                felt_rate: &rest,
                platform: Platform {
                    legs: &vec![[1.3; 6]; count],
                    stroke: [1.0, 1.6],
                    displacement: &rest,
                    tilt_rate: &vec![[0.0; 2]; count],
                    limited: &vec![Limits::default(); count],
                },
            };
            let measures = Measures::with(&run, Some(&mut references)).unwrap();
            assert_eq!(measures, Measures::of(&run).unwrap());
            assert!(measures.comfort[0].is_some() && references[0].is_some());
        }
    }
}
