//! The report's page of a recording: its data, out of outcomes.

pub mod simulator;
pub mod vehicle;

use moris_pages::report::{Chart, Line, MODULE_REMEDY, Report, Run, Simulator, Thinning, felt_chart};
use moris_simulation::{Finding, Weight};

use self::vehicle::vehicle;
use crate::message::Words;
use crate::outcome::{Outcome, listed};
use crate::recording::Recording;
use crate::texts::text;

/// The page of a recording with one or several sets of parameters, with as many
/// samples as fit into it. `command` simulates the recording with a parameter file whose name is to
/// follow. `words` are for the remedies in warnings.
pub fn html(recording: &Recording, outcomes: &[Outcome], command: &str, words: Words) -> String {
    // Largest page without simulation [bytes].
    const MAX_PAGE_SIZE: usize = 3_000_000;
    // Samples that fit into the largest page if their curves are smooth, and the least that are
    // worth showing, of all sets together.
    const MOST_SAMPLES: usize = 150_000;
    const LEAST_SAMPLES: usize = 4_000;
    let samples = outcomes[0].simulation.inputs.len() * outcomes.len();
    let mut most = samples.min(MOST_SAMPLES);
    loop {
        let report = recording_report(recording, outcomes, most / outcomes.len(), words);
        let page = moris_pages::report::html(&report);
        if page.len() <= MAX_PAGE_SIZE || most <= LEAST_SAMPLES {
            let is_foreign = outcomes[0].simulation.foreign.is_some();
            let simulator = simulator::of(recording, &outcomes[0], command).filter(|_| !is_foreign);
            let Some(simulator) = simulator else { return page };
            return with_simulation(report, simulator, page);
        }
        let fitting = 0.95 * most as f64 * MAX_PAGE_SIZE as f64 / page.len() as f64;
        most = (fitting as usize).max(LEAST_SAMPLES);
    }
}

/// The page with as much of the recording's inputs as fit into it; `page` is it without simulation.
fn with_simulation(mut report: Report, simulator: Simulator, page: String) -> String {
    // Largest page with simulation [bytes].
    const LARGEST_WITH_SIMULATION: usize = 4_200_000;
    // Fewer samples of a recording are not worth simulating in its page.
    const LEAST_SIMULATED: usize = 1_000;
    let mut page_of = |samples: usize| {
        let inputs = simulator.inputs.iter().map(|series| series[..samples].to_vec()).collect();
        report.simulator = Some(Simulator { inputs, ..simulator.clone() });
        moris_pages::report::html(&report)
    };
    let mut samples = simulator.inputs[0].len();
    let mut with_inputs = page_of(samples);
    let empty = if with_inputs.len() > LARGEST_WITH_SIMULATION { page_of(0).len() } else { 0 };
    while with_inputs.len() > LARGEST_WITH_SIMULATION {
        let room = LARGEST_WITH_SIMULATION.saturating_sub(empty);
        let fitting = 0.97 * samples as f64 * room as f64 / (with_inputs.len() - empty) as f64;
        samples = fitting as usize;
        if samples < LEAST_SIMULATED {
            return page;
        }
        with_inputs = page_of(samples);
    }
    with_inputs
}

/// The report of a recording with one or several sets of parameters, of which the first is shown
/// first, with at most so many samples of each.
fn recording_report(recording: &Recording, outcomes: &[Outcome], most: usize, words: Words) -> Report {
    let first = &outcomes[0];
    let thinning = Thinning::new(first.simulation.inputs.len(), most);
    let finding = |text: String| Finding { weight: Weight::Warning, text };
    let warnings = recording.warnings.iter().map(|warning| finding(warning.worded(words)));
    let (rig, sets) = (&first.setup.rig_name, listed(outcomes.iter().map(|one| one.setup.parameters_name.as_str())));
    Report {
        title: recording.name.clone(),
        subtitle: text!["page-subtitle", duration = recording.manoeuvre.duration(), rig, sets].to_string(),
        findings: warnings.collect(),
        provenance: vec![
            ("Recording".to_owned(), format!("{}, {:.0} samples a second", recording.name, 1.0 / recording.step())),
            ("Gravity".to_owned(), gravity_method(recording).to_owned()),
            ("Curves".to_owned(), shown_samples(first, &thinning)),
            ("Made by".to_owned(), format!("moris {}", moris_pages::PACKAGE_VERSION)),
        ],
        rig: (&first.setup.parameters).into(),
        vehicle: vehicle(recording),
        runs: outcomes.iter().map(|outcome| report_run(outcome, &thinning)).collect(),
        selected: 0,
        simulator: None,
        no_simulator_because: (!simulator::is_compiled() && first.simulation.foreign.is_none())
            .then_some(MODULE_REMEDY),
    }
}

/// Method of removing gravity.
fn gravity_method(recording: &Recording) -> &'static str {
    if recording.has_orientation {
        "removed as gravityRemoval says, by the recorded orientation"
    } else {
        "no orientation recorded: what is cued is what differs from (0, 0, g), the force felt at rest"
    }
}

/// Samples that the curves show.
fn shown_samples(outcome: &Outcome, thinning: &Thinning) -> String {
    match thinning.factor() {
        1.0 => "every sample".to_owned(),
        factor => text!["page-curves", milliseconds = 2e3 * factor * outcome.simulation.step].to_string(),
    }
}

fn report_run(outcome: &Outcome, thinning: &Thinning) -> Run {
    let run = moris_pages::report::run(&outcome.evaluated(), &outcome.setup.parameters_name, thinning);
    Run { charts: bound_charts(outcome, thinning), ..run }
}

/// The bound, axis by axis.
fn bound_charts(outcome: &Outcome, thinning: &Thinning) -> Vec<Chart> {
    let chart = |axis: usize| {
        let bound = outcome.bounds[axis].as_ref()?;
        let line = |label: &str, values: Vec<f64>| Line { label: label.to_owned(), values };
        let best = |k: usize| bound.bound.trajectory.felt(k as f64 * outcome.simulation.step);
        let mut chart = felt_chart(&outcome.simulation, axis, thinning);
        chart.lines.insert(0, line("desired", thinning.extremes(|k| bound.desired[k])));
        chart.lines.push(line("best possible", thinning.extremes(best)));
        Some(chart)
    };
    (0..3).filter_map(chart).collect()
}
