//! Two parameter sets, A and B: kept, gone to, and voted on.

use std::fs::File;
use std::io::Write;
use std::time::Duration;

use moris_live::blend::{self, blended};
use moris_live::log;
use moris_setup::NamedValues;
use serde::Deserialize;

use crate::votes::{Set, Vote};

/// One of the two sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Which {
    A,
    B,
}

impl Which {
    /// Name of the set on the page.
    pub fn name(self) -> &'static str {
        ["A", "B"][self as usize]
    }
}

/// A kept set.
#[derive(Clone, Debug)]
struct Kept {
    slots: Vec<f64>,
    /// True once it has been in force while the platform was engaged.
    was_felt: bool,
}

/// The two sets.
#[derive(Debug)]
pub struct Pair {
    kept: [Option<Kept>; 2],
    transition: Option<Transition>,
    /// Values of the rig with default parameters.
    rig_alone: NamedValues,
    votes: Option<File>,
}

/// A transition from one set to another.
#[derive(Clone, Debug)]
struct Transition {
    from: Vec<f64>,
    to: Vec<f64>,
    begin: Duration,
}

impl Pair {
    /// No sets, and a file for votes.
    pub fn new(rig_alone: NamedValues, votes: Option<File>) -> Self {
        Pair { kept: [None, None], transition: None, rig_alone, votes }
    }

    /// Keeps the parameters in force.
    ///
    /// # Errors
    /// They change just now.
    pub fn keep(&mut self, which: Which, slots: Vec<f64>) -> Result<(), String> {
        if self.transition.is_some() {
            return Err("the parameters change just now".to_owned());
        }
        self.kept[which as usize] = Some(Kept { slots, was_felt: false });
        Ok(())
    }

    /// The values of a set.
    ///
    /// # Errors
    /// None has been kept.
    pub fn slots(&self, which: Which) -> Result<&Vec<f64>, String> {
        let kept = self.kept[which as usize].as_ref();
        kept.map(|kept| &kept.slots).ok_or_else(|| format!("nothing has been kept as {}", which.name()))
    }

    /// Begins the transition from these values to those.
    pub fn go(&mut self, from: Vec<f64>, to: Vec<f64>, begin: Duration) {
        self.transition = Some(Transition { from, to, begin });
    }

    /// Ends a transition where it is.
    pub fn end_transition(&mut self) {
        self.transition = None;
    }

    /// The values of all slots at this time of a transition, and true at its end; none without one.
    pub fn transition_at(&self, now: Duration) -> Option<(Vec<f64>, bool)> {
        let Transition { from, to, begin } = self.transition.as_ref()?;
        let part = now.saturating_sub(*begin).as_secs_f64() / blend::TIME;
        Some((blended(from, to, part), part >= 1.0))
    }

    /// The set that these values are.
    pub fn present(&self, slots: &[f64]) -> Option<Which> {
        let is_there = |which: &Which| self.slots(*which).is_ok_and(|kept| kept == slots);
        [Which::A, Which::B].into_iter().find(is_there)
    }

    /// Marks the sets with these values as felt: the platform was engaged with them.
    pub fn mark_felt(&mut self, slots: &[f64]) {
        for kept in self.kept.iter_mut().flatten() {
            kept.was_felt |= kept.slots == slots;
        }
    }

    /// As JSON: which sets there are, and which one is in force.
    pub fn status(&self, slots: &[f64]) -> String {
        let [a, b] = self.kept.each_ref().map(Option::is_some);
        let now = self.present(slots).map(Which::name);
        serde_json::json!({ "a": a, "b": b, "now": now, "votes": self.votes.is_some() }).to_string()
    }

    /// Writes the vote that one of the sets is better.
    ///
    /// # Errors
    /// There is nothing to vote on, or no file for it.
    pub fn vote(&mut self, better: Which) -> Result<(), String> {
        let worse = if better == Which::A { Which::B } else { Which::A };
        for which in [better, worse] {
            self.slots(which)?;
            if !self.kept[which as usize].as_ref().is_some_and(|kept| kept.was_felt) {
                return Err(format!("{} has not been felt yet", which.name()));
            }
        }
        let [better, worse] = [self.values(self.slots(better)?), self.values(self.slots(worse)?)];
        if better == worse {
            return Err("A and B are the same".to_owned());
        }
        let file = self.votes.as_mut().ok_or("moris live --votes FILE takes votes")?;
        let line = serde_json::to_string(&Vote { better, worse }).map_err(|error| error.to_string())?;
        writeln!(file, "{line}").map_err(|error| format!("the vote cannot be written: {error}"))
    }

    /// The values that differ from those of the rig with default parameters.
    fn values(&self, slots: &[f64]) -> Set {
        let differs = |(slot, value): &(usize, &f64)| self.rig_alone[*slot].1 != **value;
        slots.iter().enumerate().filter(differs).map(|(slot, value)| (log::name_of(slot), *value)).collect()
    }
}
