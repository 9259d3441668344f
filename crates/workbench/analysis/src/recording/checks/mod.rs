//! Checks of a recording in SI units and the washout's axes.
//!
//! - [`outliers`] finds samples that no vehicle causes.
//! - [`interleaved`] finds samples of several sensors by turns.
//! - `gravity`, `angles` and `rates` detect wrong units and axes.
//! - [`consistency`] detects [`Channels`] that contradict each other. [`dead`] finds those that
//!   stand still, [`frozen`] those that stop, [`exchanged`] those of another axis.
//! - [`delayed`] finds a speed and angles that come too late or too early.
//! - [`unusual`] warns about recordings that are possible.

mod angles;
mod channels;
pub mod consistency;
pub mod dead;
pub mod delayed;
pub mod exchanged;
pub mod frozen;
mod gravity;
pub mod interleaved;
pub mod outliers;
mod rates;
pub mod unusual;

use super::columns::UnitSource;
use super::conventions::Quantity;
use super::message::RecordingError;
use super::table::Table;
use crate::message::{Message, given, message};
pub use channels::Channels;

/// Checks that units and axes are plausible.
///
/// # Errors
/// They are not. The message names those that fit, and the option for them.
pub fn plausibility(channels: &Channels) -> Result<(), RecordingError> {
    // Angles first: with them gravity is put back.
    angles::check(channels)
        .and_then(|()| gravity::check(channels))
        .and_then(|()| rates::check(channels))
        .map_err(|reason| channels.table.refused(reason))
}

/// The remedy for a unit: an option where the header leaves it open, otherwise the header.
fn remedy(table: &Table, quantity: Quantity, word: &str) -> Message {
    let (unit, source) = table.unit(quantity);
    match source {
        UnitSource::Header => format!("correct the header, which gives {}", unit.word).into(),
        UnitSource::Ending | UnitSource::Option | UnitSource::Default => {
            message!["use ", given(quantity.dimension().option(), word)]
        }
    }
}
