//! The runs' curves as tables beside the figures.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::trace::{Sample, Trace};

/// Writes a CSV file for each trace into the directory and returns their paths.
///
/// # Errors
/// A file cannot be written.
pub fn write_curves(directory: &Path, traces: &[Trace]) -> Result<Vec<PathBuf>> {
    let write = |trace: &Trace| {
        let path = directory.join(format!("{}.csv", file_stem(trace)));
        fs::write(&path, trace_table(trace)).with_context(|| format!("cannot write {}", path.display()))?;
        Ok(path)
    };
    traces.iter().map(write).collect()
}

/// Run and parameters, with hyphens for what is no letter or number.
fn file_stem(trace: &Trace) -> String {
    let name = format!("run {} {}", trace.run, trace.parameters);
    let words = name.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-").to_lowercase()
}

fn trace_table(trace: &Trace) -> String {
    // Time between the rows [s], if the run's steps are shorter.
    const MIN_ROW_INTERVAL: f64 = 0.01;
    const COLUMN_TITLES: &str = "time [s],desired force x [m/s2],desired force y [m/s2],desired force z [m/s2],felt force x [m/s2],\
    felt force y [m/s2],felt force z [m/s2],desired rate x [rad/s],desired rate y [rad/s],desired rate z [rad/s],\
    felt rate x [rad/s],felt rate y [rad/s],felt rate z [rad/s],position x [m],position y [m],position z [m],\
    leg 1 [m],leg 2 [m],leg 3 [m],leg 4 [m],leg 5 [m],leg 6 [m]";
    let every = ((MIN_ROW_INTERVAL / trace.step).round() as usize).max(1);
    let mut text = format!("{COLUMN_TITLES}\n");
    for sample in trace.samples.iter().step_by(every) {
        let Sample { time, desired_force, felt_force, desired_rate, felt_rate, position, legs, .. } = sample;
        let _ = write!(text, "{time:.3}");
        let vectors = [desired_force, felt_force, desired_rate, felt_rate, position];
        for value in vectors.into_iter().flatten().chain(legs) {
            let _ = write!(text, ",{value:.6}");
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_a_row_each_ten_milliseconds_with_a_value_a_column() {
        let sample = |k: u32| Sample {
            time: f64::from(k) * 0.001,
            felt_force: [0.5, 0.0, 9.8],
            legs: [1.1, 1.2, 1.3, 1.4, 1.5, 1.6],
            ..Sample::default()
        };
        let samples = (0..=30).map(sample).collect();
        let trace = Trace { run: "a brisk", parameters: "paper + preaction", step: 0.001, samples, ..Trace::default() };
        assert_eq!(file_stem(&trace), "run-a-brisk-paper-preaction");
        let text = trace_table(&trace);
        let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
        assert_eq!(rows.len(), 5);
        assert!(rows.iter().all(|row| row.len() == rows[0].len()));
        let value = |name: &str| rows[2][rows[0].iter().position(|column| *column == name).unwrap()];
        assert_eq!(
            [value("time [s]"), value("felt force x [m/s2]"), value("leg 6 [m]")],
            ["0.010", "0.500000", "1.600000"]
        );
    }
}
