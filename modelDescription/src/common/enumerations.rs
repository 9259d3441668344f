//! Items of enumerations.

use moris_interface::{Enumeration, Identity, Kind};

use super::xml::Element;

/// The items of an enumeration with the values of the variable in a call, counted from 1.
pub(crate) fn items(enumeration: &'static Enumeration) -> impl Iterator<Item = Element> {
    enumeration.items.iter().zip(1..).map(|(item, value): (_, i32)| {
        Element::new("Item").with("name", item.name).with("value", value).with("description", item.text.trim())
    })
}

/// Every enumeration that a row has, once, in the order in which they appear.
pub(crate) fn enumerations(identity: &Identity) -> Vec<&'static Enumeration> {
    let mut found: Vec<&Enumeration> = Vec::new();
    for row in identity.rows {
        if let Kind::Enumeration(enumeration) = row.kind
            && !found.contains(&enumeration)
        {
            found.push(enumeration);
        }
    }
    found
}
