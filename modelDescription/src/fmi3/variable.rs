//! One variable, a scalar or an array.

use moris_interface::{Causality, Variability};
use serde::{Deserialize, Serialize};

use crate::common::attributes::Initial;

/// A variable; the element's name is its type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum TypedVariable {
    Float64(Variable<f64>),
    Int32(Variable<i32>),
    Boolean(Variable<bool>),
    Enumeration(Variable<i64>),
}

/// Attributes of a variable of any type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(deserialize = "T: Deserialize<'de>"))]
pub struct Variable<T> {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@valueReference")]
    pub value_reference: u32,
    #[serde(rename = "@description")]
    pub description: String,
    #[serde(rename = "@causality")]
    pub causality: Causality,
    #[serde(rename = "@variability")]
    pub variability: Variability,
    /// Left out where the standard's default is meant: `exact` for inputs and parameters,
    /// nothing for the time.
    #[serde(rename = "@initial", default, skip_serializing_if = "Option::is_none")]
    pub initial: Option<Initial>,
    /// The name of the type that has a real's unit or lists an enumeration's items. None: a
    /// dimensionless real, or of another type.
    #[serde(rename = "@declaredType", default, skip_serializing_if = "Option::is_none")]
    pub declared_type: Option<String>,
    #[serde(rename = "@min", default, skip_serializing_if = "Option::is_none")]
    pub min: Option<T>,
    #[serde(rename = "@max", default, skip_serializing_if = "Option::is_none")]
    pub max: Option<T>,
    /// A value for each element, row by row.
    #[serde(rename = "@start", default = "no_start", skip_serializing_if = "Option::is_none")]
    pub start: Option<Vec<T>>,
    /// The array's dimensions, outermost first; none for a scalar.
    #[serde(rename = "Dimension", default = "Vec::new", skip_serializing_if = "Vec::is_empty")]
    pub dimensions: Vec<Dimension>,
}

/// `Dimension`: a size that never changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Dimension {
    #[serde(rename = "@start")]
    pub start: u64,
}

// serde's derived default would ask for one of `T` too.
fn no_start<T>() -> Option<Vec<T>> {
    None
}
