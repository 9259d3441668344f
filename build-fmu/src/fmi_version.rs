//! The versions of FMI that an FMU can be of.

use std::fmt;

use clap::ValueEnum;

use crate::functions::{FMI2_FUNCTIONS, FMI3_FUNCTIONS};

/// A version of FMI.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FmiVersion {
    /// FMI 2.0: scalar variables; what most tools load
    #[value(name = "2")]
    Fmi2,
    /// FMI 3.0: vectors are array variables
    #[value(name = "3")]
    Fmi3,
}

impl FmiVersion {
    /// The names that a shared library exports.
    pub fn functions(self) -> &'static [&'static str] {
        match self {
            FmiVersion::Fmi2 => FMI2_FUNCTIONS,
            FmiVersion::Fmi3 => FMI3_FUNCTIONS,
        }
    }

    /// The name of a model's FMU. FMUs of both versions can lie beside each other.
    pub fn fmu_file(self, model_name: &str) -> String {
        match self {
            FmiVersion::Fmi2 => format!("{model_name}.fmu"),
            FmiVersion::Fmi3 => format!("{model_name}.fmi3.fmu"),
        }
    }

    /// Where the picture of the model is in the FMU.
    pub fn icon_file(self) -> &'static str {
        match self {
            FmiVersion::Fmi2 => "model.png",
            FmiVersion::Fmi3 => "terminalsAndIcons/icon.png",
        }
    }

    /// The one of two things that is for this version.
    pub fn choose<T>(self, for_fmi2: T, for_fmi3: T) -> T {
        match self {
            FmiVersion::Fmi2 => for_fmi2,
            FmiVersion::Fmi3 => for_fmi3,
        }
    }
}

impl fmt::Display for FmiVersion {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str(self.choose("FMI 2.0", "FMI 3.0"))
    }
}
