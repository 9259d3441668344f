//! The options by which every command is told of a rig and parameters.

use std::path::PathBuf;

use moris_setup::{Error, Setup};

/// Which rig, and which parameters.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct SetupOptions {
    /// Rig file [default: the default rig]
    #[arg(long, value_name = "FILE")]
    pub rig: Option<PathBuf>,

    /// Parameter file, or a shipped set: default, wake, preaction. May be given several times: later ones stand over earlier ones
    #[arg(long, value_name = "FILE|NAME")]
    pub parameters: Vec<String>,
}

impl SetupOptions {
    /// The parameters put together and checked.
    ///
    /// # Errors
    /// As [`Setup::load`].
    pub fn load(&self) -> Result<Setup, Error> {
        Setup::load(self.rig.as_deref(), &self.parameters)
    }
}
