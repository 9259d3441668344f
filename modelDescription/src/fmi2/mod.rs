//! The description of a model by FMI 2.0.

mod describe;
mod variables_html;

pub use describe::{describe, describe_with, with_source_file};
pub use variables_html::variables_html;
