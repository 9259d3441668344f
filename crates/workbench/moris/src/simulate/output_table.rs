//! The table of a simulation's inputs and outputs.

use std::path::Path;

use anyhow::{Context, Result};
use moris_interface::{Group, slots_of};
use moris_washout::{Input, Output};

use super::Simulation;

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
        for ((time, input), output) in simulation.times().iter().zip(simulation.inputs.iter()).zip(&simulation.outputs)
        {
            let values = std::iter::once(*time).chain(slots_of(input)).chain(slots_of(output));
            table.write_record(values.map(written_number))?;
        }
        Ok(table.flush()?)
    };
    save().with_context(|| format!("cannot write {}", file.display()))
}

fn written_number(value: f64) -> String {
    // Digits after the point: micrometres, and no more than a sensor has.
    const OUTPUT_DECIMALS: usize = 6;
    if value == value.trunc() { format!("{value:.0}") } else { format!("{value:.OUTPUT_DECIMALS$}") }
}
