//! A model that does nothing, as a shared library of FMI 2.0: what is left of an exchange is the
//! cost of the C functions.

pub mod model;

moris_fmi::export_fmi2!(super::model::DoNothing);
