//! Random episodes on a machine: inputs that excite it, steps, and changes on the way.

use moris_interface::Variability;

use crate::episode::{Action, Episode, Event, Scope, Steps, Values};
use crate::machine::Machines;
use crate::random::Random;
use crate::signal::{Signal, VELOCITIES};
use crate::variables::Variables;

/// Largest number of steps of an episode, and largest mean number of internal steps in a step.
const MOST_STEPS: usize = 4000;
const MOST_INTERNAL_STEPS: f64 = 12.0;
/// The shortest and the longest communication step \[s\].
const SHORTEST_STEP: f64 = 1e-6;
const LONGEST_STEP: f64 = 0.1;

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
            events: self.draw_events(random, machine, count),
        }
    }

    fn draw_steps(&self, random: &mut Random, machine: &Values) -> Steps {
        let longest = machine.get("solver.maxStep").copied().unwrap_or(1e-3);
        let most = (longest * MOST_INTERNAL_STEPS).min(LONGEST_STEP);
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
    ) -> std::collections::BTreeMap<String, Signal> {
        // The axes along which anything is excited; one alone in a third of the cases.
        let density = random.pick(&[0.15, 0.5, 0.9]);
        let hostile = random.chance(0.05);
        let loud = random.pick(&[1.0, 1.0, 10.0]);
        let mut inputs = std::collections::BTreeMap::new();
        for (number, name) in self.inputs.iter().enumerate() {
            if !random.chance(if number < 6 { density } else { 0.5 * density }) {
                continue;
            }
            let amplitude = match number {
                0..=2 => random.log_between(0.5, 30.0) * loud,
                3..=5 => random.log_between(0.05, 20.0) * loud,
                6..=8 => random.log_between(0.02, 3.2),
                9 => random.log_between(0.1, 100.0),
                10 => random.log_between(0.02, 1.6),
                _ => 1.0,
            };
            let frequency = self.draw_frequency(random, machine, number);
            inputs.insert(name.clone(), draw_signal(random, amplitude, frequency, length, count, hostile));
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
    match random.below(12) {
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
        10 => Signal::Ramp { rate: sign * amplitude * random.log_between(0.1, 3.0) },
        _ => Signal::Pushing { amplitude: sign * amplitude, velocity: random.below(VELOCITIES) },
    }
}
