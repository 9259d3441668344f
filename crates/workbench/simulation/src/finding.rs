//! A finding, and its severity.

use serde::Serialize;

/// A sentence about the run, and how much it matters.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Finding {
    pub weight: Weight,
    pub text: String,
}

/// Severity of a finding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Weight {
    /// As it should be.
    Good,
    /// A fact that needs no change.
    #[default]
    Note,
    /// Something limits the cues, or is doubtful about the data.
    Warning,
}
