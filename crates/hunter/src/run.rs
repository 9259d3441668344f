//! Running an episode under the oracle's eyes.

use anyhow::Result;

use crate::episode::{Action, Episode, Values};
use crate::oracle::{Breach, Machine, Oracle, Safety, Worst};
use crate::signal::{Signal, VELOCITIES};
use crate::target::{Inputs, Target};
use crate::variables::{REAL_INPUTS, Variables};

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
    longest_step: usize,
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
            longest_step: slot("solver.maxStep")?,
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
        let neutral_height = slots[self.neutral_height];
        let signals = self.signals(episode)?;
        let mut sample = target.sample(neutral_height);
        let mut oracle = Oracle::new(self.machine(&slots), &self.safety(&slots), &sample);
        let mut outcome = Outcome::default();
        let mut saved: [Option<(Oracle, Vec<f64>)>; 2] = [None, None];
        let mut events = episode.events.iter().peekable();
        let mut time = 0.0;
        for step in 0..episode.count {
            while let Some(event) = events.next_if(|event| event.before <= step) {
                match &event.action {
                    Action::Set(values) => {
                        let before = slots.clone();
                        self.variables.overlay(&mut slots, values)?;
                        let differ: Vec<usize> = (0..slots.len()).filter(|&i| slots[i] != before[i]).collect();
                        if target.set(&slots, &differ) {
                            oracle.change(&self.safety(&slots));
                        } else {
                            slots = before;
                        }
                    }
                    Action::Save(scope) => {
                        target.save(*scope)?;
                        saved[*scope as usize] = Some((oracle, slots.clone()));
                    }
                    Action::Restore(scope) => {
                        if let Some((then, values)) = &saved[*scope as usize] {
                            target.restore(*scope)?;
                            oracle = *then;
                            slots.clone_from(values);
                        }
                    }
                }
            }
            let length = episode.steps.length(step);
            let velocities = velocities(&sample);
            let start = self.input(&signals, step, time, &velocities);
            let end = episode.linear.then(|| self.input(&signals, step + 1, time + length, &velocities));
            target.step(&start, end.as_ref(), length)?;
            time += length;
            sample = target.sample(neutral_height);
            outcome.steps += 1;
            if let Err(breach) = oracle.check(&sample, length, &mut outcome.worst) {
                outcome.breach = Some(Breach { step, ..breach });
                break;
            }
        }
        Ok(outcome)
    }

    fn signals(&self, episode: &Episode) -> Result<[Signal; REAL_INPUTS + 1]> {
        let mut signals = [Signal::ZERO; REAL_INPUTS + 1];
        for (name, signal) in &episode.inputs {
            let place = self.input_names().position(|input| input == name);
            signals[place.ok_or_else(|| anyhow::anyhow!("{name} is no input of the washout"))?] = *signal;
        }
        Ok(signals)
    }

    #[inline]
    fn input(
        &self,
        signals: &[Signal; REAL_INPUTS + 1],
        step: usize,
        time: f64,
        velocities: &[f64; VELOCITIES],
    ) -> Inputs {
        Inputs {
            reals: std::array::from_fn(|k| self.inputs[k].1 + signals[k].value(step, time, velocities)),
            engaged: signals[REAL_INPUTS].value(step, time, velocities) >= 0.0,
        }
    }

    fn machine(&self, slots: &[f64]) -> Machine {
        let farthest = |begin: usize| {
            let distance = |joint: &[f64]| joint.iter().map(|x| x * x).sum::<f64>().sqrt();
            slots[begin..begin + 18].chunks(3).map(distance).fold(0.0, f64::max)
        };
        let [base, radius] = self.geometry.map(farthest);
        Machine {
            stroke: self.stroke.map(|slot| slots[slot]),
            velocity: slots[self.leg_velocity],
            acceleration: slots[self.leg_acceleration],
            radius,
            size: base + radius + slots[self.neutral_height],
            longest_step: slots[self.longest_step],
        }
    }

    fn safety(&self, slots: &[f64]) -> Safety {
        let [position, velocity, acceleration] = self.safety.map(|limit| limit.map(|slot| slots[slot]));
        Safety { position, velocity, acceleration }
    }
}

fn velocities(sample: &crate::oracle::Sample) -> [f64; VELOCITIES] {
    let mut velocities = [0.0; VELOCITIES];
    velocities[..3].copy_from_slice(&sample.velocity);
    velocities[3..6].copy_from_slice(&sample.angular_velocity);
    velocities[6..].copy_from_slice(&sample.leg_velocity);
    velocities
}
