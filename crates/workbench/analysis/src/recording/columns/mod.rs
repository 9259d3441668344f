//! The columns of a recording: their names, quantities and units.
//!
//! - [`Header`] has the titles of a file, a `title` each. `lookup` finds a name in it, or the
//!   terms of a sum of columns.
//! - `choice` chooses the columns of the quantities and `unit_choice` their units, of those that
//!   [`units`] lists.
//! - `likely` guesses columns by parts of their names.
//! - `missing` says which columns there are where one is missing.

mod choice;
mod header;
mod likely;
mod lookup;
mod missing;
mod quantity;
mod title;
mod unit_choice;
pub mod units;

pub use choice::{Column, UnitSource, period, value_places};
pub use header::Header;
pub use lookup::Term;
pub use quantity::Quantity;
