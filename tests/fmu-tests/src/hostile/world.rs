//! The hostile host itself: its instances and saved states, and the loop.

use std::collections::BTreeMap;

use super::choices::Choices;
use super::functions::{Answer, Functions};
use super::player::Player;
use super::states::{Bytes, Saved};
use super::{calls, states, steps, variables};

/// Largest number of instances and of saved states.
const INSTANCES: usize = 4;
const STATES: usize = 6;
/// One call in this many has the whole instance compared before and after, in case it is refused.
const WATCHED: usize = 16;

/// Count of each function's statuses.
pub type CallCounts = BTreeMap<(&'static str, i32), u64>;

/// Instances and states of the host.
pub struct World<'a> {
    pub functions: &'a Functions,
    pub choices: Choices<'a>,
    pub players: Vec<Player>,
    pub states: Vec<Saved>,
    pub bytes: Vec<Bytes>,
    pub counts: CallCounts,
    calls: u64,
}

/// Makes this many calls, or as many as the choices last for.
///
/// # Panics
/// If a call does anything but what it should.
pub fn run(functions: &Functions, choices: Choices, calls: u64) -> CallCounts {
    let mut world = World {
        functions,
        choices,
        players: vec![],
        states: vec![],
        bytes: vec![],
        counts: CallCounts::new(),
        calls: 0,
    };
    while world.calls < calls && !world.choices.are_over() {
        world.one_thing();
    }
    world.leave()
}

impl World<'_> {
    /// One call, or a few that belong together.
    fn one_thing(&mut self) {
        if self.players.is_empty() || self.players.len() < INSTANCES && self.choices.once_in(200) {
            return calls::instantiate(self);
        }
        let who = self.choices.below(self.players.len());
        let watched = self.choices.once_in(WATCHED);
        let before = watched.then(|| self.players[who].bytes(self.functions));
        let status = match self.choices.below(100) {
            0..36 => steps::do_step(self, who),
            36..50 => variables::set(self, who),
            50..58 => variables::get(self, who),
            58..62 => calls::own_of_version(self, who),
            62..66 => variables::output_derivatives(self, who),
            66..78 => states::any(self, who),
            78..88 => calls::towards_steps(self, who),
            88..98 => calls::any(self, who),
            98 => calls::seldom(self, who),
            _ => return calls::free_instance(self, who),
        };
        let player = &mut self.players[who];
        player.inspect(self.functions);
        if let Some(before) = before.filter(|_| status != 0) {
            assert!(player.bytes(self.functions) == before, "a refused call changed something");
        }
    }

    /// Counts a call, and checks how it ended; returns the status.
    pub fn accept(&mut self, who: usize, answer: Answer, right: &[i32]) -> i32 {
        let (function, status) = answer;
        self.count(function, status);
        self.players[who].accept(answer, right);
        status
    }

    /// Counts a call.
    pub fn count(&mut self, function: &'static str, status: i32) {
        self.calls += 1;
        *self.counts.entry((function, status)).or_default() += 1;
    }

    /// True if another state can be saved.
    pub fn has_room_for_states(&self) -> bool {
        self.states.len() < STATES
    }

    /// Frees everything.
    fn leave(mut self) -> CallCounts {
        if self.players.is_empty() {
            self.players.push(Player::new(self.functions, "last", true, false));
        }
        while !self.states.is_empty() {
            states::free(&mut self, 0);
        }
        for player in self.players.drain(..) {
            player.free(self.functions);
        }
        self.counts
    }
}
