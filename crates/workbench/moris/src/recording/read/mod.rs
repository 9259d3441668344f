//! From files to rows of numbers.

mod numbers;
pub mod sheet;
pub mod source;
mod time;
mod vbox;

pub use numbers::is_number;
