//! The schema of FMI 3.0, as far as a co-simulation FMU of ours uses it, and its
//! description of a model.
//!
//! A row of the interface with several values is as many scalars or one array: see [`Layout`].

mod describe;
pub mod model_description;
pub mod model_structure;
pub mod type_definitions;
pub mod variable;
mod variables_html;

pub use describe::{describe, describe_with};
pub use model_description::ModelDescription;
pub use moris_fmi::fmi3::Layout;
pub use variables_html::variables_html;
