//! A small model with arrays as a shared library of FMI 3.0, which the tests load.

pub mod model;

fmi_export::export_fmi3!(super::model::Lags);
