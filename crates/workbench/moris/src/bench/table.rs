//! The rows of the bench as CSV, and their means for the terminal.

use moris_simulation::measures::statistics::mean_of_any;
use std::path::Path;

use anyhow::{Context, Result};
use moris_analysis::bench::BENCH_VERSION;
use moris_analysis::bench::columns::BENCH_COLUMNS;
use moris_analysis::bench::run::{Row, Scale};

use crate::text_table::{TextTable, or_undefined};

/// Writes the rows. A value that is not defined is an empty field.
///
/// # Errors
/// The file cannot be written.
pub fn write(file: &Path, rows: &[Row]) -> Result<()> {
    // Names of the columns of `Row::best`.
    const BEST_COLUMNS: [&str; 3] = ["best x [m/s2]", "best y [m/s2]", "best z [m/s2]"];
    let save = || -> csv::Result<()> {
        let mut table = csv::Writer::from_path(file)?;
        let heads = ["bench", "drive", "rig", "washout", "scale", "factor", "fits"];
        table.write_record(
            heads.into_iter().chain(BENCH_COLUMNS.iter().map(|column| column.name)).chain(BEST_COLUMNS),
        )?;
        for row in rows {
            let (scale, factor, fits) = match row.scale {
                Scale::One => ("1", String::new(), String::new()),
                Scale::Fit { factor, fits } => ("fit", format!("{factor:.4}"), u8::from(fits).to_string()),
                Scale::Automatic { factor } => ("automatic", format!("{factor:.4}"), String::new()),
                Scale::Own => ("own", String::new(), String::new()),
            };
            let first = [BENCH_VERSION.to_string(), row.drive.to_owned(), row.rig.to_owned(), row.washout.clone()];
            let values =
                row.values.iter().zip(&BENCH_COLUMNS).map(|(value, column)| written_value(*value, column.decimals));
            let best = row.best.iter().map(|best| written_value(*best, 4));
            table.write_record(first.into_iter().chain([scale.to_owned(), factor, fits]).chain(values).chain(best))?;
        }
        Ok(table.flush()?)
    };
    save().with_context(|| format!("cannot write {}", file.display()))
}

fn written_value(value: Option<f64>, decimals: usize) -> String {
    // A value that rounds to -0 would be written as such.
    let rounded = |value: f64| {
        let text = format!("{value:.decimals$}");
        if text.trim_start_matches(['-', '0', '.']).is_empty() { text.trim_start_matches('-').to_owned() } else { text }
    };
    value.map_or_else(String::new, rounded)
}

/// Heads of the means.
pub const MEAN_HEADS: [&str; 10] =
    ["rows", "scale", "error/rest", "error/bound", "error/best", "shape", "size", "inverted", "jolt m/s²", "limited"];

/// Means over the drives and rigs as text: a line for each washout and scale, in the order of the
/// rows, below the bound and the best attained.
pub fn text(rows: &[Row], drives: usize, rigs: usize) -> String {
    let mut table = TextTable::new(std::iter::once("washout").chain(MEAN_HEADS).collect::<Vec<_>>());
    for (name, cells) in means(rows) {
        table.push(std::iter::once(name).chain(cells).collect());
    }
    format!("moris bench {BENCH_VERSION}: {drives} drives on {rigs} rigs\n\n{table}\n")
}

/// The means with their names.
pub fn means(rows: &[Row]) -> Vec<(String, Vec<String>)> {
    let at_rest: Vec<&Row> = rows.iter().filter(|row| row.washout == AT_REST).collect();
    let references =
        [("bound", mean_line(&at_rest, Figure::Bound)), ("best attained", mean_line(&at_rest, Figure::Best))];
    let references = references.into_iter().map(|(name, cells)| (name.to_owned(), cells));
    let washouts = groups(rows).into_iter().map(|(name, group)| (name, mean_line(&group, Figure::Own)));
    references.chain(washouts).collect()
}

/// The rows of each washout and scale, in the order of the rows.
pub fn groups(rows: &[Row]) -> Vec<(String, Vec<&Row>)> {
    let mut groups: Vec<(String, Vec<&Row>)> = Vec::new();
    for row in rows {
        let scale = match row.scale {
            Scale::One if row.washout == AT_REST => "",
            Scale::One => ", scale 1",
            Scale::Fit { .. } => ", fit",
            Scale::Automatic { .. } => ", automatic",
            Scale::Own => ", own scale",
        };
        let name = format!("{}{scale}", row.washout);
        match groups.iter_mut().find(|(other, _)| *other == name) {
            Some((_, group)) => group.push(row),
            None => groups.push((name, vec![row])),
        }
    }
    groups
}

/// Name of the first row of each drive.
const AT_REST: &str = "at rest";

/// An RMS error beside others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure {
    /// The error of the row.
    Own,
    /// The bound.
    Bound,
    /// The least of all rows.
    Best,
    /// The error of a platform at rest.
    Rest,
}

impl Figure {
    /// The RMS error of surge or sway \[m/s2\].
    pub fn of(self, row: &Row, axis: usize) -> Option<f64> {
        let name = |names: [&'static str; 2]| row.value(names[axis]);
        match self {
            Figure::Own => name(["RMS error x [m/s2]", "RMS error y [m/s2]"]),
            Figure::Bound => name(["bound x [m/s2]", "bound y [m/s2]"]),
            Figure::Best => row.best[axis],
            Figure::Rest => name(["desired x [m/s2]", "desired y [m/s2]"]),
        }
    }
}

/// The means of rows, whose error is this one. Only the rows' own has more than errors.
fn mean_line(group: &[&Row], error: Figure) -> Vec<String> {
    // Least desired force, or bound, with which a ratio means anything [m/s2].
    const MIN_DIVISOR: f64 = 0.03;
    let is_own = error == Figure::Own;
    let factors = group.iter().filter_map(|row| match row.scale {
        Scale::Fit { factor, .. } | Scale::Automatic { factor } => Some(factor),
        _ => None,
    });
    let number = |value: Option<f64>, decimals: usize| or_undefined(value.map(|value| format!("{value:.decimals$}")));
    let percent = |value: Option<f64>| or_undefined(value.map(|value| format!("{value:.1} %")));
    let ratio = |over: Figure| {
        let of = |row: &Row, axis: usize| {
            let [value, over] = [error.of(row, axis)?, over.of(row, axis)?];
            let is_meant = over >= MIN_DIVISOR && (error != Figure::Bound || value >= MIN_DIVISOR);
            is_meant.then(|| value / over)
        };
        let ratios = group.iter().flat_map(|row| (0..2).filter_map(move |axis| of(row, axis)));
        number(geometric_mean(ratios), 2)
    };
    let both = |names: [&'static str; 2]| {
        group.iter().flat_map(move |row| names.into_iter().filter_map(move |name| row.value(name)))
    };
    let one = |name: &'static str| group.iter().filter_map(move |row| row.value(name));
    let own = |text: String| if is_own { text } else { or_undefined(None) };
    vec![
        group.len().to_string(),
        number(geometric_mean(factors), 2),
        ratio(Figure::Rest),
        ratio(Figure::Bound),
        ratio(Figure::Best),
        own(number(mean_of_any(both(["shape x", "shape y"])), 2)),
        own(number(geometric_mean(both(["size x", "size y"]).filter(|size| *size > 0.0)), 2)),
        own(percent(mean_of_any(both(["inverted x [%]", "inverted y [%]"])))),
        own(number(mean_of_any(one("jolt [m/s2]")), 2)),
        own(percent(mean_of_any(one("limited [%]")))),
    ]
}

fn geometric_mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    mean_of_any(values.map(|value| value.max(1e-9).ln())).map(f64::exp)
}
