//! Measures and findings for other programs, as JSON.

use serde_json::{Value, json};

use super::{Outcome, findings, fits_the_rig};
use crate::recording::Recording;

/// A recording with one or several parameter sets.
///
/// Each measure has the subject, name, value and unit of the report's table; an
/// undefined value is `null`.
pub fn recording(recording: &Recording, outcomes: &[Outcome]) -> Value {
    json!({
        "recording": recording.name,
        "duration": recording.manoeuvre.duration(),
        "step": recording.step(),
        "warnings": recording.warnings,
        "results": outcomes.iter().map(result).collect::<Vec<Value>>(),
    })
}

fn result(outcome: &Outcome) -> Value {
    let bounds: Vec<Option<f64>> =
        outcome.bounds.iter().map(|bound| bound.as_ref().map(|bound| bound.bound.rms_error)).collect();
    let measures: Vec<Value> = outcome
        .measures
        .rows()
        .into_iter()
        .map(|row| json!({ "subject": row.subject, "name": row.name, "value": row.value, "unit": row.unit }))
        .collect();
    json!({
        "rig": outcome.setup.rig_name,
        "parameters": outcome.setup.parameters_name,
        "fits": fits_the_rig(outcome),
        "findings": findings::of(outcome).into_iter().map(|finding| finding.text).collect::<Vec<String>>(),
        "forceBounds": bounds,
        "measures": measures,
    })
}
