//! From files to rows of numbers.
//!
//! - [`source`] finds the files of a recording and `text` reads them, but not those that `foreign`
//!   tells from CSV. `vbox` makes CSV of Racelogic's files, `tagged` of logs whose lines begin
//!   with their kind, and `serial` of prints of microcontrollers.
//! - [`Sheet`] is a file with its header, before which there may be a `preamble`.
//! - `rows` parses its lines, as `numbers` or as `time`, to [`Samples`].

mod foreign;
mod numbers;
mod preamble;
mod rows;
mod serial;
mod sheet;
pub mod source;
mod tagged;
mod text;
mod time;
mod vbox;

pub use numbers::is_number;
pub use rows::Samples;
pub use sheet::Sheet;
