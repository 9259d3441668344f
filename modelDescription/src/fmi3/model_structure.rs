//! Dependencies between variables.

use serde::{Deserialize, Serialize};

/// `ModelStructure`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModelStructure {
    /// Every output, at communication points.
    #[serde(rename = "Output", default, skip_serializing_if = "Vec::is_empty")]
    pub outputs: Vec<Unknown>,
    /// Every variable that is calculated during initialisation.
    #[serde(rename = "InitialUnknown", default, skip_serializing_if = "Vec::is_empty")]
    pub initial_unknowns: Vec<Unknown>,
}

/// A variable that is calculated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unknown {
    #[serde(rename = "@valueReference")]
    pub value_reference: u32,
    /// The value references of the variables that it is calculated from. Empty: from none of them.
    /// None: possibly from all inputs and parameters.
    #[serde(rename = "@dependencies", default, skip_serializing_if = "Option::is_none")]
    pub dependencies: Option<Vec<u32>>,
}
