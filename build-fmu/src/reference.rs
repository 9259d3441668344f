//! A reference ride inside the FMU: an input, and the output that belongs to it. With it, users of
//! the FMU can check that their tool runs it right.
//!
//! The files are those of the layered standard fmi-ls-ref: a manifest, a list of experiments, and
//! for each of them a table of inputs and one of outputs. The outputs are computed by the model in
//! Rust, without FMI.

use std::collections::BTreeMap;

use moris_interface::{Causality, Identity, Kind, Model, SlotModel};

use crate::archive::Contents;

/// The communication steps in a second: inputs are set at the beginning of each and held.
const STEPS_PER_SECOND: usize = 100;

/// The files of a model's reference ride, given its tables of inputs and outputs;
/// `stop` is its end \[s\].
pub fn files(name: &str, stop: f64, input: String, output: String) -> Contents {
    // Directory of the layered standard's files.
    const REFERENCE_DIRECTORY: &str = "extra/org.fmi-standard.fmi-ls-ref";
    const MANIFEST_TEMPLATE: &str = include_str!("../reference/fmi-ls-manifest.xml");
    const EXPERIMENTS_TEMPLATE: &str = include_str!("../reference/experiments.exp");
    let fill = |text: &str| {
        text.replace("{{name}}", name)
            .replace("{{stop}}", &stop.to_string())
            .replace("{{step}}", &(1.0 / STEPS_PER_SECOND as f64).to_string())
    };
    let file = |file: &str, text: String| (format!("{REFERENCE_DIRECTORY}/{file}"), text.into_bytes());
    Contents::from([
        file("fmi-ls-manifest.xml", fill(MANIFEST_TEMPLATE)),
        file(&format!("{name}.exp"), fill(EXPERIMENTS_TEMPLATE)),
        file(&format!("{name}_in.csv"), input),
        file(&format!("{name}_ref.csv"), output),
    ])
}

/// The table with a column for each array variable, its values separated by spaces, as FMPy and
/// fmusim read it. Elements that the table lacks have their start values.
///
/// # Panics
/// A column is not one of the model's variables.
pub fn as_arrays(identity: &Identity, start: &[f64], table: &str) -> String {
    let mut lines = table.lines();
    let names: Vec<&str> = lines.next().expect("a line of names").split(',').skip(1).collect();
    let slots: Vec<usize> =
        names.iter().map(|name| identity.slot(name).expect("one of the model's variables")).collect();
    let mut rows: Vec<usize> = slots.iter().map(|&slot| slot - usize::from(identity.slots[slot].element)).collect();
    rows.dedup();
    let mut text = "time".to_owned();
    for &first in &rows {
        text += &format!(",{}", identity.row(first).array_name());
    }
    for line in lines {
        let (time, values) = line.split_once(',').expect("a time and values");
        let values: BTreeMap<usize, &str> = slots.iter().copied().zip(values.split(',')).collect();
        let value = |slot: usize| values.get(&slot).map_or_else(|| start[slot].to_string(), |&cell| cell.to_owned());
        text += &format!("\n{time}");
        for &first in &rows {
            let elements: Vec<String> = (first..first + identity.row(first).slots()).map(value).collect();
            text += &format!(",{}", elements.join(" "));
        }
    }
    text + "\n"
}

/// A table of inputs over time, linear between its rows.
pub struct Stimuli {
    names: Vec<&'static str>,
    rows: Vec<Vec<f64>>,
}

impl Stimuli {
    /// Reads a comma-separated table. Its first line has the names, of which the first is `time`.
    /// The others are numbers, with time ascending.
    ///
    /// # Panics
    /// The text is no such table. The tables belong to the sources.
    pub fn new(text: &'static str) -> Self {
        let mut lines = text.lines();
        let names = lines.next().expect("a line of names").split(',').collect();
        let number = |cell: &str| cell.parse().expect("a number");
        let rows = lines.map(|line| line.split(',').map(number).collect()).collect();
        Stimuli { names, rows }
    }

    /// The time of the last row \[s\].
    pub fn end(&self) -> f64 {
        self.rows.last().expect("a row")[0]
    }

    /// The columns' values at a time, the time itself first.
    fn at(&self, time: f64) -> Vec<f64> {
        let after = self.rows.partition_point(|row| row[0] < time).clamp(1, self.rows.len() - 1);
        let (from, to) = (&self.rows[after - 1], &self.rows[after]);
        let fraction = (time - from[0]) / (to[0] - from[0]);
        from.iter().zip(to).map(|(from, to)| from + fraction * (to - from)).collect()
    }
}

/// The model's real outputs for these inputs and start values (one for each slot), as a
/// comma-separated table of ten decimals.
///
/// # Panics
/// An input is not one of the model's, or its start values are not usable.
pub fn output<M: Model>(input: &Stimuli, start: &[f64]) -> String {
    // Communication steps from one row of the output to the next.
    const STEPS_PER_ROW: usize = 20;
    let identity = M::IDENTITY;
    let inputs: Vec<usize> =
        input.names[1..].iter().map(|name| identity.slot(name).expect("one of the model's inputs")).collect();
    let is_recorded = |&slot: &usize| {
        let row = identity.row(slot);
        row.causality == Causality::Output && matches!(row.kind, Kind::Real(_))
    };
    let outputs: Vec<usize> = (0..identity.slots.len()).filter(is_recorded).collect();

    let mut slots = start.to_vec();
    let set = |slots: &mut [f64], time: f64| {
        for (&slot, value) in inputs.iter().zip(input.at(time).into_iter().skip(1)) {
            slots[slot] = value;
        }
    };
    set(&mut slots, 0.0);
    let mut model = M::from_slots(&slots).expect("start values are usable");

    let names = outputs.iter().map(|&slot| identity.variable_name(slot));
    let mut table = std::iter::once("time".to_owned()).chain(names).collect::<Vec<_>>().join(",");
    table.push('\n');
    let time = |step: usize| step as f64 / STEPS_PER_SECOND as f64;
    for step in 0..=(input.end() * STEPS_PER_SECOND as f64).round() as usize {
        if step > 0 {
            set(&mut slots, time(step - 1));
            model.step_slots(&slots, None, time(step) - time(step - 1));
        }
        if step.is_multiple_of(STEPS_PER_ROW) {
            model.write_outputs(&mut slots);
            table += &time(step).to_string();
            for &slot in &outputs {
                // Adding 0 makes a negative zero a plain one.
                let value = (slots[slot] * 1e10).round() / 1e10 + 0.0;
                table += &format!(",{value}");
            }
            table.push('\n');
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_are_linear_between_rows_and_end_with_the_last() {
        let stimuli = Stimuli::new("time,a,b\n0,1,0\n1,3,-2\n4,3,1\n");
        assert_eq!(stimuli.at(0.0), [0.0, 1.0, 0.0]);
        assert_eq!(stimuli.at(0.5), [0.5, 2.0, -1.0]);
        assert_eq!(stimuli.at(1.0), [1.0, 3.0, -2.0]);
        assert_eq!(stimuli.at(2.0), [2.0, 3.0, -1.0]);
        assert_eq!(stimuli.at(4.0), [4.0, 3.0, 1.0]);
        assert_eq!(stimuli.end(), 4.0);
    }
}
