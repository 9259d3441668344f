//! Types with a name: the enumerations.

use serde::{Deserialize, Serialize};

use crate::common::enumerations::{Item, items};

/// `SimpleType`, of which we use the enumeration only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimpleType {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@description")]
    pub description: String,
    #[serde(rename = "Enumeration")]
    pub enumeration: Enumeration,
}

/// `Enumeration` of a type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Enumeration {
    #[serde(rename = "Item")]
    pub items: Vec<Item>,
}

impl From<&moris_interface::Enumeration> for SimpleType {
    fn from(enumeration: &moris_interface::Enumeration) -> Self {
        SimpleType {
            name: enumeration.name.to_owned(),
            description: enumeration.text.trim().to_owned(),
            enumeration: Enumeration { items: items(enumeration) },
        }
    }
}
