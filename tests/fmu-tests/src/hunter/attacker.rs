//! An attacker that looks ahead.
//!
//! Every so many steps the run saves the washout's state and tries several inputs for some steps.
//! After each trial the state is restored. The inputs that brought a leg or an axis nearest to a
//! limit are held until the next choice. A trial that breaks a limit is repeated in earnest.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::random::bits_at;
use super::reach::Reach;

/// An attacker, as data. The same attacker makes the same trials in the same situation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attacker {
    pub aim: Aim,
    /// Steps from one choice to the next.
    pub every: usize,
    /// Steps of a trial.
    pub ahead: usize,
    /// Trials for a choice.
    pub tries: usize,
    pub seed: u32,
    /// The inputs that it chooses, by the names of the variables. Each is tried at this value, at
    /// its negative and at rest.
    pub amplitudes: BTreeMap<String, f64>,
}

/// An attacker's aim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Aim {
    /// A leg or an axis near its end.
    Room,
    /// A leg or an axis near its limit of velocity.
    Speed,
    /// A leg or an axis that needs much of the room ahead for a stop.
    Stop,
}

impl Aim {
    /// The larger the nearer to the aim.
    pub fn score(self, reach: &Reach) -> f64 {
        match self {
            Aim::Room => -reach.room,
            Aim::Speed => reach.speed,
            Aim::Stop => reach.stop,
        }
    }
}

impl Attacker {
    /// The sign with which a trial sets input number `input`: 1, 0 or -1.
    pub fn sign(&self, step: usize, trial: usize, input: usize) -> f64 {
        let number = (step * self.tries + trial) * 64 + input;
        [1.0, -1.0, 0.0][(bits_at(self.seed, number) % 3) as usize]
    }
}
