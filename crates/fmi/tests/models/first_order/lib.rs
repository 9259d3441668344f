//! A small model as a shared library. The model is the least that an FMU's library
//! needs. The tests load it.

pub mod model;

moris_fmi::export_fmi2!(super::model::FirstOrder);
