//! Random episodes on a machine: inputs that excite it, steps, and changes on the way.

use std::collections::BTreeMap;

use moris_interface::Variability;

use super::attacker::{Aim, Attacker};
use super::episode::{Action, Episode, Event, Rest, Scope, Steps, Values};
use super::machine::Machines;
use super::preview::{Forces, Previews};
use super::random::Random;
use super::signal::{Signal, VELOCITIES};
use super::variables::{REAL_INPUTS, Variables};

/// Largest number of steps of an episode, and largest mean number of internal steps in a step.
const MOST_STEPS: usize = 4000;
const LONGEST_INTERNAL_STEPS: f64 = 12.0;
/// The shortest and the longest communication step \[s\].
const SHORTEST_STEP: f64 = 1e-6;
const LONGEST_STEP: f64 = 0.1;
/// Time within which the platform has to be at neutral once the inputs rest \[s\].
const REST_TIME: f64 = 200.0;
/// Largest number of internal steps of a rest: machines with shorter steps are not made to rest.
const MOST_INTERNAL_STEPS_OF_A_REST: f64 = 1e6;
/// The parameter `strategy` of the predictive strategy.
const PREDICTIVE: f64 = 4.0;
/// The parameter `preaction` with which it is on.
const PREACTION_ON: f64 = 2.0;

/// Draws episodes.
pub struct Scenarios<'a> {
    variables: &'a Variables,
    machines: &'a Machines<'a>,
    inputs: Vec<String>,
}

impl<'a> Scenarios<'a> {
    /// Draws with these variables and machines.
    pub fn new(variables: &'a Variables, machines: &'a Machines<'a>) -> Self {
        let inputs = variables.inputs().into_iter().map(|(name, _)| name).collect();
        Scenarios { variables, machines, inputs }
    }

    /// An episode on this machine.
    pub fn draw(&self, random: &mut Random, machine: &Values) -> Episode {
        let steps = self.draw_steps(random, machine);
        let length = (0..100).map(|step| steps.length(step * 37)).sum::<f64>() / 100.0;
        // Long enough for the platform to move: seconds, if steps are not too short for that.
        let duration = random.log_between(0.3, 20.0);
        let count = ((duration / length) as usize).clamp(200, MOST_STEPS);
        Episode {
            origin: None,
            count,
            linear: random.chance(0.4),
            steps,
            parameters: machine.clone(),
            inputs: self.draw_inputs(random, machine, length, count),
            preview: draw_previews(random, machine),
            attacker: self.draw_attacker(random),
            rest: self.draw_rest(random, machine),
            events: self.draw_events(random, machine, count),
        }
    }

    /// An attacker in an eighth of the episodes.
    fn draw_attacker(&self, random: &mut Random) -> Option<Attacker> {
        if !random.chance(0.125) {
            return None;
        }
        let density = random.pick(&[0.2, 0.6, 1.0]);
        let mut amplitudes = BTreeMap::new();
        for (number, name) in self.inputs.iter().enumerate() {
            if random.chance(if number < 6 || number == REAL_INPUTS { density } else { 0.3 * density }) {
                amplitudes.insert(name.clone(), draw_amplitude(random, number));
            }
        }
        let every = random.pick(&[1, 5, 20, 60]);
        Some(Attacker {
            aim: random.pick(&[Aim::Room, Aim::Speed, Aim::Stop]),
            every: every * 2,
            ahead: every * random.pick(&[1, 2, 5]),
            tries: random.pick(&[2, 4, 6]),
            seed: random.seed(),
            amplitudes,
        })
    }

    /// A rest in a tenth of the episodes, on machines of which the time on the way home is known.
    ///
    /// Before it, the filters and strategies get their default parameters, and the safety limits
    /// values with which a way takes seconds. The time that preaction needs to end a braking force
    /// has no bound.
    fn draw_rest(&self, random: &mut Random, machine: &Values) -> Option<Rest> {
        let longest = machine.get("solver.maxStep").copied().unwrap_or(1e-3);
        let preacts = machine.get("preaction").is_some_and(|&preaction| preaction == PREACTION_ON);
        if REST_TIME / longest > MOST_INTERNAL_STEPS_OF_A_REST || preacts || !random.chance(0.1) {
            return None;
        }
        let mut parameters = Values::new();
        let pace = random.pick(&[0.0, 5.0]);
        for (slot, _, name) in self.variables.parameters(Variability::Tunable) {
            let value = match name.as_str() {
                "softLimit.pace" => pace,
                _ if !name.starts_with("safety.") => self.variables.start(slot),
                _ if name.ends_with("positionLimit") => random.log_between(0.02, 0.3),
                _ if name.ends_with("velocityLimit") => random.log_between(0.1, 3.0),
                _ if name.ends_with("accelerationLimit") => random.log_between(0.3, 30.0),
                _ => continue,
            };
            parameters.insert(name, value);
        }
        let step = (longest * random.pick(&[1.0, 7.3, 30.0])).min(LONGEST_STEP);
        Some(Rest { count: (REST_TIME / step) as usize, step, engaged: random.chance(0.7), parameters })
    }

    fn draw_steps(&self, random: &mut Random, machine: &Values) -> Steps {
        let longest = machine.get("solver.maxStep").copied().unwrap_or(1e-3);
        let most = (longest * LONGEST_INTERNAL_STEPS).min(LONGEST_STEP);
        match random.below(10) {
            0 | 1 => Steps::Even { length: longest },
            2..=4 => Steps::Even { length: (longest * random.log_between(0.2, 1.0)).max(SHORTEST_STEP) },
            5 | 6 => Steps::Even { length: random.log_between(longest, most) },
            kind => {
                let shortest = random.log_between(SHORTEST_STEP, longest);
                let longest = random.log_between(longest, most).max(2.0 * shortest);
                let held = if kind == 7 { 1 } else { random.integer(2, 300) };
                Steps::Irregular { shortest, longest, held, seed: random.seed() }
            }
        }
    }

    fn draw_inputs(
        &self,
        random: &mut Random,
        machine: &Values,
        length: f64,
        count: usize,
    ) -> BTreeMap<String, Signal> {
        // The axes along which anything is excited; one alone in a third of the cases.
        let density = random.pick(&[0.15, 0.5, 0.9]);
        let hostile = random.chance(0.05);
        let loud = random.pick(&[1.0, 1.0, 10.0]);
        let mut inputs = BTreeMap::new();
        for (number, name) in self.inputs.iter().enumerate() {
            if !random.chance(if number < 6 { density } else { 0.5 * density }) {
                continue;
            }
            let loudness = if number < 6 { loud } else { 1.0 };
            let amplitude = draw_amplitude(random, number) * loudness;
            let frequency = self.draw_frequency(random, machine, number);
            let signal = if number == REAL_INPUTS && random.chance(0.5) {
                draw_toggles(random)
            } else {
                draw_signal(random, amplitude, frequency, length, count, hostile)
            };
            inputs.insert(name.clone(), signal);
        }
        inputs
    }

    /// A frequency for this input: near a break frequency of its channel, or anything.
    fn draw_frequency(&self, random: &mut Random, machine: &Values, number: usize) -> f64 {
        let (channel, axis) = match number {
            0..=2 => ("splitter", ["x", "y", "z"][number]),
            3..=5 => ("angular", ["roll", "pitch", "yaw"][number - 3]),
            _ => ("splitter", random.pick(&["x", "y", "z"])),
        };
        if random.chance(0.3) {
            return random.log_between(0.3, 100.0);
        }
        let name = format!("{channel}.{axis}.{}", random.pick(&["omega1", "omega2"]));
        let start = self.variables.slot(&name).map_or(1.0, |slot| self.variables.start(slot));
        machine.get(&name).copied().unwrap_or(start).clamp(0.1, 300.0) * random.log_between(0.7, 1.4)
    }

    fn draw_events(&self, random: &mut Random, machine: &Values, count: usize) -> Vec<Event> {
        let mut events = Vec::new();
        if random.chance(0.4) {
            return events;
        }
        let mut safety = self.safety(machine);
        let most = random.pick(&[1, 3, 8]);
        for _ in 0..random.integer(1, most) {
            let before = random.below(count);
            let longest = random.pick(&[1, 10, 300]);
            let after = random.integer(before, (before + longest).min(count - 1));
            match random.below(8) {
                0..=2 => self.tighten_and_loosen(random, &mut safety, [before, after], &mut events),
                3 => {
                    let values = self.machines.draw_tunables(random, 1.0);
                    events.push(Event { before, action: Action::Set(values) });
                }
                4 | 5 => {
                    let probability = random.pick(&[0.2, 0.5]);
                    let values = self.machines.draw_tunables(random, probability);
                    events.push(Event { before, action: Action::Set(values) });
                }
                6 => {
                    let tunables: Vec<_> = self.variables.parameters(Variability::Tunable).collect();
                    let (slot, row, name) = &tunables[random.below(tunables.len())];
                    let value = self.machines.value(random, *slot, row, name);
                    let values = Values::from([(name.clone(), value)]);
                    events.push(Event { before, action: Action::Set(values) });
                }
                _ => {
                    let scope = random.pick(&[Scope::Memory, Scope::Bytes]);
                    events.push(Event { before, action: Action::Save(scope) });
                    events.push(Event { before: after, action: Action::Restore(scope) });
                }
            }
        }
        events.sort_by_key(|event| event.before);
        events
    }

    /// Some safety limits, reduced by up to four orders of magnitude and restored a while later.
    fn tighten_and_loosen(
        &self,
        random: &mut Random,
        safety: &mut Values,
        [before, after]: [usize; 2],
        events: &mut Vec<Event>,
    ) {
        let (mut tight, mut loose) = (Values::new(), Values::new());
        let density = random.pick(&[0.1, 0.4, 1.0]);
        let most = random.pick(&[0.5, 0.01, 1e-4]);
        for (name, value) in safety.iter_mut() {
            if !random.chance(density) {
                continue;
            }
            let (low, high) = self.variables.range(name);
            tight.insert(name.clone(), (*value * random.log_between(most, 1.0)).clamp(low, high));
            *value = (*value * random.pick(&[0.7, 1.0, 1.0, 3.0])).clamp(low, high);
            loose.insert(name.clone(), *value);
        }
        events.push(Event { before, action: Action::Set(tight) });
        if random.chance(0.6) {
            events.push(Event { before: after, action: Action::Set(loose) });
        }
    }

    /// All safety limits of a machine.
    fn safety(&self, machine: &Values) -> Values {
        let limits = self.variables.parameters(Variability::Tunable).filter(|(_, _, name)| name.starts_with("safety."));
        limits
            .map(|(slot, _, name)| {
                let value = machine.get(&name).copied().unwrap_or(self.variables.start(slot));
                (name, value)
            })
            .collect()
    }
}

/// An amplitude for an input by its number.
fn draw_amplitude(random: &mut Random, number: usize) -> f64 {
    match number {
        0..=2 => random.log_between(0.5, 30.0),
        3..=5 => random.log_between(0.05, 20.0),
        6..=8 => random.log_between(0.02, 3.2),
        9 => random.log_between(0.1, 100.0),
        10 => random.log_between(0.02, 1.6),
        _ => 1.0,
    }
}

/// The washout engaged and disengaged at hostile moments: fast, at an end, at speed.
fn draw_toggles(random: &mut Random) -> Signal {
    let amplitude = random.pick(&[-1.0, 1.0]);
    match random.below(3) {
        0 => Signal::Flips { amplitude, held: random.pick(&[1, 3, 30]), seed: random.seed() },
        1 => Signal::AtEnd { amplitude, room: random.log_between(1e-3, 0.3) },
        _ => Signal::AtSpeed { amplitude, fraction: random.between(0.3, 1.0) },
    }
}

/// Previews in most episodes of the predictive strategy, which alone uses them, and in a few
/// others.
fn draw_previews(random: &mut Random, machine: &Values) -> Option<Previews> {
    let predictive = machine.get("strategy").is_some_and(|&kind| kind == PREDICTIVE);
    if !random.chance(if predictive { 0.8 } else { 0.02 }) {
        return None;
    }
    use Forces::{Ahead, Alternating, Contrary, Jump, Noise, NonFinite};
    Some(Previews {
        forces: random.pick(&[Ahead, Contrary, Noise, Alternating, Jump, NonFinite]),
        amplitude: random.log_between(0.1, 1e3),
        count: random.pick(&[[20, 20], [0, 20], [1, 2], [-3, 30], [5, 5]]),
        step: random.pick(&[[0.2, 0.2], [0.01, 10.0], [1e-3, 0.02], [5.0, 20.0], [1e-9, 1e9]]),
        held: random.pick(&[1, 1, 7, 200]),
        seed: random.seed(),
    })
}

fn draw_signal(
    random: &mut Random,
    amplitude: f64,
    frequency: f64,
    length: f64,
    count: usize,
    hostile: bool,
) -> Signal {
    let sign = if random.chance(0.5) { 1.0 } else { -1.0 };
    let phase = if random.chance(0.5) { 0.0 } else { random.between(0.0, 6.3) };
    if hostile && random.chance(0.5) {
        return Signal::NonFinite { held: random.pick(&[1, 30, 300]), seed: random.seed() };
    }
    match random.below(13) {
        0..=3 => Signal::Square { amplitude, frequency, phase },
        4 => Signal::Sine { amplitude, frequency, phase },
        5 => {
            let duration = length * count as f64;
            Signal::Chirp { amplitude, frequency: 0.1 * frequency, rate: 4.0 * frequency / duration }
        }
        6 => {
            let period = random.integer(2, 1 + count / 2);
            Signal::Impulses { amplitude: sign * amplitude, period, width: random.integer(1, period) }
        }
        7 => Signal::Held { value: sign * amplitude },
        8 => Signal::Noise { amplitude, held: random.pick(&[1, 10, 200]), seed: random.seed() },
        9 => Signal::Flips { amplitude, held: random.pick(&[1, 10, 200]), seed: random.seed() },
        10 => {
            let amplitude = sign * amplitude;
            let fraction = random.log_between(1e-3, 1.0);
            random.pick(&[
                Signal::AtEnd { amplitude, room: fraction },
                Signal::AtSpeed { amplitude, fraction: 1.0 - fraction },
            ])
        }
        11 => Signal::Ramp { rate: sign * amplitude * random.log_between(0.1, 3.0) },
        _ => Signal::Pushing { amplitude: sign * amplitude, velocity: random.below(VELOCITIES) },
    }
}
