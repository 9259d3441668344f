//! A small model with arrays as a shared library of FMI 3.0, which the tests load.

pub mod model;

moris_fmi::export_fmi3!(super::model::Lags);
