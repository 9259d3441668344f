//! The shared library of the Stewart platform's FMU.
#![allow(non_snake_case)] // FMI wants the library to be named as the model

fmi_export::export_fmi2!(moris_stewart_platform::StewartPlatform);
