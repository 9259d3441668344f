//! The documentation's tables of variables.

use moris_interface::{Kind, Model, Row, Types};

use crate::common::variables_html::{Notation, html, name_html};

/// The tables of a model's variables as HTML: one table for the inputs, the outputs, the
/// tunable and the fixed parameters, with the names of FMI 2.0 and these types. `start` has the
/// start value of each slot.
pub fn variables_html<M: Model>(start: &[f64], types: Types) -> String {
    let type_name = match types {
        Types::Own => |row: &Row| type_name(row.kind).to_owned(),
        Types::Reals => |_: &Row| "Real".to_owned(),
    };
    html(&M::IDENTITY, start, &Notation { name: name_html, type_name })
}

fn type_name(kind: Kind) -> &'static str {
    match kind {
        Kind::Real(_) => "Real",
        Kind::Integer => "Integer",
        Kind::Boolean => "Boolean",
        Kind::Enumeration(_) => "Enumeration",
    }
}
