//! One tuning: a search, and a check of its result in the internal steps that it will be used with.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use moris_setup::Setup;
use moris_washout::Parameters;
use rayon::prelude::*;

use super::cost::{Cost, Objective};
use super::error::TuneError;
use super::search::{Budget, Evaluate, Searched, search};
use super::space::Space;
use crate::texts::text;
use moris_simulation::Simulation;
use moris_simulation::fit::Aims;

/// Tunes on sets of recordings.
pub struct Tuner<'a> {
    /// The rig, and the parameters before.
    pub setup: &'a Setup,
    /// The search space.
    pub space: Space,
    /// Length of each search.
    pub budget: Budget,
    /// Computes the costs of a search.
    pub evaluate: &'a Evaluate<'a>,
    /// Receives the progress of each search: its name, the parameter sets tried, and the least
    /// error so far. Ends the search by returning false.
    pub observe: &'a (dyn Fn(&str, usize, Option<f64>) -> bool + Sync),
    /// Set when the user interrupts the search.
    pub interrupted: Arc<AtomicBool>,
    /// Parameter sets of all searches so far.
    pub tried: AtomicUsize,
    /// Receives this number whenever it changes, within a search with its name and least error as
    /// a text.
    pub show: &'a (dyn Fn(usize, Option<&str>) + Sync),
    /// The best so far of the first search.
    pub so_far: Arc<SoFar>,
}

/// The best parameters so far, for an end at once.
#[derive(Debug, Default)]
pub struct SoFar(Mutex<Option<BestSoFar>>);

/// Parameters that keep the constraints.
#[derive(Clone, Copy, Debug)]
pub struct BestSoFar {
    /// The parameters.
    pub parameters: Parameters,
    /// True if they were simulated with the internal steps that they will be used with.
    pub is_checked: bool,
}

impl SoFar {
    /// The best so far; none before anything keeps the constraints.
    pub fn get(&self) -> Option<BestSoFar> {
        *self.lock()
    }

    /// Notes parameters. Those of later searches, on fewer recordings, do not count.
    pub fn note(&self, parameters: &Parameters, is_checked: bool) {
        let mut best = self.lock();
        if best.is_none_or(|best| !best.is_checked) {
            *best = Some(BestSoFar { parameters: *parameters, is_checked });
        }
    }

    fn lock(&self) -> MutexGuard<'_, Option<BestSoFar>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Tuner<'_> {
    /// True if the user interrupted it.
    pub fn was_interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// The best parameters for these recordings that keep all constraints, also in the internal
    /// steps that they will be used with.
    ///
    /// # Errors
    /// No parameters keep the constraints ([`TuneError::Infeasible`]), or parameters cannot be
    /// used.
    pub fn tune(&self, objectives: &[&Objective], what: &str) -> Result<Setup, TuneError> {
        let begin = self.tried.load(Ordering::Relaxed);
        // The best set has the least cost, but its error may be slightly above an earlier set's.
        let mut least: Option<f64> = None;
        let searched = search(objectives, self.evaluate, &self.space, self.budget, |tried, best| {
            if let Some(best) = best {
                least = Some(least.map_or(best.error, |least| least.min(best.error)));
                self.so_far.note(&best.parameters, false);
            }
            let continues = (self.observe)(what, tried, least);
            let error = least.map_or_else(|| "none fits yet".to_owned(), |error| format!("error {error:.4}"));
            (self.show)(begin + tried.min(self.budget.evaluations), Some(&format!("{what}: {error}")));
            continues && !self.was_interrupted()
        })?;
        self.tried.store(begin + self.budget.evaluations, Ordering::Relaxed);
        (self.show)(begin + self.budget.evaluations, None);
        let before = full_costs(objectives, self.setup)?;
        let mut least_worse = None;
        for parameters in self.candidates(&searched) {
            let tuned = Setup { parameters, parameters_name: "tuned".to_owned(), ..self.setup.clone() };
            let costs = full_costs(objectives, &tuned)?;
            if !costs.iter().all(Cost::is_feasible) {
                continue;
            }
            let worsening = worst_ratio(&before, &costs);
            if worsening <= WORST_RATIO {
                self.so_far.note(&tuned.parameters, true);
                return Ok(tuned);
            }
            if least_worse.as_ref().is_none_or(|(least, _)| worsening < *least) {
                least_worse = Some((worsening, tuned));
            }
        }
        if let Some((_, tuned)) = least_worse {
            self.so_far.note(&tuned.parameters, true);
            return Ok(tuned);
        }
        let nearest = Setup { parameters: searched.nearest, ..self.setup.clone() };
        let violating = self.violating_recordings(objectives, &nearest)?;
        Err(TuneError::Infeasible(text!["infeasible", violating]))
    }

    /// Candidates to verify in the final step size, in this order:
    ///
    /// - the best sets of the search;
    /// - sets between the best and the initial one, and the initial one;
    /// - the best set with its scales reduced step by step.
    fn candidates(&self, searched: &Searched) -> impl Iterator<Item = Parameters> {
        // Fractions of the distance from the start to the best set at which other sets are tried.
        const BACKTRACK_FRACTIONS: [f64; 3] = [0.75, 0.5, 0.25];
        // Factor by which the scales are reduced at a time, and largest number of times: down to a
        // fifth.
        const SCALE_STEP: f64 = 0.95;
        const MAX_TRIES: i32 = 32;
        let best = searched.best.first().map_or(searched.nearest, |found| found.parameters);
        let tries = if self.space.has_scales() { MAX_TRIES } else { 0 };
        let scaled = (1..=tries).map(move |k| self.space.with_scales_times(&best, SCALE_STEP.powi(k)));
        let nearer = searched
            .best
            .first()
            .into_iter()
            .flat_map(|found| BACKTRACK_FRACTIONS.map(|fraction| self.space.towards(&found.parameters, fraction)));
        let found = searched.best.iter().map(|found| found.parameters);
        found.chain(nearer).chain([self.setup.parameters]).collect::<Vec<_>>().into_iter().chain(scaled)
    }

    /// The recordings that violate constraints, and how much, as the end of a sentence.
    fn violating_recordings(&self, objectives: &[&Objective], setup: &Setup) -> Result<String, TuneError> {
        let mut limited = Vec::new();
        for objective in objectives {
            let Cost { violated, comfort: [shake, jolt, peak], excess, .. } = full_cost(objective, setup)?;
            if violated > 0.0 {
                limited.push(format!("{} for {:.2} % of its time", objective.name(), 100.0 * violated));
            }
            if excess > 0.0 {
                limited.push(text!["violating", name = objective.name(), shake, jolt, peak].to_string());
            }
        }
        Ok(if limited.is_empty() {
            String::new()
        } else {
            format!(" (the closest set still violates them: {})", limited.join(", "))
        })
    }
}

/// Largest ratio of a recording's error to the error before at which it does not count as worse.
pub const WORST_RATIO: f64 = 1.05;

/// Costs of recordings, each as by [`full_cost`].
///
/// # Errors
/// The parameters cannot be used.
pub fn full_costs(objectives: &[&Objective], setup: &Setup) -> Result<Vec<Cost>, TuneError> {
    objectives.par_iter().map(|objective| full_cost(objective, setup)).collect()
}

/// The largest ratio of a recording's error to the error before. More than [`WORST_RATIO`] where
/// surge or sway is inverted for longer than `fit` and the verdict permit, and than before.
pub fn worst_ratio(before: &[Cost], after: &[Cost]) -> f64 {
    let inverted = |cost: &Cost| cost.shape.most_inverted_axis().map_or(0.0, |most| most.1);
    let ratio = |(before, after): (&Cost, &Cost)| {
        let inversion = inverted(after) / inverted(before).max(Aims::default().inverted);
        (after.error / before.error).max(if inversion > 1.0 { WORST_RATIO * inversion } else { 0.0 })
    };
    before.iter().zip(after).map(ratio).fold(0.0, f64::max)
}

/// Cost of a recording with these parameters, in their internal steps.
///
/// # Errors
/// The parameters cannot be used.
pub fn full_cost(objective: &Objective, setup: &Setup) -> Result<Cost, TuneError> {
    let parameters = objective.recording().parameters(&setup.parameters);
    Ok(objective.cost(&Simulation::of(&objective.recording().replay(), &parameters, || ())?)?)
}

#[cfg(test)]
mod tests {
    use moris_simulation::measures::shape::{AxisShape, Shape};

    use super::*;

    #[test]
    fn more_inverted_time_than_the_verdict_permits_is_a_worsening() {
        let cost = |error, inverted| {
            let axes = [Some(AxisShape { shape: 0.9, size: 0.5, inverted }), None];
            Cost { error, shape: Shape { axes, ..Shape::default() }, ..Cost::default() }
        };
        let is_worse = |before, after| worst_ratio(&[before], &[after]) > WORST_RATIO;
        assert!(!is_worse(cost(0.5, 0.0), cost(0.5, 0.02)));
        assert!(is_worse(cost(0.5, 0.0), cost(0.4, 0.021)));
        // What was inverted before may be so for as long.
        assert!(!is_worse(cost(0.5, 0.08), cost(0.4, 0.08)));
        assert!(is_worse(cost(0.5, 0.08), cost(0.4, 0.09)));
        assert!(is_worse(cost(0.5, 0.0), cost(0.53, 0.0)));
    }
}
