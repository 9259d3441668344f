//! The rows of the bench as CSV, and their means for the terminal.

use std::path::Path;

use anyhow::{Context, Result};

use super::VERSION;
use super::columns::COLUMNS;
use super::run::{Row, Scale};
use crate::text_table::{TextTable, or_undefined};

/// Writes the rows. A value that is not defined is an empty field.
///
/// # Errors
/// The file cannot be written.
pub fn write(file: &Path, rows: &[Row]) -> Result<()> {
    let save = || -> csv::Result<()> {
        let mut table = csv::Writer::from_path(file)?;
        let heads = ["bench", "drive", "rig", "washout", "scale", "factor", "fits"];
        table.write_record(heads.into_iter().chain(COLUMNS.iter().map(|column| column.name)))?;
        for row in rows {
            let (scale, factor, fits) = match row.scale {
                Scale::One => ("1", String::new(), String::new()),
                Scale::Fit { factor, fits } => ("fit", format!("{factor:.4}"), u8::from(fits).to_string()),
                Scale::Own => ("own", String::new(), String::new()),
            };
            let first = [VERSION.to_string(), row.drive.to_owned(), row.rig.to_owned(), row.washout.clone()];
            let values = row.values.iter().zip(&COLUMNS).map(|(value, column)| written(*value, column.decimals));
            table.write_record(first.into_iter().chain([scale.to_owned(), factor, fits]).chain(values))?;
        }
        Ok(table.flush()?)
    };
    save().with_context(|| format!("cannot write {}", file.display()))
}

fn written(value: Option<f64>, decimals: usize) -> String {
    // A value that rounds to -0 would be written as such.
    let rounded = |value: f64| {
        let text = format!("{value:.decimals$}");
        if text.trim_start_matches(['-', '0', '.']).is_empty() { text.trim_start_matches('-').to_owned() } else { text }
    };
    value.map_or_else(String::new, rounded)
}

/// Means over the drives and rigs: a line for each washout and scale, in the order of the rows.
pub fn text(rows: &[Row], drives: usize, rigs: usize) -> String {
    let mut groups: Vec<(String, Vec<&Row>)> = Vec::new();
    for row in rows {
        let scale = match row.scale {
            Scale::One if row.washout == "at rest" => "",
            Scale::One => ", scale 1",
            Scale::Fit { .. } => ", fit",
            Scale::Own => ", own scale",
        };
        let name = format!("{}{scale}", row.washout);
        match groups.iter_mut().find(|(other, _)| *other == name) {
            Some((_, group)) => group.push(row),
            None => groups.push((name, vec![row])),
        }
    }
    let heads =
        ["washout", "rows", "scale", "error/rest", "error/bound", "shape", "size", "inverted", "jolt m/s²", "limited"];
    let mut table = TextTable::new(heads);
    for (name, group) in &groups {
        table.push(line(name, group));
    }
    format!("moris bench {VERSION}: {drives} drives on {rigs} rigs\n\n{table}\n")
}

fn line(name: &str, group: &[&Row]) -> Vec<String> {
    let factors = group.iter().filter_map(|row| match row.scale {
        Scale::Fit { factor, .. } => Some(factor),
        _ => None,
    });
    let number = |value: Option<f64>, decimals: usize| or_undefined(value.map(|value| format!("{value:.decimals$}")));
    let percent = |value: Option<f64>| or_undefined(value.map(|value| format!("{value:.1} %")));
    let ratio = |over: [&str; 2]| {
        let pairs = ["RMS error x [m/s2]", "RMS error y [m/s2]"].into_iter().zip(over);
        let of = |row: &&Row, (error, over): (&str, &str)| {
            let [error, over] = [value(row, error)?, value(row, over)?];
            (over >= LEAST).then(|| error / over)
        };
        let ratios = group.iter().flat_map(|row| pairs.clone().filter_map(move |pair| of(row, pair)));
        geometric_mean(ratios)
    };
    let both = |names: [&'static str; 2]| {
        group.iter().flat_map(move |row| names.into_iter().filter_map(move |name| value(row, name)))
    };
    let one = |name: &'static str| group.iter().filter_map(move |row| value(row, name));
    vec![
        name.to_owned(),
        group.len().to_string(),
        number(geometric_mean(factors), 2),
        number(ratio(["desired x [m/s2]", "desired y [m/s2]"]), 2),
        number(ratio(["bound x [m/s2]", "bound y [m/s2]"]), 2),
        number(mean(both(["shape x", "shape y"])), 2),
        number(geometric_mean(both(["size x", "size y"]).filter(|size| *size > 0.0)), 2),
        percent(mean(both(["inverted x [%]", "inverted y [%]"]))),
        number(mean(one("jolt [m/s2]")), 2),
        percent(mean(one("limited [%]"))),
    ]
}

/// Least desired force, or bound, with which a ratio means anything \[m/s2\].
const LEAST: f64 = 0.03;

fn value(row: &Row, name: &str) -> Option<f64> {
    let place = COLUMNS.iter().position(|column| column.name == name)?;
    row.values[place]
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    (count > 0.0).then(|| sum / count)
}

fn geometric_mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    mean(values.map(|value| value.max(1e-9).ln())).map(f64::exp)
}
