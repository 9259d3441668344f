//! Attributes of a variable that are the same in FMI 2.0 and 3.0.

use serde::{Deserialize, Serialize};

/// Where a variable's first value comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Initial {
    /// From other variables: it has no start value.
    Calculated,
}
