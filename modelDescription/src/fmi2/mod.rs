//! The description of a model by FMI 2.0, and its schema. The schema has the parts that a
//! co-simulation FMU of ours uses.

mod describe;
pub mod model_description;
pub mod model_structure;
pub mod scalar_variable;
pub mod type_definitions;
mod variables_html;

pub use describe::{describe, describe_with};
pub use model_description::ModelDescription;
pub use variables_html::variables_html;
