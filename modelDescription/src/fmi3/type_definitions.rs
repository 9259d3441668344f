//! Types with a name: the quantities of reals with their units, and the enumerations.
//!
//! A variable's unit stands in its type. The standard allows it in the variable, too, as in the
//! description of FMI 2.0, but the importer fmi-sim rejects it there.

use serde::{Deserialize, Serialize};

use crate::common::enumerations::{Item, items};
use crate::common::units::RealAttributes;

/// `TypeDefinitions`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TypeDefinitions {
    #[serde(rename = "$value")]
    pub types: Vec<TypeDefinition>,
}

/// A type; the element's name says of what.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum TypeDefinition {
    Float64Type(Float64Type),
    EnumerationType(EnumerationType),
}

/// `Float64Type`: a quantity and its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Float64Type {
    /// The quantity's name, too.
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@quantity")]
    pub quantity: String,
    #[serde(rename = "@unit")]
    pub unit: String,
    #[serde(rename = "@displayUnit", default, skip_serializing_if = "Option::is_none")]
    pub display_unit: Option<String>,
    /// None: 1, which is the standard's default.
    #[serde(rename = "@nominal", default, skip_serializing_if = "Option::is_none")]
    pub nominal: Option<f64>,
}

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

impl From<&moris_interface::Unit> for Float64Type {
    fn from(unit: &moris_interface::Unit) -> Self {
        let RealAttributes { display_unit, nominal, .. } = unit.into();
        Float64Type {
            name: unit.quantity.to_owned(),
            quantity: unit.quantity.to_owned(),
            unit: unit.name.to_owned(),
            display_unit,
            nominal,
        }
    }
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
