//! The table of a simulation's inputs and outputs.

use std::path::Path;

use anyhow::{Context, Result};
use moris_interface::{Group, Writer, slot_count};
use moris_washout::{Input, Output};

use super::Simulation;

/// Digits after the point: micrometres, and no more than a sensor has.
const DECIMALS: usize = 6;

/// Writes every input and output at every sample, in columns named as the FMU's variables;
/// booleans are 0 and 1.
///
/// # Errors
/// The file cannot be written.
pub fn write(file: &Path, simulation: &Simulation) -> Result<()> {
    let rows = || Input::ROWS.iter().chain(Output::ROWS);
    let names = rows().flat_map(|row| (0..row.slots()).map(|element| row.variable_name(element)));
    let save = || -> csv::Result<()> {
        let mut table = csv::Writer::from_path(file)?;
        table.write_record(std::iter::once("time".to_owned()).chain(names))?;
        for ((time, input), output) in simulation.times().iter().zip(&simulation.inputs).zip(&simulation.outputs) {
            let values = std::iter::once(*time).chain(values(input)).chain(values(output));
            table.write_record(values.map(written))?;
        }
        Ok(table.flush()?)
    };
    save().with_context(|| format!("cannot write {}", file.display()))
}

/// The values of a group's variables in the order of its rows.
fn values<G: Group>(group: &G) -> Vec<f64> {
    let mut slots = vec![0.0; slot_count(G::ROWS)];
    group.write(&mut Writer::new(&mut slots));
    slots
}

fn written(value: f64) -> String {
    if value == value.trunc() { format!("{value:.0}") } else { format!("{value:.DECIMALS$}") }
}
