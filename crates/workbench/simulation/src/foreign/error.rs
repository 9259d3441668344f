//! Reasons why a foreign motion cannot be judged.

/// The reason why a foreign motion cannot be judged, with the argument and the remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ForeignError {
    /// No series of which forces follow.
    #[error("nothing to judge is given; give felt_force, pose or legs")]
    Nothing,
    /// A series does not belong to the recording.
    #[error(
        "{argument} has {found} rows, but the recording has {samples} samples; give {samples} rows, or n rows a step: \
         n · {} + 1, or a table with a column time",
        samples - 1
    )]
    Rows {
        /// Name of the argument.
        argument: &'static str,
        /// Number of rows of the argument.
        found: usize,
        /// Number of the recording's samples.
        samples: usize,
    },
    /// Too few samples for derivatives.
    #[error("{argument} has {found} rows, but forces of poses need at least {fewest}")]
    TooShort {
        /// Name of the argument.
        argument: &'static str,
        /// Number of rows of the argument.
        found: usize,
        /// Least number of samples that fits.
        fewest: usize,
    },
    /// A value is not a number.
    #[error("{argument}[{row}] holds {value}; every value must be a finite number: fill the gap, or cut this part off")]
    NotFinite {
        /// Name of the argument.
        argument: &'static str,
        /// Place of the row, from 0.
        row: usize,
        /// Value in the row.
        value: f64,
    },
    /// Values that cannot be meant.
    #[error("{argument}: {reason}")]
    Implausible {
        /// Name of the argument.
        argument: &'static str,
        /// The value, what is wrong with it, and the remedy.
        reason: String,
    },
}

/// Checks a series against the number of the recording's samples.
///
/// # Errors
/// Its length is not that of whole parts of the steps, or a value is not finite.
pub fn check<const N: usize>(
    argument: &'static str,
    series: &Option<Vec<[f64; N]>>,
    samples: usize,
) -> Result<(), ForeignError> {
    let Some(series) = series else { return Ok(()) };
    let found = series.len();
    if samples < 2 || found < samples || (found - 1) % (samples - 1) != 0 {
        return Err(ForeignError::Rows { argument, found, samples });
    }
    for (row, values) in series.iter().enumerate() {
        if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
            return Err(ForeignError::NotFinite { argument, row, value });
        }
    }
    Ok(())
}
