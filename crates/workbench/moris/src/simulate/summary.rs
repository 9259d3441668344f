//! Summary of a simulation on the terminal.

use moris_measures::comfort::{Comfort, Excess};
use moris_measures::cues::Cues;
use moris_measures::fidelity::Fidelity;

use super::Outcome;
use crate::recording::Recording;
use crate::text_table::TextTable;

/// Stands where a number is not defined.
const UNDEFINED: &str = "–";

/// The recording, what was found, and for each set of parameters a table of measures.
pub fn text(recording: &Recording, outcomes: &[Outcome]) -> String {
    let mut text =
        format!("{}: {:.1} s at {:.0} Hz\n", recording.name, recording.manoeuvre.duration(), 1.0 / recording.step());
    for warning in &recording.warnings {
        text += &format!("  {warning}\n");
    }
    for outcome in outcomes {
        let setup = &outcome.setup;
        text += &format!("\n{}, parameters {}:\n", setup.rig_name, setup.parameters_name);
        for finding in outcome.evaluated().findings() {
            text += &format!("  {}\n", finding.text);
        }
        text += &format!("\n{}", table(outcome));
    }
    text
}

/// The measures of the cues, axis by axis; axes on which nothing happens are left out.
fn table(outcome: &Outcome) -> TextTable {
    let measures = &outcome.measures;
    let header = [
        "felt against desired",
        "RMS error",
        "bound",
        "peak error",
        "shake",
        "jolt",
        "peak",
        "correlation",
        "delay",
        "sensed: RMS error",
        "false cues",
        "missing cues",
    ];
    let mut table = TextTable::new(header);
    let kinds = [
        ("force", "m/s²", 1.0, &measures.force, &measures.sensed_force, &measures.force_cues),
        ("rate", "°/s", 1f64.to_degrees(), &measures.rate, &measures.sensed_rate, &measures.rate_cues),
    ];
    for (kind, unit, factor, raw, sensed, cues) in kinds {
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            if let Some(fidelity) = &raw[axis] {
                let is_force = kind == "force";
                let bound = outcome.bounds[axis].as_ref().filter(|_| is_force).map(|bound| bound.bound.rms_error);
                let comfort = measures.comfort[axis].as_ref().filter(|_| is_force);
                let row = row(fidelity, bound, comfort, sensed[axis].as_ref(), &cues[axis], unit, factor);
                table.push([format!("{kind} {name}")].into_iter().chain(row).collect());
            }
        }
    }
    table
}

fn row(
    raw: &Fidelity,
    bound: Option<f64>,
    comfort: Option<&Comfort>,
    sensed: Option<&Fidelity>,
    cues: &Cues,
    unit: &str,
    factor: f64,
) -> [String; 11] {
    let number = |value: f64| format!("{:.2} {unit}", factor * value);
    let excess = |excess: Option<Excess>| excess.map(|excess| number(excess.value));
    let or_undefined = |text: Option<String>| text.unwrap_or_else(|| UNDEFINED.to_owned());
    [
        number(raw.rms_error),
        or_undefined(bound.map(number)),
        number(raw.peak_error),
        or_undefined(comfort.and_then(|comfort| excess(comfort.shake))),
        or_undefined(comfort.and_then(|comfort| excess(comfort.jolt))),
        or_undefined(comfort.and_then(|comfort| excess(Some(comfort.peak)))),
        or_undefined(raw.correlation.map(|correlation| format!("{correlation:.3}"))),
        or_undefined(raw.delay.map(|delay| format!("{:.0} ms", (1000.0 * delay).round() + 0.0))),
        or_undefined(sensed.map(|sensed| number(sensed.rms_error))),
        format!("{:.1} %", 100.0 * cues.false_cues),
        format!("{:.1} %", 100.0 * cues.missing_cues),
    ]
}
