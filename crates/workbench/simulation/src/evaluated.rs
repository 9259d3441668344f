//! A simulation with its measures: rows, findings and the run of a report.

use std::array;

use moris_measures::{Axes, Better, Measures, Row, bound_rows};
use moris_report::{Cues, LimitHistory, Measure, Run, Thinning};
use moris_washout::Output;
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
    /// Another scale; none where it was not computed.
    pub advice: Option<Advice>,
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

    /// The run of a report, without further charts and without advice: the page simulates other
    /// parameters, and searches for none.
    pub fn run(&self, name: &str, thinning: &Thinning) -> Run {
        let Simulation { inputs, outputs, step, parameters, .. } = self.simulation;
        let curve = |value: fn(&Output) -> f64| thinning.extremes(|k| value(&outputs[k]));
        let desired_rates = self.simulation.desired_rates();
        let tilt_limits = self.simulation.tilt_limits();
        let leans = inputs.iter().any(|input| input.lean != 0.0);
        let without_advice = Evaluated { advice: None, ..*self };
        Run {
            name: name.to_owned(),
            verdict: without_advice.headline(),
            findings: without_advice.findings(),
            times: thinning.at_times(|k| k as f64 * step),
            desired: Cues {
                specific_force: array::from_fn(|axis| thinning.extremes(|k| inputs[k].specific_force[axis])),
                angular_velocity: array::from_fn(|axis| thinning.extremes(|k| desired_rates[k][axis])),
            },
            felt: Cues {
                specific_force: array::from_fn(|axis| thinning.extremes(|k| outputs[k].felt_specific_force[axis])),
                angular_velocity: array::from_fn(|axis| thinning.extremes(|k| outputs[k].felt_angular_velocity[axis])),
            },
            // A pose is that of one time.
            position: array::from_fn(|axis| thinning.at_times(|k| outputs[k].position[axis])),
            orientation: array::from_fn(|axis| thinning.at_times(|k| outputs[k].orientation.to_vector()[axis])),
            legs: array::from_fn(|leg| thinning.extremes(|k| outputs[k].length[leg])),
            tilt: [curve(|output| output.tilt_roll), curve(|output| output.tilt_pitch)],
            tilt_rate: [curve(|output| output.tilt_roll_rate), curve(|output| output.tilt_pitch_rate)],
            lean: if leans { thinning.at_times(|k| inputs[k].lean) } else { Vec::new() },
            limited: LimitHistory {
                tilt: thinning.any(|k| tilt_limits.iter().flatten().any(|flags| flags[k])),
                tilt_by: tilt_limits.each_ref().map(|axis| axis.each_ref().map(|flags| thinning.any(|k| flags[k]))),
                soft: thinning.any(|k| outputs[k].soft_limited),
                safety: thinning.any(|k| outputs[k].safety_active),
                actuator: thinning.any(|k| outputs[k].actuator_limited),
            },
            limits: parameters.into(),
            measures: self.rows().into_iter().map(measure).collect(),
            charts: Vec::new(),
        }
    }
}

fn rms(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    (values.map(|value| value * value).sum::<f64>() / count).sqrt()
}

fn measure(row: Row) -> Measure {
    Measure {
        group: capitalised(&row.subject),
        name: row.name.to_owned(),
        value: row.value,
        unit: row.unit.to_owned(),
        better: match row.better {
            Better::Less => moris_report::Better::Less,
            Better::More => moris_report::Better::More,
            Better::Neither => moris_report::Better::Neither,
        },
        definition: row.definition.to_owned(),
        source: row.source.to_owned(),
    }
}

/// A text with its first letter in upper case.
pub fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
