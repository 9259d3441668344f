//! The columns of a recording: their names, quantities and units.

pub mod header;
pub mod quantity;
pub mod units;
