//! Dependencies between variables.

use serde::{Deserialize, Serialize};

/// `ModelStructure`. Lists that would be empty are left out: the schema knows none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModelStructure {
    /// Every output, at communication points.
    #[serde(rename = "Outputs", skip_serializing_if = "Option::is_none")]
    pub outputs: Option<Unknowns>,
    /// Every variable that is calculated during initialisation.
    #[serde(rename = "InitialUnknowns", skip_serializing_if = "Option::is_none")]
    pub initial_unknowns: Option<Unknowns>,
}

/// A list of variables that are calculated, in ascending order of their indices.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unknowns {
    #[serde(rename = "Unknown")]
    pub unknowns: Vec<Unknown>,
}

/// A variable that is calculated, by its index from 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unknown {
    #[serde(rename = "@index")]
    pub index: u32,
    /// The indices of the variables that it is calculated from, ascending. Empty: from none of
    /// them. None: possibly from all inputs and parameters.
    #[serde(rename = "@dependencies", default, skip_serializing_if = "Option::is_none")]
    pub dependencies: Option<Vec<u32>>,
}

impl Unknowns {
    /// The list in which every one of `indices` has these dependencies; none where
    /// there is nothing to list.
    pub fn all_with(indices: &[u32], dependencies: Option<&[u32]>) -> Option<Self> {
        let unknown = |&index: &u32| Unknown { index, dependencies: dependencies.map(<[u32]>::to_vec) };
        (!indices.is_empty()).then(|| Unknowns { unknowns: indices.iter().map(unknown).collect() })
    }
}
