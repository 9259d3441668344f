//! The schema of FMI 2.0, as far as a co-simulation FMU of ours uses it, and its
//! description of a model.

mod describe;
pub mod model_description;
pub mod model_structure;
pub mod scalar_variable;
pub mod type_definitions;
mod variables_html;

pub use describe::{describe, describe_with};
pub use model_description::ModelDescription;
pub use variables_html::variables_html;
