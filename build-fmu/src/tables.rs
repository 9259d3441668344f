//! Tables of the pages in `docs/` that follow from the models: variables, items of
//! enumerations, and parameter sets.
//!
//! A table stands between the lines `<!-- table: NAME -->` and `<!-- end of table -->`.

use moris_interface::{Causality, Kind, Row, shown};
use moris_setup::PARAMETER_SETS;
use moris_washout::interface::TuningGroup;
use moris_washout::presets;

use crate::model::{FMU_MODELS, MOTORCYCLE, WASHOUT};
use crate::{FmuModel, Start};

/// A table and its page.
pub struct Table {
    pub page: &'static str,
    pub name: &'static str,
    /// The table's lines, given its name.
    text: fn(&str) -> String,
}

/// Every table.
pub const GENERATED_TABLES: &[Table] = &[
    Table { page: "docs/parameter-sets.md", name: "parameter sets", text: |_| parameter_sets() },
    Table { page: "docs/fmu.md", name: "enumerations", text: |_| enumeration_table() },
    Table { page: "docs/motorcycle.md", name: "path.course", text: enumeration_items },
    Table { page: "docs/tuning-by-search.md", name: "tuned parameters", text: |_| tuned_table() },
    Table { page: "docs/strategies/adaptive.md", name: "adaptive", text: parameter_table },
    Table { page: "docs/strategies/optimal.md", name: "optimal", text: parameter_table },
    Table { page: "docs/strategies/robust.md", name: "robust", text: parameter_table },
    Table { page: "docs/strategies/predictive.md", name: "predictive", text: parameter_table },
];

impl Table {
    /// The page's text with this table in its place. None if the page has no place for it.
    pub fn within(&self, page: &str) -> Option<String> {
        const END_OF_TABLE: &str = "<!-- end of table -->\n";
        let (before, rest) = page.split_once(&self.begin())?;
        let (_, after) = rest.split_once(END_OF_TABLE)?;
        Some(format!("{before}{}{}{END_OF_TABLE}{after}", self.begin(), (self.text)(self.name)))
    }

    fn begin(&self) -> String {
        format!("<!-- table: {} -->\n", self.name)
    }
}

/// The variables in which a set differs from the start values, and their value in each set.
fn parameter_sets() -> String {
    let start = Start::own(&WASHOUT);
    let identity = &WASHOUT.functions.identity;
    let sets: Vec<_> = PARAMETER_SETS[1..].iter().map(|(name, set)| (name, presets::values(set))).collect();
    let names: Vec<String> = sets.iter().map(|(name, _)| format!("`{name}`")).collect();
    let mut text = table_line(
        &[&["variable", "unit", "start"][..], &names.iter().map(String::as_str).collect::<Vec<_>>()].concat(),
    );
    text += &table_line(&vec!["---"; 3 + sets.len()]);
    for slot in identity.listed_slots() {
        let (name, own) = (identity.variable_name(slot), start.slots()[slot]);
        let values: Vec<String> = sets
            .iter()
            .map(|(_, set)| set.iter().rev().find(|(variable, _)| *variable == name))
            .map(|found| {
                found.filter(|(_, value)| *value != own).map_or_else(String::new, |(_, value)| value.to_string())
            })
            .collect();
        if values.iter().any(|value| !value.is_empty()) {
            let cells = [format!("`{name}`"), unit_cell(identity.row(slot)).to_owned(), own.to_string()];
            text += &table_line(&cells.iter().chain(&values).map(String::as_str).collect::<Vec<_>>());
        }
    }
    text
}

/// The items of every enumeration with their numbers.
fn enumeration_table() -> String {
    let mut text = table_line(&["model", "variable", "items"]) + &table_line(&["---"; 3]);
    for model in FMU_MODELS {
        for (row, start) in parameter_rows(model) {
            let Kind::Enumeration(enumeration) = row.kind else { continue };
            let items: Vec<String> = enumeration
                .items
                .iter()
                .zip(1..)
                .map(|(item, number)| {
                    let note = if start == f64::from(number) { " (start)" } else { "" };
                    format!("{number} `{}`{note}", item.name)
                })
                .collect();
            text += &table_line(&[&format!("`{}`", model.name), &format!("`{}`", row.name), &items.join(", ")]);
        }
    }
    text
}

/// The items of the motorcycle's enumeration of this name, with their numbers.
fn enumeration_items(name: &str) -> String {
    let mut text = table_line(&["number", "item", "meaning"]) + &table_line(&["---"; 3]);
    for (row, _) in parameter_rows(&MOTORCYCLE).filter(|(row, _)| row.name == name) {
        if let Kind::Enumeration(enumeration) = row.kind {
            for (item, number) in enumeration.items.iter().zip(1..) {
                text += &table_line(&[
                    &number.to_string(),
                    &format!("`{}`", item.name),
                    item.text.trim().trim_end_matches('.'),
                ]);
            }
        }
    }
    text
}

/// The washout's parameters of this group, with start values.
fn parameter_table(group: &str) -> String {
    let mut text = table_line(&["parameter", "start", "meaning"]) + &table_line(&["---"; 3]);
    let group = format!("{group}.");
    for (row, start) in parameter_rows(&WASHOUT).filter(|(row, _)| row.name.starts_with(&group)) {
        let value = match row.kind {
            Kind::Enumeration(enumeration) => format!("`{}`", enumeration.items[start as usize - 1].name),
            _ => format!("{start} {}", unit_cell(row)),
        };
        text += &table_line(&[&format!("`{}`", row.name), value.trim(), row.text().trim_end_matches('.')]);
    }
    text
}

/// The washout's parameters that may be tuned, by group and usual range.
fn tuned_table() -> String {
    let mut text = table_line(&["`--tune`", "parameters", "range"]) + &table_line(&["---"; 3]);
    for group in TuningGroup::ALL {
        let mut ranges: Vec<(String, Vec<String>)> = Vec::new();
        for (row, _) in parameter_rows(&WASHOUT).filter(|(row, _)| row.tuning_group == Some(group.name())) {
            let Some((least, greatest)) = row.usual.or(row.range.filter(|_| row.kind == Kind::Integer)) else {
                continue;
            };
            let range = format!("{} to {} {}", shown(least), shown(greatest), unit_cell(row));
            let name = format!("`{}`", row.name);
            match ranges.iter_mut().find(|(known, _)| *known == range) {
                Some((_, names)) => names.push(name),
                None => ranges.push((range, vec![name])),
            }
        }
        for (range, names) in ranges {
            text += &table_line(&[&format!("`{}`", group.name()), &names.join(", "), range.trim()]);
        }
    }
    text
}

/// A model's rows of parameters, and the start value of the first variable of each.
fn parameter_rows(model: &FmuModel) -> impl Iterator<Item = (&'static Row, f64)> {
    let start = Start::own(model);
    let mut slot = 0;
    model.functions.identity.rows.iter().filter_map(move |row| {
        let first = slot;
        slot += row.slots();
        (row.causality == Causality::Parameter).then(|| (row, start.slots()[first]))
    })
}

fn unit_cell(row: &Row) -> &'static str {
    match row.kind {
        Kind::Real(unit) => unit.name,
        _ => "",
    }
}

fn table_line(cells: &[&str]) -> String {
    format!("| {} |\n", cells.join(" | "))
}
