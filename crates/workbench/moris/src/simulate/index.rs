//! The list of the pages of several recordings, the worst first.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use moris_pages::report::{IndexRow, index_html};
use moris_simulation::Weight;

use super::{Outcome, counted, listed};
use crate::recording::Recording;
use crate::text;
use crate::text_table::or_undefined;

/// A recording with one of the parameter sets, or one that failed, in the list.
pub struct Entry {
    row: IndexRow,
    /// Fraction of the time in which a safety unit or the actuator guard was active; more than 1
    /// where the recording could not be used.
    limited: f64,
    /// RMS error of the sensed specific force, all axes \[m/s2\].
    error: f64,
}

/// Heads of the figures. Errors come first: they stand beside the verdict on a small screen, too.
const FIGURE_TITLES: [&str; 11] = [
    "sensed error, surge m/s²",
    "sway m/s²",
    "heave m/s²",
    "all axes m/s²",
    "limits active %",
    "soft limits active %",
    "stroke used %",
    "shake m/s²",
    "jolt m/s²",
    "peak m/s²",
    "duration s",
];

impl Entry {
    /// The entries of a recording, one for each outcome; `page` is its report.
    pub fn of_recording(recording: &Recording, outcomes: &[Outcome], page: &Path) -> Vec<Self> {
        let name = |outcome: &Outcome| match outcomes.len() {
            1 => recording.name.clone(),
            _ => listed([recording.name.as_str(), &outcome.setup.parameters_name].into_iter()),
        };
        outcomes.iter().map(|outcome| Entry::new(name(outcome), recording, outcome, page)).collect()
    }

    /// The entry of a recording that could not be used, and why.
    pub fn failed(name: String, reason: String) -> Self {
        let row = IndexRow { name, verdict: reason, ..IndexRow::default() };
        Entry { row, limited: f64::INFINITY, error: f64::INFINITY }
    }

    fn new(name: String, recording: &Recording, outcome: &Outcome, page: &Path) -> Self {
        let measures = &outcome.measures;
        let effort = &measures.effort;
        let limited = effort.limited.safety.max(effort.limited.actuator);
        let errors = measures.sensed_force.each_ref().map(|axis| axis.as_ref().map(|fidelity| fidelity.rms_error));
        let error = errors.iter().flatten().map(|error| error * error).sum::<f64>().sqrt();
        let figure = |value: Option<f64>| or_undefined(value.map(|value| format!("{value:.2}")));
        let limits = [
            format!("{:.1}", 100.0 * limited),
            format!("{:.1}", 100.0 * effort.limited.soft),
            format!("{:.0}", 100.0 * effort.stroke_used),
        ];
        // The largest of the axes.
        let worst = |k: usize| measures.comfort.iter().flatten().map(|comfort| comfort.values()[k]).fold(0.0, f64::max);
        let comfort = [worst(0), worst(1), worst(2)].map(|value| figure(Some(value)));
        let verdict = outcome.evaluated().verdict();
        let row = IndexRow {
            name,
            file: Some(page.file_name().unwrap_or_default().to_string_lossy().into_owned()),
            is_good: verdict.weight == Weight::Good,
            verdict: verdict.text,
            cells: errors
                .map(figure)
                .into_iter()
                .chain([figure(Some(error))])
                .chain(limits)
                .chain(comfort)
                .chain([format!("{:.1}", recording.manoeuvre.duration())])
                .collect(),
        };
        Entry { row, limited, error }
    }
}

/// Writes the list into a directory; returns its file. The entries are those of each recording,
/// which stand together.
///
/// # Errors
/// The file cannot be written.
pub fn write(directory: &Path, rig: &str, parameters: &str, mut recordings: Vec<Vec<Entry>>) -> Result<PathBuf> {
    recordings.retain(|entries| !entries.is_empty());
    recordings.sort_by(|a, b| b[0].limited.total_cmp(&a[0].limited).then(b[0].error.total_cmp(&a[0].error)));
    let title = format!("{}, the worst first", counted(recordings.len(), "recording"));
    let rows: Vec<IndexRow> = recordings.into_iter().flatten().map(|entry| entry.row).collect();
    // A recording may be called index.
    let is_taken = rows.iter().any(|row| row.file.as_deref() == Some("index.html"));
    let file = directory.join(if is_taken { "index-of-recordings.html" } else { "index.html" });
    let subtitle = text!["index-subtitle", rig, parameters].to_string();
    fs::write(&file, index_html(&title, &subtitle, &FIGURE_TITLES, &rows))
        .with_context(|| format!("cannot write {}", file.display()))?;
    Ok(file)
}
