//! The documentation's tables of variables.

use moris_interface::{Model, Row};

use super::Layout;
use super::describe::{dimensions, element_type_name};
use crate::common::variables_html::{Notation, breakable, html, name_html as scalar_name_html};

/// The tables of a model's variables as HTML: one table for the inputs, the outputs, the
/// tunable and the fixed parameters, with the names and types of FMI 3.0. `start` has the
/// start value of each slot.
pub fn variables_html<M: Model>(start: &[f64], layout: Layout) -> String {
    let notation = match layout {
        Layout::Scalars => Notation { name: scalar_name_html, type_name: |row| element_type_name(row.kind).to_owned() },
        Layout::Arrays => Notation { name: name_html, type_name },
    };
    html(&M::IDENTITY, start, &notation)
}

/// The array's name and what its components are: `rig.base (x, y, z)`.
fn name_html(row: &Row) -> String {
    let name = format!("<code>{}</code>", breakable(&row.array_name()));
    match row.components {
        [_] => name,
        components => format!("{name} <i>({})</i>", components.join(",\u{a0}")),
    }
}

/// The type, and the dimensions of an array: `Float64 [6, 3]`.
fn type_name(row: &Row) -> String {
    let name = element_type_name(row.kind);
    let sizes: Vec<String> = dimensions(row).iter().map(ToString::to_string).collect();
    if sizes.is_empty() { name.to_owned() } else { format!("{name} [{}]", sizes.join(",\u{a0}")) }
}
