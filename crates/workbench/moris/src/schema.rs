//! `moris schema`: JSON schemas of the workbench's files, with which editors check and complete
//! them, and of its JSON.

use std::io::Write;
use std::process::ExitCode;

use anyhow::Result;
use moris_interface::{Causality, Group, Kind, Row};
use moris_setup::rig_file::RigFile;
use moris_washout::Parameters;
use schemars::generate::SchemaSettings;
use schemars::schema_for;
use serde_json::{Map, Value, json};

use crate::recording::ConventionOptions;
use crate::simulate::json::SimulatedRecording;

/// Print the JSON schema of a kind of file
///
/// Editors with a TOML language server check and complete files with it. In the first line of the
/// file: #:schema ./rig.schema.json
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    /// Kind of file
    #[arg(value_enum)]
    kind: FileKind,
}

/// The workbench's files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum FileKind {
    /// Rig files
    Rig,
    /// Parameter files
    Parameters,
    /// Conventions of recordings
    Conventions,
    /// The JSON of `simulate --json`
    Simulation,
}

/// Prints the schema.
///
/// # Errors
/// The schema cannot be written.
pub fn main(options: &Options, out: &mut dyn Write) -> Result<ExitCode> {
    writeln!(out, "{:#}", schema(options.kind)?)?;
    Ok(ExitCode::SUCCESS)
}

/// The schema of a kind of file.
///
/// # Errors
/// There are none: the schemas are plain data.
pub fn schema(kind: FileKind) -> Result<Value> {
    Ok(match kind {
        FileKind::Rig => serde_json::to_value(schema_for!(RigFile))?,
        FileKind::Conventions => serde_json::to_value(schema_for!(ConventionOptions))?,
        FileKind::Parameters => parameter_schema(),
        FileKind::Simulation => {
            let settings = SchemaSettings::draft2020_12().for_serialize();
            serde_json::to_value(settings.into_generator().into_root_schema_for::<Vec<SimulatedRecording>>())?
        }
    })
}

/// The schema of parameter files: every parameter with its unit, range and description.
fn parameter_schema() -> Value {
    let rows = Parameters::ROWS.iter().filter(|row| row.causality == Causality::Parameter);
    let named =
        rows.flat_map(|row| (0..row.slots()).map(move |element| (row.variable_name(element), parameter_property(row))));
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Parameters",
        "type": "object",
        "properties": named.collect::<Map<String, Value>>(),
        // Names may be written as tables in tables.
        "additionalProperties": { "type": "object" },
    })
}

fn parameter_property(row: &Row) -> Value {
    let mut property = match row.kind {
        Kind::Real(_) => json!({ "type": "number" }),
        Kind::Integer => json!({ "type": "integer" }),
        Kind::Boolean => json!({ "type": "boolean" }),
        Kind::Enumeration(enumeration) => {
            let names = enumeration.items.iter().map(|item| json!(item.name));
            json!({ "enum": names.chain((1..=enumeration.items.len()).map(|number| json!(number))).collect::<Vec<_>>() })
        }
    };
    if let (Some((least, greatest)), Kind::Real(_) | Kind::Integer) = (row.range, row.kind) {
        for (key, bound) in [("minimum", least), ("maximum", greatest)] {
            if bound.is_finite() {
                property[key] = json!(bound);
            }
        }
    }
    property["description"] = match row.kind {
        Kind::Real(unit) if !unit.name.is_empty() => json!(format!("{} [{}]", row.text(), unit.name)),
        _ => json!(row.text()),
    };
    property
}
