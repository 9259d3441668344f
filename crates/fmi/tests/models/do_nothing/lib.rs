//! A model that does nothing, as a shared library of FMI 2.0. An exchange with it costs
//! only the C functions.

pub mod model;

moris_fmi::export_fmi2!(super::model::DoNothing);
