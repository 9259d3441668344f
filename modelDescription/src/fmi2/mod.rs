//! The description of a model by FMI 2.0.
//!
//! Variables have their own types, or all of them are reals: see [`Types`].

mod describe;
mod variables_html;

pub use describe::{describe, describe_with, with_source_file};
pub use moris_interface::Types;
pub use variables_html::variables_html;
