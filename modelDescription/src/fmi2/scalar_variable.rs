//! One variable.

use serde::{Deserialize, Serialize};

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

/// Who sets a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Causality {
    Independent,
    Input,
    Output,
    Parameter,
}

/// When a variable may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Variability {
    Continuous,
    Discrete,
    Tunable,
    Fixed,
}

/// Where a variable's first value comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Initial {
    /// From other variables: it has no start value.
    Calculated,
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

impl From<moris_interface::Causality> for Causality {
    fn from(causality: moris_interface::Causality) -> Self {
        match causality {
            moris_interface::Causality::Independent => Causality::Independent,
            moris_interface::Causality::Input => Causality::Input,
            moris_interface::Causality::Output => Causality::Output,
            moris_interface::Causality::Parameter => Causality::Parameter,
        }
    }
}

impl From<moris_interface::Variability> for Variability {
    fn from(variability: moris_interface::Variability) -> Self {
        match variability {
            moris_interface::Variability::Continuous => Variability::Continuous,
            moris_interface::Variability::Discrete => Variability::Discrete,
            moris_interface::Variability::Tunable => Variability::Tunable,
            moris_interface::Variability::Fixed => Variability::Fixed,
        }
    }
}
