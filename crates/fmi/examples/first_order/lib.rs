//! A small model as a shared library: the least that an FMU's library needs, and what the tests
//! load.

pub mod model;

moris_fmi::export_fmi2!(super::model::FirstOrder);
