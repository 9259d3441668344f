//! The schema of FMI 3.0, as far as a co-simulation FMU of ours uses it, and its description of a model.
//!
//! A row of the interface is one variable here: an array where it has several values. What is as in FMI 2.0 is taken
//! from there.

mod describe;
pub mod model_description;
pub mod model_structure;
pub mod variable;
mod variables_html;

pub use describe::{describe, describe_with};
pub use model_description::ModelDescription;
pub use variables_html::variables_html;
