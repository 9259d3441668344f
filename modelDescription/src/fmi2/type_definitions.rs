//! Types with a name: the enumerations.

use serde::{Deserialize, Serialize};

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

/// One choice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Item {
    #[serde(rename = "@name")]
    pub name: String,
    /// Value for `fmi2SetInteger` and `fmi2GetInteger`.
    #[serde(rename = "@value")]
    pub value: i32,
    #[serde(rename = "@description")]
    pub description: String,
}

impl From<&moris_interface::Enumeration> for SimpleType {
    fn from(enumeration: &moris_interface::Enumeration) -> Self {
        let items = enumeration.items.iter().zip(1..).map(|(item, value)| Item {
            name: item.name.to_owned(),
            value,
            description: item.text.trim().to_owned(),
        });
        SimpleType {
            name: enumeration.name.to_owned(),
            description: enumeration.text.trim().to_owned(),
            enumeration: Enumeration { items: items.collect() },
        }
    }
}
