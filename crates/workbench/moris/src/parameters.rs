//! `moris parameters`: the parameters as a file to start from.

use std::io::Write;
use std::process::ExitCode;

use anyhow::Result;
use moris_interface::{Group, Row, slots_of};
use moris_setup::{all, changed, parameter_file};
use moris_washout::{Input, Output, Parameters, Preview};

use crate::setup_options::SetupOptions;

/// Print parameters as a parameter file, each with unit and description
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    setup: SetupOptions,

    /// Only those that are not the default's
    #[arg(long)]
    changed: bool,

    /// Print a C header instead, for the washout on a microcontroller
    #[arg(long, conflicts_with = "changed")]
    c_header: bool,
}

/// Prints the file.
///
/// # Errors
/// The rig or the parameters cannot be used.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    let setup = options.setup.load_with_notes()?;
    let values = if options.changed { changed(&setup.parameters) } else { all(&setup.parameters) };
    let heading = format!("Parameters: {}\nRig: {}", setup.parameters_name, setup.rig_name);
    if options.c_header {
        write!(out, "{}", c_header(&heading, &setup.parameters))?;
    } else {
        write!(out, "{}", parameter_file::write(&heading, &values, Parameters::ROWS))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// A header in C for `crates/board`: the place of each variable by its name, the parameters, and
/// an input at rest.
fn c_header(heading: &str, parameters: &Parameters) -> String {
    let heading = heading.replace('\n', "\n * ").replace("*/", "* /");
    let (places, values) = (
        [
            c_places("PARAMETER", Parameters::ROWS),
            c_places("INPUT", Input::ROWS),
            c_places("PREVIEW", Preview::ROWS),
            c_places("OUTPUT", Output::ROWS),
        ],
        [
            c_values("parameters", "PARAMETER", Parameters::ROWS, &slots_of(parameters)),
            c_values("input_at_rest", "INPUT", Input::ROWS, &slots_of(&Input::default())),
        ],
    );
    format!(
        "/* Variables of the washout for moris_board.h.\n * {heading} */\n#ifndef MORIS_PARAMETERS_H\n\
         #define MORIS_PARAMETERS_H\n\n{}{}#endif\n",
        places.concat(),
        values.concat()
    )
}

/// A name in C for each slot of these rows.
fn c_names(rows: &[Row]) -> impl Iterator<Item = String> {
    let names = rows.iter().flat_map(|row| (0..row.slots()).map(|element| row.variable_name(element)));
    names.map(|name| format!("MORIS_{}", name.replace("].", "_").replace(['.', '[', ']'], "_")))
}

fn c_places(group: &str, rows: &[Row]) -> String {
    let names: String = c_names(rows).map(|name| format!("    {name},\n")).collect();
    format!("enum {{\n{names}    MORIS_{group}_COUNT\n}};\n\n")
}

fn c_values(array: &str, group: &str, rows: &[Row], values: &[f64]) -> String {
    let lines: String =
        values.iter().zip(c_names(rows)).map(|(value, name)| format!("    {value:?}, /* {name} */\n")).collect();
    format!("static const double moris_{array}[MORIS_{group}_COUNT] = {{\n{lines}}};\n\n")
}
