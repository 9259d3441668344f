//! Types with a name: the enumerations.

use serde::{Deserialize, Serialize};

use crate::common::enumerations::{Item, items};

/// `EnumerationType`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnumerationType {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@description")]
    pub description: String,
    #[serde(rename = "Item")]
    pub items: Vec<Item>,
}

impl From<&moris_interface::Enumeration> for EnumerationType {
    fn from(enumeration: &moris_interface::Enumeration) -> Self {
        EnumerationType {
            name: enumeration.name.to_owned(),
            description: enumeration.text.trim().to_owned(),
            items: items(enumeration),
        }
    }
}
