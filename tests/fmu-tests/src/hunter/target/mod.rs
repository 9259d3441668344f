//! Targets of the search: the washout, by the crate or by the C functions of its shared library.

mod crate_target;
mod fmu_target;
mod traced;

use anyhow::Result;
use moris_washout::Preview;

pub use crate_target::CrateTarget;
pub use fmu_target::FmuTarget;
pub use traced::Traced;

use crate::hunter::episode::Scope;
use crate::hunter::oracle::Sample;
use crate::hunter::variables::REAL_INPUTS;

/// Values of all inputs: the real ones, and whether the washout is engaged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inputs {
    pub reals: [f64; REAL_INPUTS],
    pub engaged: bool,
}

/// Something that is stepped as the washout is. A target keeps one saved state of each scope.
pub trait Target {
    /// Makes a machine of these values of all variables, at rest at neutral.
    ///
    /// # Errors
    /// The parameters are refused.
    fn make(&mut self, slots: &[f64]) -> Result<()>;

    /// Returns the machine to its state after [`Target::make`], and discards the saved states.
    fn rewind(&mut self);

    /// Sets the tunable parameters among these values of all variables. `changed` are the slots
    /// that differ. Returns false if the values are refused; then nothing has changed.
    fn set(&mut self, slots: &[f64], changed: &[usize]) -> bool;

    /// Gives a preview, as of the next step's start. A preview holds until the next one.
    fn preview(&mut self, preview: &Preview);

    /// Advances by `step` \[s\]. The inputs are held at `start`, or change linearly
    /// from `start` to `end`.
    ///
    /// # Errors
    /// The target refuses the step.
    fn step(&mut self, start: &Inputs, end: Option<&Inputs>, step: f64) -> Result<()>;

    /// The outputs now; `neutral_height` is subtracted from the platform's height.
    fn sample(&mut self, neutral_height: f64) -> Sample;

    /// Saves the state.
    ///
    /// # Errors
    /// The state cannot be saved.
    fn save(&mut self, scope: Scope) -> Result<()>;

    /// Restores the saved state. One must have been saved.
    ///
    /// # Errors
    /// The state is refused.
    fn restore(&mut self, scope: Scope) -> Result<()>;
}
