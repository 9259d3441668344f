//! The shared library of the washout's FMU for FMI 3.0.
#![allow(non_snake_case)] // named as the model

moris_fmi::export_fmi3!(moris_washout::Washout);
