//! Reduction of an episode that breaks a limit to a short and simple one that also breaks a limit.

use anyhow::Result;

use super::episode::{Action, Episode, Steps};
use super::oracle::{Breach, Quantity};
use super::run::Runner;
use super::signal::Signal;
use super::target::Target;

/// Largest number of runs for shrinking.
const MOST_RUNS: usize = 4000;

/// The shortest and simplest episode found, with its breach. A change is kept if the episode still
/// breaks a limit of any quantity, in no more steps.
///
/// # Errors
/// As [`Runner::run`].
pub fn shrink<T: Target>(
    runner: &Runner,
    target: &mut T,
    episode: &Episode,
    breach: Breach,
) -> Result<(Episode, Breach)> {
    let best = cut(episode.clone(), &breach);
    let mut shrinker = Shrinker { runner, target, best, breach, runs: MOST_RUNS };
    shrinker.target_is_best()?;
    loop {
        let before = shrinker.best.clone();
        shrinker.drop_attacks()?;
        shrinker.cut_before_rest()?;
        shrinker.drop_parameters_of_rest()?;
        shrinker.drop_events()?;
        shrinker.drop_inputs()?;
        shrinker.drop_parameters()?;
        shrinker.simplify_steps()?;
        shrinker.simplify_signals()?;
        shrinker.round_numbers()?;
        if shrinker.best == before || shrinker.runs == 0 {
            return Ok((shrinker.best, shrinker.breach));
        }
    }
}

struct Shrinker<'a, T> {
    runner: &'a Runner,
    target: &'a mut T,
    best: Episode,
    breach: Breach,
    runs: usize,
}

impl<T: Target> Shrinker<'_, T> {
    fn target_is_best(&mut self) -> Result<()> {
        self.runner.make(&self.best.parameters, self.target)
    }

    /// Accepts the candidate if it breaks a limit. A candidate that cannot be run is not accepted.
    fn accepts(&mut self, candidate: Episode) -> Result<bool> {
        if self.runs == 0 || candidate == self.best {
            return Ok(false);
        }
        self.runs -= 1;
        let other_machine = candidate.parameters != self.best.parameters;
        if other_machine && self.runner.make(&candidate.parameters, self.target).is_err() {
            self.target_is_best()?;
            return Ok(false);
        }
        let breach = self.runner.run(&candidate, self.target).ok().and_then(|outcome| outcome.breach);
        if let Some(breach) = breach {
            self.best = cut(candidate, &breach);
            self.breach = breach;
        } else if other_machine {
            self.target_is_best()?;
        }
        Ok(breach.is_some())
    }

    fn drop_attacks(&mut self) -> Result<()> {
        self.accepts(Episode { attacker: None, ..self.best.clone() })?;
        self.accepts(Episode { preview: None, ..self.best.clone() })?;
        self.accepts(Episode { rest: None, ..self.best.clone() })?;
        for fraction in [0.01, 0.1, 0.5, 0.8] {
            let mut candidate = self.best.clone();
            if let Some(rest) = &mut candidate.rest {
                rest.count = (fraction * rest.count as f64) as usize;
            }
            if self.breach.quantity != Quantity::NotNeutral {
                self.accepts(candidate)?;
            }
        }
        Ok(())
    }

    /// Fewer parameters set before a rest.
    fn drop_parameters_of_rest(&mut self) -> Result<()> {
        let mut size = self.best.rest.as_ref().map_or(0, |rest| rest.parameters.len());
        while size > 0 {
            let Some(rest) = &self.best.rest else { break };
            let names: Vec<String> = rest.parameters.keys().cloned().collect();
            for group in names.chunks(size) {
                let mut candidate = self.best.clone();
                let Some(rest) = &mut candidate.rest else { break };
                rest.parameters.retain(|name, _| !group.contains(name));
                self.accepts(candidate)?;
            }
            size /= 2;
        }
        Ok(())
    }

    /// Fewer steps before a rest. The breach tells their number only if it comes before the rest.
    fn cut_before_rest(&mut self) -> Result<()> {
        for fraction in [0.0, 0.1, 0.3, 0.5, 0.7, 0.9] {
            if self.best.rest.is_some() {
                let count = (fraction * self.best.count as f64) as usize;
                self.accepts(Episode { count, ..self.best.clone() })?;
            }
        }
        Ok(())
    }

    fn drop_events(&mut self) -> Result<()> {
        self.accepts(Episode { events: vec![], ..self.best.clone() })?;
        for i in (0..self.best.events.len()).rev() {
            let mut candidate = self.best.clone();
            if i < candidate.events.len() {
                candidate.events.remove(i);
                self.accepts(candidate)?;
            }
        }
        for i in 0..self.best.events.len() {
            let Some(Action::Set(values)) = self.best.events.get(i).map(|event| event.action.clone()) else { continue };
            for name in values.keys() {
                let mut candidate = self.best.clone();
                if let Some(Action::Set(values)) = candidate.events.get_mut(i).map(|event| &mut event.action) {
                    values.remove(name);
                    self.accepts(candidate)?;
                }
            }
        }
        for i in 0..self.best.events.len() {
            for fraction in [0.0, 0.5, 0.8, 0.95] {
                let mut candidate = self.best.clone();
                let Some(event) = candidate.events.get_mut(i) else { break };
                event.before = (fraction * event.before as f64) as usize;
                candidate.events.sort_by_key(|event| event.before);
                if self.accepts(candidate)? {
                    break;
                }
            }
        }
        Ok(())
    }

    fn drop_inputs(&mut self) -> Result<()> {
        for name in self.best.inputs.keys().cloned().collect::<Vec<_>>() {
            let mut candidate = self.best.clone();
            candidate.inputs.remove(&name);
            self.accepts(candidate)?;
        }
        Ok(())
    }

    /// Drops the geometry as a whole, and the other parameters in groups, each half as
    /// large as those before.
    fn drop_parameters(&mut self) -> Result<()> {
        let mut candidate = self.best.clone();
        candidate.parameters.retain(|name, _| !is_geometry(name));
        self.accepts(candidate)?;
        let mut size = self.best.parameters.len();
        while size > 0 {
            let names: Vec<String> = self.best.parameters.keys().filter(|name| !is_geometry(name)).cloned().collect();
            for group in names.chunks(size) {
                let mut candidate = self.best.clone();
                candidate.parameters.retain(|name, _| !group.contains(name));
                self.accepts(candidate)?;
            }
            size /= 2;
        }
        Ok(())
    }

    fn simplify_steps(&mut self) -> Result<()> {
        self.accepts(Episode { linear: false, ..self.best.clone() })?;
        if let Steps::Irregular { shortest, longest, .. } = self.best.steps {
            for length in [longest, (shortest * longest).sqrt(), shortest, 0.001] {
                self.accepts(Episode { steps: Steps::Even { length }, ..self.best.clone() })?;
            }
        }
        for factor in [10.0, 5.0, 2.0, 1.5] {
            if let Steps::Even { length } = self.best.steps {
                let mut candidate = Episode { steps: Steps::Even { length: factor * length }, ..self.best.clone() };
                for event in &mut candidate.events {
                    event.before = (event.before as f64 / factor).round() as usize;
                }
                self.accepts(candidate)?;
            }
        }
        Ok(())
    }

    fn simplify_signals(&mut self) -> Result<()> {
        for (name, signal) in self.best.inputs.clone() {
            let mut signal = signal;
            let amplitude = signal.numbers().first().map_or(1.0, |number| **number);
            let mut simpler = vec![Signal::Held { value: amplitude }, Signal::Held { value: -amplitude }];
            if let Signal::Square { amplitude, frequency, .. }
            | Signal::Sine { amplitude, frequency, .. }
            | Signal::Chirp { amplitude, frequency, .. } = signal
            {
                simpler.push(Signal::Square { amplitude, frequency, phase: 0.0 });
                simpler.push(Signal::Square { amplitude: -amplitude, frequency, phase: 0.0 });
            }
            if matches!(signal, Signal::Held { .. }) {
                continue;
            }
            for signal in simpler {
                let mut candidate = self.best.clone();
                candidate.inputs.insert(name.clone(), signal);
                if self.accepts(candidate)? {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Rounds every number to the fewest digits with which a limit is still broken.
    fn round_numbers(&mut self) -> Result<()> {
        let count = numbers(&mut self.best.clone()).len();
        for i in 0..count {
            for digits in 1..=4 {
                let mut candidate = self.best.clone();
                let Some(number) = numbers(&mut candidate).into_iter().nth(i) else { break };
                let round = rounded(*number, digits);
                if *number == round {
                    break;
                }
                *number = round;
                if self.accepts(candidate)? {
                    break;
                }
            }
        }
        Ok(())
    }
}

/// The episode without what comes after the breach.
fn cut(mut episode: Episode, breach: &Breach) -> Episode {
    episode.count = episode.count.min(breach.step + 1);
    episode.events.retain(|event| event.before <= breach.step);
    episode
}

/// True if a parameter belongs to the rig's geometry, which changes as a whole
/// and is slow to survey.
pub fn is_geometry(name: &str) -> bool {
    name.starts_with("rig.") || name == "actuator.minLength" || name == "actuator.maxLength"
}

/// Every number of an episode that may be rounded.
fn numbers(episode: &mut Episode) -> Vec<&mut f64> {
    let parameters = episode.parameters.iter_mut().filter(|(name, _)| !is_geometry(name));
    let mut numbers: Vec<&mut f64> = parameters.map(|(_, value)| value).collect();
    numbers.extend(episode.inputs.values_mut().flat_map(Signal::numbers));
    numbers.extend(episode.attacker.iter_mut().flat_map(|attacker| attacker.amplitudes.values_mut()));
    numbers.extend(episode.preview.iter_mut().map(|previews| &mut previews.amplitude));
    numbers.extend(episode.rest.iter_mut().flat_map(|rest| rest.parameters.values_mut()));
    for event in &mut episode.events {
        if let Action::Set(values) = &mut event.action {
            numbers.extend(values.values_mut());
        }
    }
    match &mut episode.steps {
        Steps::Even { length } => numbers.push(length),
        Steps::Irregular { shortest, longest, .. } => numbers.extend([shortest, longest]),
    }
    numbers
}

/// The number with `digits` significant digits.
fn rounded(number: f64, digits: usize) -> f64 {
    format!("{number:.*e}", digits - 1).parse().unwrap_or(number)
}
