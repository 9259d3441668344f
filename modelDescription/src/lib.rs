//! The interface of a model as FMI describes it: `modelDescription.xml`, and the documentation's table of variables.
//!
//! The modules [`model_description`] to [`model_structure`] are the schema of FMI 2.0, as far as a co-simulation FMU of
//! ours uses it, one module a part of the file. [`describe`] fills it in from a model's rows, [`to_xml`] writes it.
//!
//! [`fmi3`] is the same for FMI 3.0.
//!
//! The directories named as a model beside this crate's sources have its `modelDescription.xml` and
//! `modelDescription.fmi3.xml`, generated and checked in, so that every change of an interface shows in a diff.
//! `cargo describe-models` writes them anew.

mod describe;
pub mod fmi3;
pub mod model_description;
pub mod model_structure;
pub mod scalar_variable;
pub mod type_definitions;
pub mod units;
mod variables_html;
mod xml;

pub use describe::{describe, describe_with};
pub use model_description::ModelDescription;
pub use variables_html::variables_html;
pub use xml::to_xml;
