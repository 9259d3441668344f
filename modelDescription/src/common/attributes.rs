//! Attributes of a variable that are the same in FMI 2.0 and 3.0.

use serde::{Deserialize, Serialize};

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
