//! The report's data.

use std::array;

use moris_measures::Row;
use moris_report::{Better, Chart, Cues, Finding, Limited, Line, Measure, Report, ReportError, Run, Thinning, Weight};
use moris_washout::Output;
use moris_washout::interface::STANDARD_GRAVITY;

use super::{Outcome, Simulation, findings};
use crate::capitalised;
use crate::recording::Recording;

/// Largest page \[bytes\].
const LARGEST: usize = 3_000_000;
/// Samples that fit into the largest page if their curves are smooth, and the least that are worth
/// showing, of all sets together.
const MOST_SAMPLES: usize = 150_000;
const LEAST_SAMPLES: usize = 4_000;

/// The page of a recording with one or several sets of parameters, with as many
/// samples as fit into it.
///
/// # Errors
/// The report does not fit together.
pub fn html(recording: &Recording, outcomes: &[Outcome]) -> Result<String, ReportError> {
    let samples = outcomes[0].simulation.inputs.len() * outcomes.len();
    let mut most = samples.min(MOST_SAMPLES);
    loop {
        let page = moris_report::html(&report(recording, outcomes, most / outcomes.len()))?;
        if page.len() <= LARGEST || most <= LEAST_SAMPLES {
            return Ok(page);
        }
        let fitting = 0.95 * most as f64 * LARGEST as f64 / page.len() as f64;
        most = (fitting as usize).max(LEAST_SAMPLES);
    }
}

/// The report of a recording with one or several sets of parameters, of which the first is shown
/// first, with at most so many samples of each.
fn report(recording: &Recording, outcomes: &[Outcome], most: usize) -> Report {
    let first = &outcomes[0];
    let thinning = Thinning::new(first.simulation.inputs.len(), most);
    let warnings = recording.warnings.iter().map(|warning| Finding { weight: Weight::Warning, text: warning.clone() });
    Report {
        title: recording.name.clone(),
        subtitle: format!(
            "{:.1} s on {}, parameters: {}",
            recording.manoeuvre.duration(),
            first.setup.rig_name,
            outcomes.iter().map(|outcome| outcome.setup.parameters_name.as_str()).collect::<Vec<_>>().join(", ")
        ),
        findings: warnings.collect(),
        provenance: vec![
            ("Recording".to_owned(), format!("{}, {:.0} samples a second", recording.name, 1.0 / recording.step())),
            ("Gravity".to_owned(), gravity(recording).to_owned()),
            ("Curves".to_owned(), resolution(first, &thinning)),
            ("Made by".to_owned(), format!("moris {}", env!("CARGO_PKG_VERSION"))),
        ],
        rig: (&first.setup.parameters).into(),
        runs: outcomes.iter().map(|outcome| run(outcome, &thinning)).collect(),
        selected: 0,
    }
}

/// Method of removing gravity.
fn gravity(recording: &Recording) -> &'static str {
    if recording.has_orientation {
        "removed as gravityRemoval says, by the recorded orientation"
    } else {
        "no orientation recorded: what is cued is what differs from (0, 0, g), the force felt at rest"
    }
}

/// Samples that the curves show.
fn resolution(outcome: &Outcome, thinning: &Thinning) -> String {
    match thinning.factor() {
        1.0 => "every sample".to_owned(),
        factor => format!(
            "least and greatest value of every {:.1} ms; the table of outputs has every sample",
            2e3 * factor * outcome.simulation.step
        ),
    }
}

fn run(outcome: &Outcome, thinning: &Thinning) -> Run {
    let Outcome { setup, simulation, .. } = outcome;
    let Simulation { inputs, outputs, .. } = simulation;
    let curve = |value: fn(&Output) -> f64| thinning.extremes(|k| value(&outputs[k]));
    let desired_rates = simulation.desired_rates();
    let leans = inputs.iter().any(|input| input.lean != 0.0);
    Run {
        name: setup.parameters_name.clone(),
        findings: findings::of(outcome),
        times: thinning.at_times(|k| k as f64 * simulation.step),
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
        limited: Limited {
            tilt: thinning.any(|k| outputs[k].tilt_limited),
            safety: thinning.any(|k| outputs[k].safety_active),
            actuator: thinning.any(|k| outputs[k].actuator_limited),
        },
        limits: (&simulation.parameters).into(),
        measures: outcome.rows().into_iter().map(measure).collect(),
        charts: bound_charts(outcome, thinning),
    }
}

/// The bound, axis by axis.
fn bound_charts(outcome: &Outcome, thinning: &Thinning) -> Vec<Chart> {
    let Simulation { outputs, step, .. } = &outcome.simulation;
    let chart = |axis: usize| {
        let bound = outcome.bounds[axis].as_ref()?;
        let rest = [0.0, 0.0, STANDARD_GRAVITY][axis];
        let line = |label: &str, values: Vec<f64>| Line { label: label.to_owned(), values };
        let best = |k: usize| bound.bound.trajectory.felt(k as f64 * step);
        Some(Chart {
            title: format!("{}: the best possible", ["Surge", "Sway", "Heave"][axis]),
            quantity: "specific force without gravity [m/s²]".to_owned(),
            times: Vec::new(),
            lines: vec![
                line("desired", thinning.extremes(|k| bound.desired[k])),
                line("felt", thinning.extremes(|k| outputs[k].felt_specific_force[axis] - rest)),
                line("best possible", thinning.extremes(best)),
            ],
            limits: Vec::new(),
        })
    };
    (0..3).filter_map(chart).collect()
}

fn measure(row: Row) -> Measure {
    Measure {
        group: capitalised(&row.subject),
        name: row.name.to_owned(),
        value: row.value,
        unit: row.unit.to_owned(),
        better: better(row.name),
        definition: row.definition.to_owned(),
        source: row.source.to_owned(),
    }
}

/// Which of two values of a measure of this name is the better.
fn better(name: &str) -> Better {
    match name {
        "correlation" | "smallest stroke margin" => Better::More,
        "stroke used" | "sensed in the vehicle" | "largest tilt rate" | "bound" | "relative bound" => Better::Neither,
        _ => Better::Less,
    }
}
