//! Items of enumerations.

use moris_interface::{Enumeration, Identity, Kind};
use serde::{Deserialize, Serialize};

/// One choice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Item {
    #[serde(rename = "@name")]
    pub name: String,
    /// Value of the variable in a call.
    #[serde(rename = "@value")]
    pub value: i32,
    #[serde(rename = "@description")]
    pub description: String,
}

/// The items of an enumeration, counted from 1.
pub fn items(enumeration: &Enumeration) -> Vec<Item> {
    let item = |(item, value): (&moris_interface::Item, i32)| Item {
        name: item.name.to_owned(),
        value,
        description: item.text.trim().to_owned(),
    };
    enumeration.items.iter().zip(1..).map(item).collect()
}

/// Every enumeration that a row has, once, in the order in which they appear.
pub fn enumerations(identity: &Identity) -> Vec<&'static Enumeration> {
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
