//! The rows of the bench as a page.

use moris_simulation::measures::statistics::mean_of_any;
use std::path::Path;

use anyhow::{Context, Result};
use moris_analysis::bench::BENCH_VERSION;
use moris_analysis::bench::columns::BENCH_COLUMNS;
use moris_analysis::bench::run::Row;
use moris_pages::report::{PageTable, tables_html};

use super::table::{Figure, MEAN_HEADS, groups, means};
use crate::text;
use crate::text_table::or_undefined;

/// Writes the page: means over all, then the errors by drive and by rig, with the bound and the
/// best attained above them.
///
/// # Errors
/// The file cannot be written.
pub fn write(file: &Path, rows: &[Row]) -> Result<()> {
    std::fs::write(file, page_html(rows)).with_context(|| format!("cannot write {}", file.display()))
}

fn page_html(rows: &[Row]) -> String {
    let [drives, rigs] = [distinct_names(rows, |row| row.drive), distinct_names(rows, |row| row.rig)];
    let all = PageTable {
        title: "Means over drives and rigs".to_owned(),
        text: text!["bench-means"].to_string(),
        heads: MEAN_HEADS.map(str::to_owned).to_vec(),
        rows: means(rows),
        compared: None,
    };
    let by_drive = errors_by("Errors by drive", "the rigs", rows, &drives, |row| row.drive);
    let by_rig = errors_by("Errors by rig", "the drives", rows, &rigs, |row| row.rig);
    let (drives, rigs, version) = (drives.len(), rigs.len(), u64::from(BENCH_VERSION));
    let subtitle = text!["bench-subtitle", drives, rigs, version, measures = BENCH_COLUMNS.len()].to_string();
    tables_html("Bench of washouts", &subtitle, &[all, by_drive, by_rig])
}

/// Errors of surge and sway together, with a column for each of `names`.
fn errors_by(title: &str, over: &str, rows: &[Row], names: &[&str], name: impl Fn(&Row) -> &str) -> PageTable {
    let line = |group: &[&Row], figure: Figure| -> Vec<String> {
        let of = |one: &&str| {
            let errors = group.iter().filter(|row| name(row) == *one).filter_map(|row| horizontal_error(row, figure));
            or_undefined(mean_of_any(errors).map(|error| format!("{error:.2}")))
        };
        names.iter().map(of).collect()
    };
    let groups = groups(rows);
    let first: &[&Row] = groups.first().map_or(&[], |(_, group)| group);
    let references = [("bound", Figure::Bound), ("best attained", Figure::Best)];
    let references = references.map(|(name, figure)| (name.to_owned(), line(first, figure)));
    let compared = Some(references.len());
    let washouts = groups.iter().map(|(name, group)| (name.clone(), line(group, Figure::Own)));
    PageTable {
        title: title.to_owned(),
        text: text!["bench-errors", over].to_string(),
        heads: names.iter().map(|name| (*name).to_owned()).collect(),
        rows: references.into_iter().chain(washouts).collect(),
        compared,
    }
}

/// The root of the sum of squares of surge and sway.
fn horizontal_error(row: &Row, figure: Figure) -> Option<f64> {
    let [x, y] = [0, 1].map(|axis| figure.of(row, axis));
    (x.is_some() || y.is_some()).then(|| x.unwrap_or(0.0).hypot(y.unwrap_or(0.0)))
}

/// Names in the order of the rows, each once.
fn distinct_names<'a>(rows: &'a [Row], name: impl Fn(&'a Row) -> &'static str) -> Vec<&'static str> {
    let mut names = Vec::new();
    for row in rows {
        if !names.contains(&name(row)) {
            names.push(name(row));
        }
    }
    names
}
