//! The reason why an analysis has no result.

use std::error::Error as StdError;

use moris_fmu_host::HostError;
use moris_simulation::Refusal;
use moris_washout::ParameterError;

use crate::message::{Message, Words};
use crate::recording::RecordingError;
use crate::tune::error::TuneError;

/// The reason why an analysis has no result.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A recording, a file or a place in it, with its own reason as the source.
    #[error("{about}")]
    About { about: String, source: Box<dyn StdError + Send + Sync> },
    /// Another washout's FMU cannot be stepped.
    #[error(transparent)]
    Fmu(#[from] HostError),
    /// A reason in words.
    #[error(transparent)]
    Message(#[from] Message),
    /// Parameters cannot be used.
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    /// A recording cannot be read.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// No measures, no bound, or a motion of another washout that cannot be judged.
    #[error(transparent)]
    Refused(#[from] Refusal),
}

impl Error {
    /// The reason with its sources, in a face's words.
    pub fn with_sources(&self, words: Words) -> String {
        let first: &(dyn StdError + 'static) = self;
        let chain = std::iter::successors(Some(first), |error| (*error).source());
        chain.map(|error| worded(error, words)).collect::<Vec<_>>().join(": ")
    }
}

/// An error without its sources, in a face's words.
pub fn worded(error: &(dyn StdError + 'static), words: Words) -> String {
    let error: &(dyn StdError + 'static) = match error.downcast_ref() {
        Some(Error::Recording(error)) => error,
        Some(Error::Message(message)) => message,
        _ => error,
    };
    if let Some(error) = error.downcast_ref::<RecordingError>() {
        error.worded(words)
    } else if let Some(error) = error.downcast_ref::<TuneError>() {
        error.worded(words)
    } else if let Some(message) = error.downcast_ref::<Message>() {
        message.worded(words)
    } else {
        error.to_string()
    }
}

/// Result of an analysis.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// An error with its place.
pub(crate) trait About<T> {
    /// The result, with its place in an error.
    fn about(self, about: impl FnOnce() -> String) -> Result<T>;
}

impl<T, E: StdError + Send + Sync + 'static> About<T> for Result<T, E> {
    fn about(self, about: impl FnOnce() -> String) -> Result<T> {
        self.map_err(|source| Error::About { about: about(), source: source.into() })
    }
}

/// Returns an error of this text.
macro_rules! bail {
    ($($text:tt)*) => { return Err($crate::message::Message::from(format!($($text)*)).into()) };
}
pub(crate) use bail;

/// Returns an error of this text unless the condition holds.
macro_rules! ensure {
    ($holds:expr, $($text:tt)*) => {
        match $holds {
            true => (),
            false => $crate::error::bail!($($text)*),
        }
    };
}
pub(crate) use ensure;
