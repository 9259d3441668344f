//! The shared library of the motorcycle's FMU.
#![allow(non_snake_case)] // FMI names the library as the model

moris_fmi::export_fmi2!(moris_motorcycle::Motorcycle);
