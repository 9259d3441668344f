//! Parameter files: values by the names of a model's variables.
//!
//! ```toml
//! "splitter.x.omega1" = 2.0      # quoted or not: splitter.x.omega1 is the same
//! gravityRemoval = "full"        # an enumeration's item by its name
//! [tilt]                         # and a table is the beginning of its names
//! rateLimit = 0.05
//! ```
//!
//! All values are in the units of the FMU's variables, which are SI. Every parameter of the model
//! may be given, including the rig's. Other parameters keep their values.

use moris_interface::{Causality, Kind, Row};
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
    let table: Table = text.parse().map_err(|error: toml::de::Error| Error::Toml {
        source_name: source_name.to_owned(),
        text: error.to_string(),
        remedy: "a parameter file is TOML; moris parameters prints one",
    })?;
    let mut values = NamedValues::new();
    let reader = Reader { source_name, rows };
    reader.read_table("", &table, &mut values)?;
    Ok(values)
}

/// Reads tables within tables, whose keys are parts of names.
struct Reader<'a> {
    source_name: &'a str,
    rows: &'a [Row],
}

impl Reader<'_> {
    fn read_table(&self, prefix: &str, table: &Table, values: &mut NamedValues) -> Result<(), Error> {
        for (key, value) in table {
            let name = format!("{prefix}{key}");
            match value {
                Value::Table(inner) => self.read_table(&format!("{name}."), inner, values)?,
                _ => {
                    let value = self.value(&name, value)?;
                    values.push((name, value));
                }
            }
        }
        Ok(())
    }

    fn value(&self, name: &str, value: &Value) -> Result<f64, Error> {
        let row = self.row(name)?;
        slot_value(row, value).map_err(|reason| Error::WrongValue {
            source_name: self.source_name.to_owned(),
            name: name.to_owned(),
            reason,
        })
    }

    /// The row of the parameter of this name.
    fn row(&self, name: &str) -> Result<&Row, Error> {
        let parameters = || self.rows.iter().filter(|row| row.causality == Causality::Parameter);
        let has_name = |row: &&Row| (0..row.slots()).any(|element| row.variable_name(element) == name);
        parameters().find(has_name).ok_or_else(|| {
            let names: Vec<String> = parameters().flat_map(|row| variable_names(std::slice::from_ref(row))).collect();
            Error::UnknownName {
                source_name: self.source_name.to_owned(),
                what: "parameter",
                name: name.to_owned(),
                nearest: nearest(name, names.iter().map(String::as_str)).into_iter().map(str::to_owned).collect(),
                otherwise: "`cargo moris parameters` lists the washout's, an FMU's modelDescription.xml any model's",
            }
        })
    }
}

/// A file's value in the encoding of the row's slot, or the reason why it cannot be used.
fn slot_value(row: &Row, value: &Value) -> Result<f64, String> {
    match (row.kind, value) {
        (Kind::Real(_), Value::Float(number)) => in_range(row, *number),
        (Kind::Real(_) | Kind::Integer, Value::Integer(number)) => in_range(row, *number as f64),
        (Kind::Boolean, Value::Boolean(value)) => Ok(f64::from(*value)),
        (Kind::Enumeration(enumeration), Value::String(item)) => {
            let place = enumeration.items.iter().position(|known| known.name == item);
            let items = || enumeration.items.iter().map(|item| item.name).collect::<Vec<_>>().join(", ");
            place
                .map(|place| place as f64 + 1.0)
                .ok_or_else(|| format!("is \"{item}\", but must be one of {}", items()))
        }
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
        Kind::Enumeration(enumeration) => {
            let items: Vec<&str> = enumeration.items.iter().map(|item| item.name).collect();
            format!("one of {}, in quotes", items.join(", "))
        }
    }
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
                text += &format!("\n# {}\n", description(row));
                described = true;
            }
            text += &format!("\"{name}\" = {}\n", written(row, *value));
        }
    }
    text
}

/// The row's sentence with its unit, or its items.
fn description(row: &Row) -> String {
    match row.kind {
        Kind::Real(unit) if !unit.name.is_empty() => format!("{} [{}]", row.text(), unit.name),
        Kind::Enumeration(enumeration) => {
            let items: Vec<&str> = enumeration.items.iter().map(|item| item.name).collect();
            format!("{} One of {}.", row.text(), items.join(", "))
        }
        _ => row.text().to_owned(),
    }
}

/// A slot's value in the notation of a file.
fn written(row: &Row, value: f64) -> String {
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
