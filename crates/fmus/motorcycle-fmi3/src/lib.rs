//! The shared library of the motorcycle's FMU for FMI 3.0.
#![allow(non_snake_case)] // named as the model

moris_fmi::export_fmi3!(moris_motorcycle::Motorcycle);
