//! The description of a model by FMI 2.0, with the parts that a co-simulation FMU of
//! ours uses.

mod describe;
mod variables_html;

pub use describe::{describe, describe_with, with_source_file};
pub use variables_html::variables_html;
