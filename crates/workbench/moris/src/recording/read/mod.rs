//! From files to rows of numbers.
//!
//! - [`source`] finds the files of a recording and `text` reads them, but not those that `foreign`
//!   tells from CSV. `vbox` makes CSV of Racelogic's files.
//! - [`Sheet`] is a file with its header, before which there may be a `preamble`.
//! - `rows` parses its lines, as `numbers` or as `time`, to [`Samples`].

mod foreign;
mod numbers;
mod preamble;
mod rows;
mod samples;
mod sheet;
pub mod source;
mod text;
mod time;
mod vbox;

pub use numbers::is_number;
pub use samples::Samples;
pub use sheet::Sheet;
