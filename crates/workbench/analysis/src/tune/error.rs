//! Reasons why a tuning has no result.

use moris_washout::ParameterError;

use crate::message::{Message, Words};

/// The reason why a tuning has no result.
#[derive(Debug, thiserror::Error)]
pub enum TuneError {
    /// No parameters were found that keep the constraints. The text names the recordings and the
    /// remedies.
    #[error("{0}")]
    Infeasible(Message),
    /// The groups have no parameter that can be tuned.
    #[error("{0}")]
    NothingToTune(Message),
    /// Parameters cannot be used.
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    /// The search cannot begin.
    #[error("CMA-ES rejects the start of the search: {0}")]
    Start(String),
    /// Another place than this machine computes the costs, and has not.
    #[error("{0}")]
    Evaluation(&'static str),
}

impl TuneError {
    /// The error in a face's words.
    pub fn worded(&self, words: Words) -> String {
        match self {
            TuneError::Infeasible(message) | TuneError::NothingToTune(message) => message.worded(words),
            other => other.to_string(),
        }
    }
}
