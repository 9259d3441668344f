//! An episode: a machine, its inputs, its steps and what happens on the way, as data.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use super::attacker::Attacker;
use super::preview::Previews;
use super::random::fraction_at;
use super::signal::Signal;

/// Values by the names of the washout's variables.
pub type Values = BTreeMap<String, f64>;

/// A case of the search. The same episode gives the same outputs, bit for bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Episode {
    /// The seed of the search, the number of the machine in it, and the number of the
    /// episode on this machine.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin: Option<[i64; 3]>,
    /// Number of communication steps.
    pub count: usize,
    /// True: inputs are linear over a step. False: they are held.
    #[serde(default)]
    pub linear: bool,
    /// Lengths of the steps.
    pub steps: Steps,
    /// The parameters that differ from the default.
    #[serde(default)]
    pub parameters: Values,
    /// The inputs that are not at rest, by the names of the variables. `engaged` is true where its
    /// signal is not negative. That of `vehicle.specificForce.z` adds to its start value.
    #[serde(default)]
    pub inputs: BTreeMap<String, Signal>,
    /// The preview that the host gives before each step, if it does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preview: Option<Previews>,
    /// An attacker that looks ahead for the worst inputs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attacker: Option<Attacker>,
    /// A rest at the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rest: Option<Rest>,
    /// Events between two steps, in the order of time.
    #[serde(default)]
    pub events: Vec<Event>,
}

/// Inputs at rest after the last step, within which the platform has to come to neutral.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rest {
    /// Largest number of steps.
    pub count: usize,
    /// Length of a step \[s\].
    pub step: f64,
    /// True: the washout is engaged meanwhile.
    pub engaged: bool,
    /// Tunable parameters that are set before, so that the filters return in a known time.
    #[serde(default)]
    pub parameters: Values,
}

/// Lengths of the communication steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "form", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Steps {
    /// All of one length \[s\].
    Even { length: f64 },
    /// Log-uniform between two lengths \[s\], a new one every `held` steps.
    Irregular { shortest: f64, longest: f64, held: usize, seed: u32 },
}

impl Steps {
    /// The length of step number `step` \[s\].
    #[inline]
    pub fn length(&self, step: usize) -> f64 {
        match *self {
            Steps::Even { length } => length,
            Steps::Irregular { shortest, longest, held, seed } => {
                shortest * (longest / shortest).powf(fraction_at(seed, step / held.max(1)))
            }
        }
    }
}

/// Something that a host does before step number `before`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Event {
    /// The number of the step, from 0.
    pub before: usize,
    /// The action.
    #[serde(flatten)]
    pub action: Action,
}

/// Actions of a host between two steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Action {
    /// Sets tunable parameters, all at once.
    Set(Values),
    /// Saves the state.
    Save(Scope),
    /// Goes back to the state saved last, if any: outputs, parameters and time.
    Restore(Scope),
}

/// Where a saved state goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scope {
    /// The state stays in memory.
    Memory,
    /// The state goes through bytes, where the washout is driven through the C functions.
    Bytes,
    /// A trial's own: where an [attacker](super::attacker) goes back to.
    Trial,
}

/// Number of scopes.
pub const SCOPES: usize = 3;

impl Episode {
    /// The episode as a TOML file.
    ///
    /// # Errors
    /// No error is known: TOML can represent every number.
    pub fn to_toml(&self) -> Result<String> {
        toml::to_string(self).context("writing the episode")
    }

    /// Reads an episode from the text of a TOML file.
    ///
    /// # Errors
    /// The text is not TOML, or not an episode.
    pub fn from_toml(text: &str) -> Result<Self> {
        toml::from_str(text).context("reading the episode")
    }
}
