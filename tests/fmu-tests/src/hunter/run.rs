//! Running an episode under the oracle's eyes.

use anyhow::{Context, Result};
use moris_washout::Preview;
use moris_washout::interface::GravityRemoval;

use super::attacker::Attacker;
use super::episode::{Action, Episode, Rest, SCOPES, Scope, Values};
use super::oracle::{Breach, MachineLimits, NEUTRAL_TOLERANCE, Oracle, Quantity, Safety, Sample, Worst};
use super::reach::Reach;
use super::signal::{Seen, Signal, VELOCITIES};
use super::target::{Inputs, Target};
use super::variables::{REAL_INPUTS, Variables};

/// Result of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Communication steps made.
    pub steps: usize,
    /// The first breach.
    pub breach: Option<Breach>,
    /// The worst of each quantity.
    pub worst: Worst,
}

/// The place of the vertical specific force among the inputs.
const VERTICAL_FORCE: usize = 2;

/// Where the variables are that a run needs beside those of an episode.
pub struct Runner {
    variables: Variables,
    /// Names of the inputs and their start values, the real ones first.
    inputs: Vec<(String, f64)>,
    geometry: [usize; 2],
    neutral_height: usize,
    stroke: [usize; 2],
    leg_velocity: usize,
    leg_acceleration: usize,
    max_step: usize,
    gravity: usize,
    gravity_removal: usize,
    safety: [[usize; 3]; 3],
}

impl Runner {
    /// Finds the variables.
    ///
    /// # Errors
    /// The washout's interface lacks a variable.
    pub fn new() -> Result<Self> {
        let variables = Variables::new();
        let slot = |name: &str| variables.slot(name);
        let safety = |limit: &str| -> Result<[usize; 3]> {
            let [x, y, z] = ["x", "y", "z"].map(|axis| variables.slot(&format!("safety.{axis}.{limit}")));
            Ok([x?, y?, z?])
        };
        Ok(Runner {
            geometry: [slot("rig.base[1].x")?, slot("rig.platform[1].x")?],
            neutral_height: slot("rig.neutralHeight")?,
            stroke: [slot("actuator.minLength")?, slot("actuator.maxLength")?],
            leg_velocity: slot("actuator.velocityLimit")?,
            leg_acceleration: slot("actuator.accelerationLimit")?,
            max_step: slot("solver.maxStep")?,
            gravity: slot("gravity")?,
            gravity_removal: slot("gravityRemoval")?,
            safety: [safety("positionLimit")?, safety("velocityLimit")?, safety("accelerationLimit")?],
            inputs: variables.inputs(),
            variables,
        })
    }

    /// The washout's variables.
    pub fn variables(&self) -> &Variables {
        &self.variables
    }

    /// Names of the inputs, the real ones first.
    pub fn input_names(&self) -> impl Iterator<Item = &str> {
        self.inputs.iter().map(|(name, _)| name.as_str())
    }

    /// Makes a machine of these parameters.
    ///
    /// # Errors
    /// The machine is refused, or a name is no variable's.
    pub fn make(&self, parameters: &Values, target: &mut impl Target) -> Result<()> {
        target.make(&self.variables.values(parameters)?)
    }

    /// Runs an episode on its machine until its end or the first breach.
    ///
    /// # Errors
    /// A valid call is refused, or a name in the episode is not that of a variable.
    pub fn run<T: Target>(&self, episode: &Episode, target: &mut T) -> Result<Outcome> {
        target.rewind();
        let mut slots = self.variables.values(&episode.parameters)?;
        let mut drive = self.drive(episode, &slots)?;
        let at_rest = target.sample(drive.neutral_height);
        let mut moment = Moment {
            step: 0,
            time: 0.0,
            sample: at_rest,
            oracle: Oracle::new(drive.machine, &drive.safety, &at_rest),
            worst: Worst::default(),
        };
        let mut saved: [Option<(Oracle, Vec<f64>)>; SCOPES] = Default::default();
        let mut events = episode.events.iter().peekable();
        let mut breach = None;
        while breach.is_none() && moment.step < episode.count {
            while let Some(event) = events.next_if(|event| event.before <= moment.step) {
                match &event.action {
                    Action::Set(values) => self.set(values, &mut slots, &mut drive, &mut moment.oracle, target)?,
                    Action::Save(scope) => {
                        target.save(*scope)?;
                        saved[*scope as usize] = Some((moment.oracle, slots.clone()));
                    }
                    Action::Restore(scope) => {
                        if let Some((then, values)) = &saved[*scope as usize] {
                            target.restore(*scope)?;
                            moment.oracle = *then;
                            slots.clone_from(values);
                            drive.safety = self.safety(&slots);
                        }
                    }
                }
            }
            drive.choose(&moment, target)?;
            breach = drive.step(&mut moment, target)?;
        }
        if let Some(rest) = episode.rest.as_ref().filter(|_| breach.is_none()) {
            self.set(&rest.parameters, &mut slots, &mut drive, &mut moment.oracle, target)?;
            breach = drive.rest(rest, &self.inputs_at_rest(rest, &slots), &at_rest, &mut moment, target)?;
        }
        Ok(Outcome { steps: moment.step, breach, worst: moment.worst })
    }

    /// Sets tunable parameters, unless the target refuses them.
    fn set<T: Target>(
        &self,
        values: &Values,
        slots: &mut Vec<f64>,
        drive: &mut Drive,
        oracle: &mut Oracle,
        target: &mut T,
    ) -> Result<()> {
        let before = slots.clone();
        self.variables.overlay(slots, values)?;
        let differ: Vec<usize> = (0..slots.len()).filter(|&i| slots[i] != before[i]).collect();
        if target.set(slots, &differ) {
            drive.safety = self.safety(slots);
            oracle.change(&drive.safety);
        } else {
            *slots = before;
        }
        Ok(())
    }

    /// Settings of an episode's steps, on a machine of these parameters.
    fn drive<'a>(&'a self, episode: &'a Episode, slots: &[f64]) -> Result<Drive<'a>> {
        let signals = self.signals(episode)?;
        let attacker = episode.attacker.as_ref().map(|attacker| self.attack(attacker)).transpose()?;
        Ok(Drive {
            runner: self,
            episode,
            follows_reach: signals.iter().any(Signal::follows_reach),
            signals,
            neutral_height: slots[self.neutral_height],
            machine: self.machine(slots),
            safety: self.safety(slots),
            attack: attacker,
        })
    }

    fn attack<'a>(&self, attacker: &'a Attacker) -> Result<Attack<'a>> {
        let places = attacker.amplitudes.iter().map(|(name, amplitude)| Ok((self.place(name)?, *amplitude)));
        Ok(Attack { attacker, places: places.collect::<Result<_>>()?, choice: Choice::default(), until: 0 })
    }

    /// The inputs that ask for no motion.
    fn inputs_at_rest(&self, rest: &Rest, slots: &[f64]) -> Inputs {
        let mut reals = std::array::from_fn(|k| self.inputs[k].1);
        let none = f64::from(GravityRemoval::None as i32 + 1);
        reals[VERTICAL_FORCE] = if slots[self.gravity_removal] == none { 0.0 } else { slots[self.gravity] };
        Inputs { reals, engaged: rest.engaged }
    }

    /// The place of an input among all.
    fn place(&self, name: &str) -> Result<usize> {
        let place = self.input_names().position(|input| input == name);
        place.with_context(|| format!("{name} is no input of the washout"))
    }

    fn signals(&self, episode: &Episode) -> Result<[Signal; REAL_INPUTS + 1]> {
        let mut signals = [Signal::ZERO; REAL_INPUTS + 1];
        for (name, signal) in &episode.inputs {
            signals[self.place(name)?] = *signal;
        }
        Ok(signals)
    }

    fn machine(&self, slots: &[f64]) -> MachineLimits {
        let farthest = |begin: usize| {
            let distance = |joint: &[f64]| joint.iter().map(|x| x * x).sum::<f64>().sqrt();
            slots[begin..begin + 18].chunks(3).map(distance).fold(0.0, f64::max)
        };
        let [base, radius] = self.geometry.map(farthest);
        MachineLimits {
            stroke: self.stroke.map(|slot| slots[slot]),
            velocity: slots[self.leg_velocity],
            acceleration: slots[self.leg_acceleration],
            radius,
            size: base + radius + slots[self.neutral_height].abs(),
            max_step: slots[self.max_step],
        }
    }

    fn safety(&self, slots: &[f64]) -> Safety {
        let [position, velocity, acceleration] = self.safety.map(|limit| limit.map(|slot| slots[slot]));
        Safety { position, velocity, acceleration }
    }
}

/// An episode under way: its machine, its inputs and who chooses them.
struct Drive<'a> {
    runner: &'a Runner,
    episode: &'a Episode,
    signals: [Signal; REAL_INPUTS + 1],
    follows_reach: bool,
    neutral_height: f64,
    machine: MachineLimits,
    safety: Safety,
    attack: Option<Attack<'a>>,
}

/// An attacker with what it has chosen.
struct Attack<'a> {
    attacker: &'a Attacker,
    /// Places and amplitudes of the inputs.
    places: Vec<(usize, f64)>,
    choice: Choice,
    /// The step before which it chooses next.
    until: usize,
}

/// The inputs that an attacker sets, instead of the signals.
type Choice = [Option<f64>; REAL_INPUTS + 1];

/// A point of an episode.
#[derive(Clone, Copy)]
struct Moment {
    step: usize,
    time: f64,
    sample: Sample,
    oracle: Oracle,
    worst: Worst,
}

impl Drive<'_> {
    /// Makes the next step, and judges it.
    #[inline]
    fn step<T: Target>(&self, moment: &mut Moment, target: &mut T) -> Result<Option<Breach>> {
        let (step, time) = (moment.step, moment.time);
        let length = self.episode.steps.length(step);
        let seen = self.seen(&moment.sample);
        if let Some(previews) = &self.episode.preview {
            let ahead = |delay: f64| {
                let number = step + (delay / length).clamp(0.0, 1e6) as usize;
                [0, 1].map(|k| self.signals[k].value(number, time + delay, &seen))
            };
            target.preview(&previews.at(step, ahead));
        }
        let start = self.inputs(step, time, &seen);
        let end = self.episode.linear.then(|| self.inputs(step + 1, time + length, &seen));
        self.judged(&start, end.as_ref(), length, moment, target)
    }

    fn judged<T: Target>(
        &self,
        start: &Inputs,
        end: Option<&Inputs>,
        length: f64,
        moment: &mut Moment,
        target: &mut T,
    ) -> Result<Option<Breach>> {
        target.step(start, end, length)?;
        let step = moment.step;
        moment.step += 1;
        moment.time += length;
        moment.sample = target.sample(self.neutral_height);
        let judgement = moment.oracle.check(&moment.sample, length, &mut moment.worst);
        Ok(judgement.err().map(|breach| Breach { step, ..breach }))
    }

    #[inline]
    fn inputs(&self, step: usize, time: f64, seen: &Seen) -> Inputs {
        let chosen = |k: usize| self.attack.as_ref().and_then(|attack| attack.choice[k]);
        let value = |k: usize| chosen(k).unwrap_or_else(|| self.signals[k].value(step, time, seen));
        Inputs {
            reals: std::array::from_fn(|k| self.runner.inputs[k].1 + value(k)),
            engaged: value(REAL_INPUTS) >= 0.0,
        }
    }

    fn seen(&self, sample: &Sample) -> Seen {
        let mut velocities = [0.0; VELOCITIES];
        velocities[..3].copy_from_slice(&sample.velocity);
        velocities[3..6].copy_from_slice(&sample.angular_velocity);
        velocities[6..].copy_from_slice(&sample.leg_velocity);
        Seen { velocities, reach: self.follows_reach.then(|| Reach::of(sample, &self.machine, &self.safety)) }
    }

    /// Lets an attacker choose its inputs, if it is time to.
    fn choose<T: Target>(&mut self, moment: &Moment, target: &mut T) -> Result<()> {
        let Some(mut attack) = self.attack.take_if(|attack| attack.until <= moment.step) else { return Ok(()) };
        let Attacker { aim, every, ahead, tries, .. } = *attack.attacker;
        let mut best = (f64::NEG_INFINITY, Choice::default(), 1);
        target.save(Scope::Trial)?;
        for trial in 0..tries {
            let mut choice = Choice::default();
            for &(input, amplitude) in &attack.places {
                choice[input] = Some(amplitude * attack.attacker.sign(moment.step, trial, input));
            }
            self.attack = Some(Attack { choice, places: vec![], ..attack });
            let (mut then, mut score) = (*moment, f64::NEG_INFINITY);
            for _ in 0..ahead {
                let breach = self.step(&mut then, target)?;
                score = score.max(aim.score(&Reach::of(&then.sample, &self.machine, &self.safety)));
                if breach.is_some() {
                    score = f64::INFINITY;
                    break;
                }
            }
            target.restore(Scope::Trial)?;
            if score > best.0 {
                best = (score, choice, if score == f64::INFINITY { ahead } else { every });
            }
        }
        (attack.choice, attack.until) = (best.1, moment.step + best.2.max(1));
        self.attack = Some(attack);
        Ok(())
    }

    /// Rests until the platform is at neutral, as `at_rest` shows it.
    fn rest<T: Target>(
        &self,
        rest: &Rest,
        inputs: &Inputs,
        at_rest: &Sample,
        moment: &mut Moment,
        target: &mut T,
    ) -> Result<Option<Breach>> {
        target.preview(&Preview::default());
        for number in 0..rest.count {
            if distance(&moment.sample, at_rest) <= NEUTRAL_TOLERANCE {
                let taken = &mut moment.worst[Quantity::NotNeutral as usize];
                *taken = taken.max(number as f64 / rest.count as f64);
                return Ok(None);
            }
            let breach = self.judged(inputs, None, rest.step, moment, target)?;
            if breach.is_some() {
                return Ok(breach);
            }
        }
        let value = distance(&moment.sample, at_rest);
        let breach =
            Breach { step: moment.step - 1, quantity: Quantity::NotNeutral, index: 1, value, limit: NEUTRAL_TOLERANCE };
        Ok((value > NEUTRAL_TOLERANCE).then_some(breach))
    }
}

/// The largest distance of surge, sway, heave and the legs from where they are at rest \[m\].
fn distance(sample: &Sample, at_rest: &Sample) -> f64 {
    let lengths = sample.length.iter().zip(&at_rest.length).map(|(length, neutral)| (length - neutral).abs());
    sample.position.iter().map(|position| position.abs()).chain(lengths).fold(0.0, f64::max)
}
