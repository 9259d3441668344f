//! A recording replayed as a host does it: in steps of the host's length, with or without
//! slopes of the inputs.

use moris_simulation::Replay;
use moris_simulation::preview::Previewer;
use moris_washout::Parameters;
use moris_washout::interface::StrategyKind;

use crate::error::Result;
use crate::message::{Message, named};
use crate::recording::Recording;
use crate::texts::text;

use moris_simulation::Simulation;

/// Input within a step, as given by the host.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Inputs {
    /// Value and slope: the input goes linearly through the step
    #[default]
    Slopes,
    /// The value at the step's start alone
    Values,
}

/// The host's communication steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Host {
    /// Length of a step \[s\]; none: the recording's.
    pub step: Option<f64>,
    /// Input within a step, as given by the host.
    pub inputs: Inputs,
    /// Length of the preview that the host gives \[s\]; 0: none.
    pub preview: f64,
    /// True with a preview that is learned by the recording's position.
    pub learns: bool,
}

/// Refuses an option of the predictive strategy, such as `preview` or `learn`, with another one.
///
/// # Errors
/// The strategy is another one: the option, and the remedy.
pub fn check_predictive(option: &'static str, strategy: StrategyKind) -> Result<(), Message> {
    if strategy == StrategyKind::Predictive {
        return Ok(());
    }
    Err(text!["predictive-alone", option = named(option)])
}

impl Host {
    /// Replays a recording from rest at neutral. Between its samples the recording is linear;
    /// outputs are kept at its samples, or at the ends of the host's steps where those are longer.
    /// `learned` is the preview where one is learned.
    ///
    /// # Errors
    /// The parameters cannot be used, or neither of the host's step and the recording's is a
    /// multiple of the other.
    pub fn replay(
        &self,
        recording: &Recording,
        parameters: &Parameters,
        learned: Option<Previewer>,
    ) -> Result<Simulation> {
        let sample = recording.step();
        let step = self.step.unwrap_or(sample);
        let replay = Replay::in_steps(&recording.manoeuvre, step, self.inputs == Inputs::Slopes).ok_or_else(|| {
            let (name, step, sample) = (&recording.name, step.to_string(), sample.to_string());
            text!["step-of-host", step, name, sample]
        })?;
        let previewer = learned.or_else(|| Previewer::of(&recording.manoeuvre, self.preview));
        Ok(Simulation::previewed(&replay, parameters, previewer, || ())?)
    }
}
