//! Parameter files: values by the names of a model's variables.
//!
//! ```toml
//! "scale.specificForce.x" = 0.5  # quoted or not: scale.specificForce.x is the same
//! gravityRemoval = "full"        # an enumeration's item by its name, or by its number in the FMU
//! [tilt]                         # and a table is the beginning of its names
//! rateLimit = 0.05
//! ```
//!
//! All values are in the units of the FMU's variables, which are SI. Every parameter of the model
//! may be given, including the rig's. Other parameters keep their values.

use moris_interface::{Causality, Enumeration, Kind, Row};
use toml::{Table, Value};

use crate::named_values::variable_names;
use crate::names::nearest;
use crate::{Error, NamedValues};

/// The values in the text of a parameter file for a model with these rows. `source_name` is the
/// file's name in errors.
///
/// # Errors
/// The text is not TOML, a name is not that of a parameter of the model, or a
/// value is out of range.
pub fn read(text: &str, source_name: &str, rows: &[Row]) -> Result<NamedValues, Error> {
    let remedy = "a parameter file is TOML; moris parameters prints one";
    let table: Table = text.parse().map_err(|error| Error::toml(source_name, &error, remedy))?;
    let read = |(name, value): (String, &Value)| {
        let row = parameter_row(&name, source_name, rows)?;
        let value = slot_value(row, value).map_err(|reason| Error::wrong_value(source_name, &name, reason))?;
        Ok((name, value))
    };
    flattened_table("", &table).into_iter().map(read).collect()
}

/// The values of tables within tables, whose keys are parts of names.
fn flattened_table<'a>(prefix: &str, table: &'a Table) -> Vec<(String, &'a Value)> {
    let of_key = |(key, value): (&String, &'a Value)| match value {
        Value::Table(inner) => flattened_table(&format!("{prefix}{key}."), inner),
        value => vec![(format!("{prefix}{key}"), value)],
    };
    table.iter().flat_map(of_key).collect()
}

/// The row of the parameter of this name.
fn parameter_row<'a>(name: &str, source_name: &str, rows: &'a [Row]) -> Result<&'a Row, Error> {
    let parameters = || rows.iter().filter(|row| row.causality == Causality::Parameter);
    let has_name = |row: &&Row| (0..row.slots()).any(|element| row.variable_name(element) == name);
    parameters().find(has_name).ok_or_else(|| {
        let names: Vec<String> = parameters().flat_map(|row| variable_names(std::slice::from_ref(row))).collect();
        Error::UnknownName {
            source_name: source_name.to_owned(),
            what: "parameter",
            name: name.to_owned(),
            nearest: nearest(name, names.iter().map(String::as_str)),
            otherwise: "`cargo moris parameters` lists the washout's, an FMU's modelDescription.xml any model's",
        }
    })
}

/// A file's value in the encoding of the row's slot, or the reason why it cannot be used.
fn slot_value(row: &Row, value: &Value) -> Result<f64, String> {
    match (row.kind, value) {
        (Kind::Real(_), Value::Float(number)) => in_range(row, *number),
        (Kind::Real(_) | Kind::Integer, Value::Integer(number)) => in_range(row, *number as f64),
        (Kind::Boolean, Value::Boolean(value)) => Ok(f64::from(*value)),
        (Kind::Enumeration(enumeration), Value::String(item)) => {
            let place = enumeration.items.iter().position(|known| known.name == item);
            place
                .map(|place| place as f64 + 1.0)
                .ok_or_else(|| format!("is \"{item}\", but must be one of {}", item_list(enumeration)))
        }
        (Kind::Enumeration(_), Value::Integer(number)) => in_range(row, *number as f64),
        (kind, value) => Err(format!("is {value}, but must be {}", what_it_takes(kind))),
    }
}

fn in_range(row: &Row, number: f64) -> Result<f64, String> {
    if row.accepts(number) { Ok(number) } else { Err(row.reason(number)) }
}

fn what_it_takes(kind: Kind) -> String {
    match kind {
        Kind::Real(unit) if unit.name.is_empty() => "a number".to_owned(),
        Kind::Real(unit) => format!("a number, in {}", unit.name),
        Kind::Integer => "a whole number".to_owned(),
        Kind::Boolean => "true or false".to_owned(),
        Kind::Enumeration(enumeration) => format!("one of {}, in quotes, or its number", item_list(enumeration)),
    }
}

fn item_list(enumeration: &Enumeration) -> String {
    enumeration.items.iter().map(|item| item.name).collect::<Vec<_>>().join(", ")
}

/// The text of a parameter file with these values, each with its unit and description in a comment.
///
/// `heading` is written above, as a comment of one or more lines. Names that no row has are
/// omitted.
pub fn write(heading: &str, values: &[(String, f64)], rows: &[Row]) -> String {
    let mut text = String::new();
    for line in heading.lines() {
        text += &format!("{}\n", format!("# {line}").trim_end());
    }
    for row in rows {
        let mut described = false;
        for element in 0..row.slots() {
            let name = row.variable_name(element);
            let Some((_, value)) = values.iter().rev().find(|(other, _)| *other == name) else { continue };
            if !described {
                text += &format!("\n# {}\n", row_description(row));
                described = true;
            }
            text += &format!("\"{name}\" = {}\n", written_value(row, *value));
        }
    }
    text
}

/// The row's sentence with its unit, or its items.
fn row_description(row: &Row) -> String {
    match row.kind {
        Kind::Real(unit) if !unit.name.is_empty() => format!("{} [{}]", row.text(), unit.name),
        Kind::Enumeration(enumeration) => format!("{} One of {}.", row.text(), item_list(enumeration)),
        _ => row.text().to_owned(),
    }
}

/// A slot's value in the notation of a file.
fn written_value(row: &Row, value: f64) -> String {
    match row.kind {
        Kind::Real(_) => Value::Float(value).to_string(),
        Kind::Integer => Value::Integer(value as i64).to_string(),
        Kind::Boolean => Value::Boolean(value != 0.0).to_string(),
        Kind::Enumeration(enumeration) => {
            let item = (value as usize).saturating_sub(1).min(enumeration.items.len() - 1);
            Value::String(enumeration.items[item].name.to_owned()).to_string()
        }
    }
}
