//! The documentation's tables of variables, in the notation of a version of FMI.

use moris_interface::{Causality, Identity, Kind, Row, Variability};

/// Presentation of a row of the interface in a version of FMI.
pub(crate) struct Notation {
    /// The names of its variables.
    pub name: fn(&Row) -> String,
    /// Name of a variable's type.
    pub type_name: fn(&Row) -> String,
}

/// The tables of a model's variables as HTML, with a row for each row of the interface.
///
/// There is one table each for inputs, outputs, parameters that can be changed while the simulation
/// runs, and parameters that cannot. `start` has the start value of each slot.
pub(crate) fn html(identity: &Identity, start: &[f64], notation: &Notation) -> String {
    let mut html = String::new();
    for section in TABLE_SECTIONS {
        html.push_str(&section_html(identity, start, section, notation));
    }
    html
}

/// A table: its anchor, its heading and a predicate for its rows.
struct Section {
    anchor: &'static str,
    heading: &'static str,
    holds: fn(&Row) -> bool,
}

const TABLE_SECTIONS: &[Section] = &[
    Section { anchor: "inputs", heading: "Inputs", holds: |row| row.causality == Causality::Input },
    Section { anchor: "outputs", heading: "Outputs", holds: |row| row.causality == Causality::Output },
    Section {
        anchor: "tunable-parameters",
        heading: "Parameters that may change between steps",
        holds: |row| row.causality == Causality::Parameter && row.variability == Variability::Tunable,
    },
    Section {
        anchor: "fixed-parameters",
        heading: "Parameters that are fixed once initialised",
        holds: |row| row.causality == Causality::Parameter && row.variability == Variability::Fixed,
    },
];

fn section_html(identity: &Identity, start: &[f64], section: &Section, notation: &Notation) -> String {
    let mut rows = String::new();
    for first in identity.listed_slots().into_iter().filter(|&slot| identity.slots[slot].element == 0) {
        let row = identity.row(first);
        if (section.holds)(row) {
            rows.push_str(&row_html(row, &start[first..first + row.slots()], notation));
        }
    }
    if rows.is_empty() {
        return String::new();
    }
    let Section { anchor, heading, .. } = section;
    format!(
        "<h3 id=\"{anchor}\">{heading}</h3>\n<table class=\"variables\">\n<thead><tr><th>Name</th><th>Type</th>\
         <th>Unit</th><th>Start</th><th>Range</th><th>Meaning</th></tr></thead>\n<tbody>\n{rows}</tbody>\n</table>\n"
    )
}

fn row_html(row: &Row, start: &[f64], notation: &Notation) -> String {
    // An output's start value is calculated: the description has none.
    let start = if row.causality == Causality::Output { String::new() } else { start_html(row, start) };
    format!(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{start}</td><td>{}</td><td>{}</td></tr>\n",
        (notation.name)(row),
        (notation.type_name)(row),
        unit_html(row.kind),
        range_html(row),
        meaning_html(row),
    )
}

/// The row's name with its index and components filled in: `rig.base[1…6].{x, y, z}`.
pub(crate) fn name_html(row: &Row) -> String {
    let components = format!("<i>{{{}}}</i>", row.components.join(",\u{a0}"));
    let index = format!("<i>1…{}</i>", row.count);
    let name = breakable(row.name).replace('#', &index).replace('@', &components);
    format!("<code>{name}</code>")
}

/// A name in which a line may break after a dot.
pub(crate) fn breakable(name: &str) -> String {
    escaped_text(name).replace('.', ".<wbr>")
}

fn unit_html(kind: Kind) -> String {
    match kind {
        Kind::Real(unit) if unit.name.is_empty() => "1".to_owned(),
        Kind::Real(unit) => escaped_text(unit.name).replace("s2", "s<sup>2</sup>"),
        _ => String::new(),
    }
}

/// One value if all of the row's variables start alike, else the values, an array element a line.
fn start_html(row: &Row, start: &[f64]) -> String {
    if start.iter().all(|value| value == &start[0]) {
        return value_html(row.kind, start[0]);
    }
    let element =
        |values: &[f64]| values.iter().map(|&value| value_html(row.kind, value)).collect::<Vec<_>>().join(",\u{a0}");
    start.chunks(row.components.len()).map(element).collect::<Vec<_>>().join("<br>")
}

fn value_html(kind: Kind, value: f64) -> String {
    match kind {
        Kind::Real(_) => rounded_text(value),
        Kind::Integer => format!("{value}"),
        Kind::Boolean => format!("{}", value != 0.0),
        Kind::Enumeration(enumeration) => format!("<code>{}</code>", enumeration.items[value as usize - 1].name),
    }
}

/// A number for reading, with a true minus sign: six decimals at most. The exact value is in
/// modelDescription.xml.
fn rounded_text(value: f64) -> String {
    let digits = if value == 0.0 {
        "0".to_owned()
    } else if value.abs() < 1e-4 {
        format!("{value:.6e}").replacen(".000000", "", 1)
    } else {
        format!("{value:.6}").trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    digits.replace('-', "−")
}

fn range_html(row: &Row) -> String {
    row.range.map_or(String::new(), |(min, max)| format!("{}…{}", rounded_text(min), rounded_text(max)))
}

fn meaning_html(row: &Row) -> String {
    let mut html = escaped_text(row.text());
    if let Kind::Enumeration(enumeration) = row.kind {
        html.push_str("<dl>");
        for (item, value) in enumeration.items.iter().zip(1..) {
            let (name, text) = (escaped_text(item.name), escaped_text(item.text.trim()));
            html += &format!("<dt>{value}: <code>{name}</code></dt><dd>{text}</dd>");
        }
        html.push_str("</dl>");
    }
    html
}

fn escaped_text(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
