//! Parts of the model description that are the same in FMI 2.0 and 3.0.

pub(crate) mod enumerations;
pub mod origin;
pub(crate) mod parts;
pub mod units;
pub(crate) mod variables_html;
pub(crate) mod xml;
