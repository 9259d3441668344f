//! The rigs of the bench, which are the rig files of `examples/rigs`.

use moris_setup::{Error, Setup, rig_file};

/// A rig of the bench.
#[derive(Clone, Copy, Debug)]
pub struct BenchRig {
    /// Name in tables, and of its file.
    pub name: &'static str,
    text: &'static str,
}

/// The rigs of these files.
macro_rules! rigs {
    ($($name:literal)*) => {
        [$( BenchRig { name: $name, text: include_str!(concat!("../../../../../examples/rigs/", $name, ".toml")) }, )*]
    };
}

/// Every rig, by stroke.
pub const RIGS: [BenchRig; 12] = rigs! {
    "hobby100" "hobby150" "hobby200" "diy283" "compact" "dim330" "moog-like450" "narrow" "default" "flight091" "flight125"
    "long-stroke"
};

impl BenchRig {
    /// The rig with default parameters.
    ///
    /// # Errors
    /// The rig file cannot be used.
    pub fn setup(&self) -> Result<Setup, Error> {
        Ok(Setup::unchecked(Some(rig_file::read(self.text, self.name)?), &[]))
    }
}
