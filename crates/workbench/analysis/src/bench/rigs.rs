//! The rigs of the bench: the shipped ones with legs, and two with cranks.

use moris_setup::{Error, Setup, load_rig};

/// A rig of the bench.
#[derive(Clone, Copy, Debug)]
pub struct BenchRig {
    /// Name in tables, and of its file.
    pub name: &'static str,
}

/// Every rig with legs, by stroke, then a desk model and a person's simulator with cranks.
pub const BENCH_RIGS: [BenchRig; 14] = {
    let mut rigs = [BenchRig { name: "" }; 14];
    let mut place = 0;
    while place < rigs.len() {
        rigs[place].name = moris_setup::SHIPPED_RIGS[place].0;
        place += 1;
    }
    rigs
};

impl BenchRig {
    /// The rig with default parameters.
    ///
    /// # Errors
    /// The rig file cannot be used.
    pub fn setup(&self) -> Result<Setup, Error> {
        Ok(Setup::unchecked(Some(load_rig(self.name.as_ref())?), &[]))
    }
}
