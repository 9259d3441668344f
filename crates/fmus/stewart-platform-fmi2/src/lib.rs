//! The shared library of the Stewart platform's FMU.
#![allow(non_snake_case)] // FMI names the library as the model

moris_fmi::export_fmi2!(moris_stewart_platform::StewartPlatform);
