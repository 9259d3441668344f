//! Checks of a recording in SI units and the washout's axes.
//!
//! - [`outliers`] finds samples that no vehicle causes.
//! - [`interleaved`] finds samples of several sensors by turns.
//! - `gravity`, `angles` and `rates` detect wrong units and axes.
//! - [`consistency`] detects channels that contradict each other, with the sign that `speeds` gives
//!   the speed. [`dead`] finds those that stand still, [`frozen`] those that stop, [`exchanged`]
//!   those of another axis.
//! - [`delayed`] finds a speed and angles that come too late or too early.
//! - [`unusual`] warns about recordings that are possible.

mod angles;
pub mod consistency;
pub mod dead;
pub mod delayed;
pub mod exchanged;
pub mod frozen;
mod gravity;
pub mod interleaved;
pub mod outliers;
mod rates;
mod speeds;
pub mod unusual;

use moris_washout::Input;

use super::columns::UnitSource;
use super::conventions::{Conventions, Quantity};
use super::message::RecordingError;
use super::table::Table;
use crate::message::{Message, given, message};

/// Checks that units and axes are plausible.
///
/// # Errors
/// They are not. The message names those that fit, and the option for them.
pub fn plausibility(table: &Table, inputs: &[Input], conventions: &Conventions) -> Result<(), RecordingError> {
    // Angles first: with them gravity is put back.
    angles::check(table, inputs, conventions)
        .and_then(|()| gravity::check(table, inputs, conventions))
        .and_then(|()| rates::check(table, inputs, conventions))
        .map_err(|reason| table.refused(reason))
}

/// The remedy for a column: another name.
fn remedy_with(quantity: Quantity, name: &str) -> Message {
    message!["use ", given("columns", format!("{}={name}", quantity.key()))]
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
