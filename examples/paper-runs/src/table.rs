//! The tables that the command prints.

use std::fmt;

use moris_simulation::measures::fidelity::fidelity;

use crate::trace::{Sample, Trace};

/// Rows of cells under a header; displayed with aligned columns, the first ones' text to the left
/// and numbers to the right.
#[derive(Clone, Debug)]
pub struct Table {
    title: &'static str,
    header: Vec<&'static str>,
    /// Columns of text, before those of numbers.
    text_columns: usize,
    rows: Vec<Vec<String>>,
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let widths: Vec<usize> = (0..self.header.len()).map(|column| self.width(column)).collect();
        writeln!(f, "{}", self.title)?;
        self.write_row(f, &widths, &self.header)?;
        let rules: Vec<String> = widths.iter().map(|&width| "─".repeat(width)).collect();
        self.write_row(f, &widths, &rules)?;
        self.rows.iter().try_for_each(|row| self.write_row(f, &widths, row))
    }
}

impl Table {
    fn width(&self, column: usize) -> usize {
        let cells = self.rows.iter().map(|row| row[column].chars().count());
        cells.fold(self.header[column].chars().count(), usize::max)
    }

    fn write_row(&self, f: &mut fmt::Formatter, widths: &[usize], cells: &[impl AsRef<str>]) -> fmt::Result {
        let padded = cells.iter().zip(widths).enumerate().map(|(column, (cell, &width))| {
            let cell = cell.as_ref();
            if column < self.text_columns { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        writeln!(f, "{}", padded.collect::<Vec<_>>().join("  ").trim_end())
    }
}

/// Felt against desired specific force.
pub fn force_table(traces: &[Trace]) -> Table {
    let title = "Specific force at the rider's head, felt against desired";
    let errors = ["RMS error [m/s2]", "peak error [m/s2]"];
    fidelity_table(title, errors, traces, |sample, axis| [sample.desired_force[axis], sample.felt_force[axis]])
}

/// Felt against desired angular velocity.
pub fn rate_table(traces: &[Trace]) -> Table {
    let title = "Angular velocity of the rider's head, felt against desired";
    let errors = ["RMS error [deg/s]", "peak error [deg/s]"];
    let rates = |sample: &Sample, axis: usize| [sample.desired_rate[axis], sample.felt_rate[axis]].map(f64::to_degrees);
    fidelity_table(title, errors, traces, rates)
}

/// A row for each axis on which something is desired or felt; `on_axis` is what.
fn fidelity_table(
    title: &'static str,
    [rms, peak]: [&'static str; 2],
    traces: &[Trace],
    on_axis: impl Fn(&Sample, usize) -> [f64; 2],
) -> Table {
    // Stands where a number is not defined.
    const UNDEFINED_MARK: &str = "–";
    const AXIS_NAMES: [&str; 3] = ["x", "y", "z"];
    let row = |trace: &Trace, axis: usize| {
        let [desired, felt] = [0, 1].map(|which| trace.series(|sample| on_axis(sample, axis)[which]));
        let fidelity = fidelity(&desired, &felt, trace.step)?;
        let mut row = trace_labels(trace);
        row.extend([
            AXIS_NAMES[axis].to_string(),
            number_text(fidelity.rms_error, 3),
            number_text(fidelity.peak_error, 3),
            fidelity.correlation.map_or(UNDEFINED_MARK.into(), |correlation| number_text(correlation, 4)),
            fidelity.delay.map_or(UNDEFINED_MARK.into(), |delay| number_text(1000.0 * delay, 1)),
        ]);
        Some(row)
    };
    Table {
        title,
        header: vec!["run", "parameters", "axis", rms, peak, "correlation", "delay [ms]"],
        text_columns: 3,
        rows: traces.iter().flat_map(|trace| (0..AXIS_NAMES.len()).filter_map(move |axis| row(trace, axis))).collect(),
    }
}

/// Table of the platform's motion.
pub fn platform_table(traces: &[Trace]) -> Table {
    let row = |trace: &Trace| {
        let effort = trace.effort();
        let mut row = trace_labels(trace);
        row.extend([
            number_text(effort.shortest_leg, 3),
            number_text(effort.longest_leg, 3),
            number_text(effort.largest_tilt_rate.to_degrees(), 3),
            number_text(100.0 * effort.limited.tilt, 1),
            number_text(100.0 * effort.limited.safety, 1),
            number_text(100.0 * effort.limited.actuator, 1),
            number_text(1000.0 * effort.final_distance, 2),
        ]);
        row
    };
    Table {
        title: "The platform",
        header: vec![
            "run",
            "parameters",
            "shortest leg [m]",
            "longest leg [m]",
            "tilt rate up to [deg/s]",
            "tilt limited [%]",
            "safety active [%]",
            "actuator limited [%]",
            "final distance from neutral [mm]",
        ],
        text_columns: 2,
        rows: traces.iter().map(row).collect(),
    }
}

fn trace_labels(trace: &Trace) -> Vec<String> {
    vec![trace.run.to_string(), trace.parameters.to_string()]
}

/// A number with so many decimals, never a negative zero.
fn number_text(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if is_zero { text.trim_start_matches('-').to_string() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Sample;

    /// Surge desired and felt, a constant heave that is missed, nothing in sway.
    fn trace() -> Trace {
        let sample = |k: u32| {
            let time = f64::from(k) * 0.01;
            let surge = time.sin();
            Sample {
                time,
                desired_force: [surge, 0.0, 9.80665],
                felt_force: [surge, 0.0, 9.80665 - 0.1 * surge * surge],
                legs: [1.25; 6],
                ..Sample::default()
            }
        };
        let samples = (0..1000).map(sample).collect();
        Trace { run: "a", parameters: "default", step: 0.01, samples, ..Trace::default() }
    }

    #[test]
    fn an_axis_without_motion_has_no_row_and_a_constant_one_no_correlation() {
        let table = force_table(&[trace()]);
        assert_eq!(table.rows.len(), 2);
        assert_eq!(table.rows[0], ["a", "default", "x", "0.000", "0.000", "1.0000", "0.0"]);
        assert_eq!(table.rows[1][2], "z");
        assert_eq!(table.rows[1][4..], ["0.100", "–", "–"]);
        assert!(rate_table(&[trace()]).rows.is_empty());
    }

    #[test]
    fn columns_are_aligned() {
        let text = force_table(&[trace()]).to_string();
        let lines: Vec<&str> = text.lines().skip(1).collect();
        assert_eq!(lines.len(), 4);
        assert!(lines.iter().all(|line| line.chars().count() == lines[0].chars().count()), "{text}");
    }

    #[test]
    fn there_is_no_negative_zero() {
        assert_eq!(number_text(-0.0001, 2), "0.00");
        assert_eq!(number_text(-0.011, 2), "-0.01");
    }
}
