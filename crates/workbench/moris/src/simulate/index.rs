//! The list of the pages of several recordings, the worst first.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use moris_report::{IndexRow, index_html};
use moris_simulation::findings::fits_freely;

use super::Outcome;
use crate::recording::Recording;

/// A recording in the list.
pub struct Entry {
    row: IndexRow,
    /// Fraction of the time in which a safety unit or the actuator guard was active.
    limited: f64,
    /// RMS error of the sensed specific force, all axes \[m/s2\].
    error: f64,
}

const HEADS: [&str; 11] = [
    "duration s",
    "limits active %",
    "soft limits active %",
    "stroke used %",
    "shake m/s²",
    "jolt m/s²",
    "peak m/s²",
    "sensed error, surge m/s²",
    "sway m/s²",
    "heave m/s²",
    "all axes m/s²",
];

impl Entry {
    /// The entry of a recording by its first outcome; `page` is its report.
    pub fn new(recording: &Recording, outcome: &Outcome, page: &Path) -> Self {
        let measures = &outcome.measures;
        let effort = &measures.effort;
        let limited = effort.safety_active.max(effort.actuator_limited);
        let errors = measures.sensed_force.each_ref().map(|axis| axis.as_ref().map(|fidelity| fidelity.rms_error));
        let error = errors.iter().flatten().map(|error| error * error).sum::<f64>().sqrt();
        let figure = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| format!("{value:.2}"));
        let first = [
            format!("{:.1}", recording.manoeuvre.duration()),
            format!("{:.1}", 100.0 * limited),
            format!("{:.1}", 100.0 * effort.soft_limited),
            format!("{:.0}", 100.0 * effort.stroke_used),
        ];
        // The largest of the axes.
        let worst = |k: usize| measures.comfort.iter().flatten().map(|comfort| comfort.values()[k]).fold(0.0, f64::max);
        let comfort = [worst(0), worst(1), worst(2)].map(|value| figure(Some(value)));
        let row = IndexRow {
            name: recording.name.clone(),
            file: page.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            is_good: fits_freely(measures),
            cells: first.into_iter().chain(comfort).chain(errors.map(figure)).chain([figure(Some(error))]).collect(),
        };
        Entry { row, limited, error }
    }
}

/// Writes the list into a directory; returns its file.
///
/// # Errors
/// The file cannot be written.
pub fn write(directory: &Path, rig: &str, parameters: &str, mut entries: Vec<Entry>) -> Result<PathBuf> {
    entries.sort_by(|a, b| b.limited.total_cmp(&a.limited).then(b.error.total_cmp(&a.error)));
    // A recording may be called index.
    let is_taken = entries.iter().any(|entry| entry.row.file == "index.html");
    let file = directory.join(if is_taken { "index-of-recordings.html" } else { "index.html" });
    let subtitle = format!(
        "{rig}, parameters: {parameters}. Recordings with active limits come first, then those with the larger error of the \
         sensed specific force."
    );
    let rows: Vec<IndexRow> = entries.into_iter().map(|entry| entry.row).collect();
    let title = format!("{} recordings, the worst first", rows.len());
    fs::write(&file, index_html(&title, &subtitle, &HEADS, &rows))
        .with_context(|| format!("cannot write {}", file.display()))?;
    Ok(file)
}
