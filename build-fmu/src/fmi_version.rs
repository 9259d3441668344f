//! The versions of FMI that an FMU can be of.

use std::fmt;

#[cfg(feature = "clap")]
use clap::{ValueEnum, builder::PossibleValue};
use moris_fmi::{fmi2, fmi3};
use moris_model_description::fmi3::Layout;

/// A version of FMI and how its descriptions present variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FmiVersion {
    Fmi2,
    /// FMI 2.0 with reals only, for hosts that know no other type.
    Fmi2Reals,
    Fmi3(Layout),
}

/// The versions with scalars of their own types. `--arrays` makes arrays of the vectors, and
/// `--reals-only` reals of all variables.
#[cfg(feature = "clap")]
impl ValueEnum for FmiVersion {
    fn value_variants<'a>() -> &'a [Self] {
        Self::SCALARS
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        match self {
            FmiVersion::Fmi2 => Some(PossibleValue::new("2").help("FMI 2.0")),
            FmiVersion::Fmi3(Layout::Scalars) => Some(PossibleValue::new("3").help("FMI 3.0")),
            FmiVersion::Fmi2Reals | FmiVersion::Fmi3(Layout::Arrays) => None,
        }
    }
}

impl FmiVersion {
    /// The versions with scalars of their own types.
    pub const SCALARS: &[Self] = &[FmiVersion::Fmi2, FmiVersion::Fmi3(Layout::Scalars)];

    /// Every version with every layout.
    pub const ALL: &[Self] =
        &[FmiVersion::Fmi2, FmiVersion::Fmi2Reals, FmiVersion::Fmi3(Layout::Scalars), FmiVersion::Fmi3(Layout::Arrays)];

    /// The same version with vectors as array variables; `None` if it has none.
    pub fn with_arrays(self) -> Option<Self> {
        self.choose(None, Some(FmiVersion::Fmi3(Layout::Arrays)))
    }

    /// The same version with reals only; `None` if it has none.
    pub fn with_reals_only(self) -> Option<Self> {
        self.choose(Some(FmiVersion::Fmi2Reals), None)
    }

    /// The names that a shared library exports: all functions of the version's header, for
    /// importers look for all of them.
    pub fn functions(self) -> &'static [&'static str] {
        self.choose(fmi2::calling_sequence::NAMES, fmi3::calling_sequence::NAMES)
    }

    /// The name of a model's FMU. FMUs of all kinds can lie beside each other.
    pub fn fmu_file(self, model_name: &str) -> String {
        let kind = match self {
            FmiVersion::Fmi2 => "",
            FmiVersion::Fmi2Reals => ".reals",
            FmiVersion::Fmi3(Layout::Scalars) => ".fmi3",
            FmiVersion::Fmi3(Layout::Arrays) => ".fmi3.arrays",
        };
        format!("{model_name}{kind}.fmu")
    }

    /// Where the picture of the model is in the FMU.
    pub fn icon_file(self) -> &'static str {
        self.choose("model.png", "terminalsAndIcons/icon.png")
    }

    /// The version as a model description states it.
    pub fn number(self) -> &'static str {
        self.choose("2.0", "3.0")
    }

    /// The one of two things that is for this version.
    pub fn choose<T>(self, for_fmi2: T, for_fmi3: T) -> T {
        match self {
            FmiVersion::Fmi2 | FmiVersion::Fmi2Reals => for_fmi2,
            FmiVersion::Fmi3(_) => for_fmi3,
        }
    }

    /// The one of two things that fits the variables' names.
    pub fn choose_names<T>(self, for_scalars: T, for_arrays: T) -> T {
        match self {
            FmiVersion::Fmi3(Layout::Arrays) => for_arrays,
            FmiVersion::Fmi2 | FmiVersion::Fmi2Reals | FmiVersion::Fmi3(Layout::Scalars) => for_scalars,
        }
    }
}

impl fmt::Display for FmiVersion {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        write!(formatter, "FMI {}", self.number())
    }
}
