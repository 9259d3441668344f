//! One variable.

use moris_interface::{Causality, Variability};
use serde::{Deserialize, Serialize};

use crate::common::attributes::Initial;

/// `ScalarVariable`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScalarVariable {
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
    /// `Real`, `Integer`, `Boolean` or `Enumeration`.
    #[serde(rename = "$value")]
    pub values: Values,
}

/// A variable's type, with what that type's values have.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Values {
    Real {
        #[serde(rename = "@quantity", default, skip_serializing_if = "Option::is_none")]
        quantity: Option<String>,
        /// None: dimensionless.
        #[serde(rename = "@unit", default, skip_serializing_if = "Option::is_none")]
        unit: Option<String>,
        #[serde(rename = "@displayUnit", default, skip_serializing_if = "Option::is_none")]
        display_unit: Option<String>,
        #[serde(rename = "@min", default, skip_serializing_if = "Option::is_none")]
        min: Option<f64>,
        #[serde(rename = "@max", default, skip_serializing_if = "Option::is_none")]
        max: Option<f64>,
        #[serde(rename = "@nominal", default, skip_serializing_if = "Option::is_none")]
        nominal: Option<f64>,
        #[serde(rename = "@start", default, skip_serializing_if = "Option::is_none")]
        start: Option<f64>,
    },
    Integer {
        #[serde(rename = "@min", default, skip_serializing_if = "Option::is_none")]
        min: Option<i32>,
        #[serde(rename = "@max", default, skip_serializing_if = "Option::is_none")]
        max: Option<i32>,
        #[serde(rename = "@start", default, skip_serializing_if = "Option::is_none")]
        start: Option<i32>,
    },
    Boolean {
        #[serde(rename = "@start", default, skip_serializing_if = "Option::is_none")]
        start: Option<bool>,
    },
    Enumeration {
        /// The name of the type that lists the items.
        #[serde(rename = "@declaredType")]
        declared_type: String,
        #[serde(rename = "@min")]
        min: i32,
        #[serde(rename = "@max")]
        max: i32,
        #[serde(rename = "@start", default, skip_serializing_if = "Option::is_none")]
        start: Option<i32>,
    },
}
