//! Options on the form of an FMU, which several commands have.

use crate::{Error, FmiVersion};

/// Forms of an FMU of FMI 2.0 that some hosts need.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct FormOptions {
    /// Describe every variable as a Real (FMI 2.0 only), for tools that know no other type
    #[cfg_attr(feature = "clap", arg(long))]
    pub reals_only: bool,

    /// Add terminals to an FMU of FMI 2.0; one of FMI 3.0 always has them
    #[cfg_attr(feature = "clap", arg(long))]
    pub terminals: bool,
}

impl FormOptions {
    /// The version of an FMU in this form that is of the version `fmi` without it.
    ///
    /// # Errors
    /// Reals alone are asked for in a version that does not have them.
    pub fn of(self, fmi: FmiVersion) -> Result<FmiVersion, Error> {
        if self.reals_only { fmi.with_reals_only().ok_or(Error::NoReals) } else { Ok(fmi) }
    }
}
