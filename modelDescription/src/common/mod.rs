//! Parts of the model description that are the same in FMI 2.0 and 3.0.

pub mod units;
pub(crate) mod xml;
