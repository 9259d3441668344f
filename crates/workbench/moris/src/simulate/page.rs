//! The report's data.

use moris_report::{Chart, Finding, Line, Report, ReportError, Run, Simulator, Thinning, Weight};
use moris_washout::interface::STANDARD_GRAVITY;

use super::{Outcome, Simulation, simulator};
use crate::recording::Recording;

/// Largest page without simulation, and with it \[bytes\].
const LARGEST: usize = 3_000_000;
const LARGEST_WITH_SIMULATION: usize = 4_200_000;
/// Samples that fit into the largest page if their curves are smooth, and the least that are worth
/// showing, of all sets together.
const MOST_SAMPLES: usize = 150_000;
const LEAST_SAMPLES: usize = 4_000;

/// The page of a recording with one or several sets of parameters, with as many
/// samples as fit into it. `command` simulates the recording with a parameter file whose name is to
/// follow.
///
/// # Errors
/// The report does not fit together.
pub fn html(recording: &Recording, outcomes: &[Outcome], command: Option<String>) -> Result<String, ReportError> {
    let samples = outcomes[0].simulation.inputs.len() * outcomes.len();
    let mut most = samples.min(MOST_SAMPLES);
    loop {
        let report = report(recording, outcomes, most / outcomes.len());
        let page = moris_report::html(&report)?;
        if page.len() <= LARGEST || most <= LEAST_SAMPLES {
            let Some(simulator) = simulator::of(recording, &outcomes[0], command) else { return Ok(page) };
            return with_simulation(report, simulator, page);
        }
        let fitting = 0.95 * most as f64 * LARGEST as f64 / page.len() as f64;
        most = (fitting as usize).max(LEAST_SAMPLES);
    }
}

/// The page with as much of the recording's inputs as fit into it; `page` is it without simulation.
fn with_simulation(mut report: Report, mut simulator: Simulator, page: String) -> Result<String, ReportError> {
    let mut room = LARGEST_WITH_SIMULATION.saturating_sub(page.len());
    loop {
        let samples = simulator.inputs[0].len();
        report.simulator = Some(simulator);
        let with_all = moris_report::html(&report)?;
        if with_all.len() <= LARGEST_WITH_SIMULATION {
            return Ok(with_all);
        }
        let Some(mut smaller) = report.simulator.take() else { return Ok(page) };
        simulator::shorten(&mut smaller, samples, with_all.len() - page.len(), room);
        if smaller.inputs[0].len() < simulator::LEAST_SAMPLES {
            return Ok(page);
        }
        room = room * 19 / 20;
        simulator = smaller;
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
        simulator: None,
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
    let run = outcome.evaluated().run(&outcome.setup.parameters_name, thinning);
    Run { charts: bound_charts(outcome, thinning), ..run }
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
