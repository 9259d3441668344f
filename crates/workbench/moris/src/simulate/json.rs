//! Measures and findings for other programs, as JSON.

use std::path::PathBuf;

use moris_simulation::measures::Row;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Outcome, fit, is_better_than_rest};
use crate::recording::Recording;
use crate::words;

/// A recording, simulated with one or several sets of parameters.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
#[schemars(deny_unknown_fields)]
pub struct SimulatedRecording {
    /// Name of the recording.
    recording: String,
    /// Duration, in s.
    duration: f64,
    /// Time between samples, in s.
    step: f64,
    /// Conspicuous properties of the recording.
    warnings: Vec<String>,
    /// Results with each set of parameters, in the order of the command line.
    results: Vec<SetResult>,
    /// Files written: tables of outputs, and the report.
    files: Vec<String>,
}

/// Results with one set of parameters.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
#[schemars(deny_unknown_fields)]
struct SetResult {
    /// Name of the rig.
    rig: String,
    /// Name of the parameters.
    parameters: String,
    /// False if a safety unit or the actuator guard was active; null for another washout's motion
    /// without poses and legs.
    fits: Option<bool>,
    /// False if a channel has a larger error than on a platform at rest, which is also sensed as
    /// false.
    better_than_rest: bool,
    /// The verdict with what to change.
    verdict: String,
    /// Findings in sentences, the most important first.
    findings: Vec<String>,
    /// Least RMS error of the specific force along x, y and z that any controller could reach, in
    /// m/s²; null without a desired signal, and with --no-bound.
    force_bounds: [Option<f64>; 3],
    /// Measures; those of axes on which nothing is desired and nothing felt are left out.
    measures: Vec<Measure>,
}

/// A measure; docs/measures.md defines each.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Measure {
    /// A channel, or a part of the platform.
    subject: String,
    /// Name of the measure.
    name: &'static str,
    /// Value; null where it is not defined.
    value: Option<f64>,
    /// Unit of the value; empty without one.
    unit: &'static str,
}

/// A recording with one or several parameter sets, and the files written.
///
/// Each measure has the subject, name, value and unit of the report's table; an
/// undefined value is `null`.
pub fn recording(recording: &Recording, outcomes: &[Outcome], files: &[PathBuf]) -> SimulatedRecording {
    SimulatedRecording {
        recording: recording.name.clone(),
        duration: recording.manoeuvre.duration(),
        step: recording.step(),
        warnings: words::warnings(recording),
        results: outcomes.iter().map(set_result).collect(),
        files: files.iter().map(|file| file.display().to_string()).collect(),
    }
}

fn set_result(outcome: &Outcome) -> SetResult {
    let measures = outcome.evaluated().measured_rows().into_iter();
    let measure = |Row { subject, name, value, unit, .. }: Row| Measure { subject, name, value, unit };
    SetResult {
        rig: outcome.setup.rig_name.clone(),
        parameters: outcome.setup.parameters_name.clone(),
        fits: fit(&outcome.evaluated()),
        better_than_rest: is_better_than_rest(&outcome.evaluated()),
        verdict: outcome.evaluated().verdict().text,
        findings: outcome.evaluated().findings().into_iter().map(|finding| finding.text).collect(),
        force_bounds: outcome.evaluated().bounds,
        measures: measures.map(measure).collect(),
    }
}
