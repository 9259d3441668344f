//! The search: CMA-ES over the space of parameters, on all cores. The same seed gives the same
//! result on any number of cores.

use std::sync::Mutex;

use cmaes::{CMAESOptions, DVector};
use moris_washout::Parameters;
use rayon::prelude::*;

use super::cost::{Cost, Objective};
use super::error::TuneError;
use super::space::Space;
use crate::texts::text;

/// Length and start of a search.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Number of parameter sets to evaluate.
    pub evaluations: usize,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Computes the cost of each recording with these parameters, in the search's long steps.
pub type Evaluate<'a> = dyn Fn(&[&Objective], &Parameters) -> Result<Vec<Cost>, TuneError> + Sync + 'a;

/// Evaluates on all cores of this machine.
///
/// # Errors
/// The parameters cannot be used.
pub fn evaluate_here(objectives: &[&Objective], parameters: &Parameters) -> Result<Vec<Cost>, TuneError> {
    objectives.par_iter().map(|objective| Ok(objective.coarse_cost(parameters)?)).collect()
}

/// A parameter set that kept all constraints on every recording.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The parameters.
    pub parameters: Parameters,
    /// The objective, in the search's long steps.
    pub error: f64,
    cost: f64,
    point: Vec<f64>,
}

/// Result of a search.
#[derive(Clone, Debug)]
pub struct Searched {
    /// Sets that kept all constraints on every recording, the best first; the first ten.
    pub best: Vec<Candidate>,
    /// The set of the least cost, even if it violates constraints.
    pub nearest: Parameters,
}

/// Searches for parameters with the smallest objective over these recordings that
/// keep all constraints.
///
/// `evaluate` computes the costs, on this machine or on others. `progress` is called within the
/// scan, with 0, and after each generation with the number of evaluated sets. The callback also
/// gets the best set so far, and returns false to end the search.
///
/// # Errors
/// Parameters of the space cannot be used.
pub fn search(
    objectives: &[&Objective],
    evaluate: &Evaluate,
    space: &Space,
    budget: Budget,
    mut progress: impl FnMut(usize, Option<&Candidate>) -> bool,
) -> Result<Searched, TuneError> {
    // Initial step size, in logarithms: most frequencies within a factor of 1.5 either way.
    const FIRST_STEP: f64 = 0.4;
    // The search ends when a generation's costs differ by less than this.
    const COST_TOLERANCE: f64 = 1e-5;
    if space.dimension() == 0 {
        return Err(TuneError::NothingToTune(text!["nothing-to-tune"]));
    }
    let recordings = &Recordings::new(objectives, evaluate, space)?;
    let mut continues = true;
    let beginning = best_beginning(recordings, space, |best| {
        continues = continues && progress(0, best);
        continues
    });
    let Beginning { space, best, point: start, .. } = &beginning;
    let cost = |point: &DVector<f64>| penalized_cost(recordings, space, point, best);
    let mut search = CMAESOptions::new(start.clone(), FIRST_STEP)
        .seed(budget.seed)
        .max_function_evals(budget.evaluations)
        .tol_fun(COST_TOLERANCE)
        .build(cost)
        .map_err(|error| TuneError::Start(format!("{error:?}")))?;
    while continues {
        let ended = search.next_parallel().is_some();
        let first = best.lock().expect("no evaluation panics").0.first().cloned();
        continues = progress(search.function_evals(), first.as_ref());
        if ended {
            break;
        }
    }
    let nearest = search.overall_best_individual().map(|best| nearest_parameters(space, &best.point));
    let mut best = best.lock().expect("no evaluation panics").0.clone();
    if let Some(first) = best.first().filter(|_| continues) {
        let tidied = tidied_candidate(recordings, space, first);
        best.insert(0, tidied);
    }
    Ok(Searched {
        best,
        nearest: nearest.unwrap_or_else(|| nearest_parameters(space, &DVector::zeros(space.dimension()))),
    })
}

/// Start of a search.
struct Beginning {
    /// The space with the orders of this start.
    space: Space,
    point: DVector<f64>,
    cost: f64,
    /// The best sets of the scan with these orders.
    best: Mutex<Best>,
}

/// The best start: first with the initial orders, then, if orders are tuned, with others,
/// while `continues` is true. The callback receives the best set so far.
fn best_beginning(
    recordings: &Recordings,
    space: &Space,
    mut continues: impl FnMut(Option<&Candidate>) -> bool,
) -> Beginning {
    let (mut first, mut goes_on) = coarse_scan(recordings, space, &mut continues);
    for order in 0..2 {
        for other in first.space.with_other_order(order) {
            if !goes_on {
                return first;
            }
            let mut best = first.best.lock().expect("no evaluation panics").0.first().cloned();
            let (scanned, on) = coarse_scan(recordings, &other, &mut |found| {
                let is_better = |found: &&Candidate| best.as_ref().is_none_or(|best| found.cost < best.cost);
                best = found.filter(is_better).cloned().or(best.take());
                continues(best.as_ref())
            });
            goes_on = on;
            if scanned.cost < first.cost {
                first = scanned;
            }
        }
    }
    first
}

/// The best point of a coarse scan from the start: all of surge, sway and rates together, then
/// channel by channel. False beside it if it was to end.
fn coarse_scan(
    recordings: &Recordings,
    space: &Space,
    continues: &mut dyn FnMut(Option<&Candidate>) -> bool,
) -> (Beginning, bool) {
    // Factors tried on each channel before the search, relative to the start. The cost has several
    // local minima, mainly along the break frequencies, and the search ends in the one nearest to
    // its start.
    const TRIED_FREQUENCY_FACTORS: [f64; 5] = [1.0, 0.5, 0.25, 0.125, 2.0];
    const TRIED_SCALE_FACTORS: [f64; 4] = [1.0, 0.5, 0.2, 0.05];
    // Factors on the scales of surge, sway and all rates together, which are tried before, and with
    // each of them on the break frequencies of surge and sway.
    const JOINT_SCALES: [f64; 7] = [1.0, 0.7, 0.5, 0.35, 0.25, 0.15, 0.1];
    const JOINT_FREQUENCIES: [f64; 4] = [1.0, 0.5, 0.25, 2.0];
    let found = Mutex::new(Best::default());
    let cost = |point: &DVector<f64>| penalized_cost(recordings, space, point, &found);
    let mut best = start_within_limits(recordings, space);
    let mut least = cost(&best);
    let mut goes_on = true;
    for stage in 0..7 {
        goes_on = continues(found.lock().expect("no evaluation panics").0.first());
        if !goes_on {
            break;
        }
        let points: Vec<_> = if stage == 0 {
            let factors = JOINT_FREQUENCIES.iter().flat_map(|&frequency| JOINT_SCALES.map(|scale| (frequency, scale)));
            factors.map(|(frequency, scale)| space.with_all_channels(&best, frequency, scale)).collect()
        } else {
            let factors = TRIED_FREQUENCY_FACTORS
                .iter()
                .flat_map(|&frequency| TRIED_SCALE_FACTORS.map(|scale| (frequency, scale)));
            factors.map(|(f, s)| space.with_channel(&best, stage - 1, f, s)).collect()
        };
        let points = without_repetitions(points);
        let costs: Vec<f64> = points.par_iter().map(&cost).collect();
        for (point, cost) in points.into_iter().zip(costs) {
            if cost < least {
                (best, least) = (point, cost);
            }
        }
    }
    (Beginning { space: space.clone(), point: best, cost: least, best: found }, goes_on)
}

/// The points without repetitions, which a strategy without break frequencies has.
fn without_repetitions(points: Vec<DVector<f64>>) -> Vec<DVector<f64>> {
    let mut different: Vec<DVector<f64>> = Vec::new();
    for point in points {
        if !different.contains(&point) {
            different.push(point);
        }
    }
    different
}

/// The start. If constraints are violated there, all scales are reduced until none is.
fn start_within_limits(recordings: &Recordings, space: &Space) -> DVector<f64> {
    // Factor between successive trials, and their number: down to about a hundredth.
    const SCALE_STEP: f64 = 0.8;
    const MAX_TRIES: i32 = 21;
    let mut tries = (0..MAX_TRIES).map(|k| space.scaled_start(SCALE_STEP.powi(k)));
    let keeps = |point: &DVector<f64>| {
        recordings.objective(&space.parameters(point)).is_some_and(|(_, penalty)| penalty == 0.0)
    };
    tries.find(keeps).unwrap_or_else(|| space.scaled_start(1.0))
}

/// The parameters at the point of the space that is nearest to this one.
fn nearest_parameters(space: &Space, point: &DVector<f64>) -> Parameters {
    space.parameters(&space.clamped(point).0)
}

/// The set with every parameter reset to its initial value that hardly affects these recordings.
fn tidied_candidate(recordings: &Recordings, space: &Space, found: &Candidate) -> Candidate {
    // Largest increase of the error for which one parameter is reset to its initial value.
    const WORTH_TIDYING: f64 = 2e-4;
    let mut tidied = found.clone();
    for k in 0..found.point.len() {
        let mut point = tidied.point.clone();
        point[k] = 0.0;
        let parameters = space.parameters(&DVector::from_column_slice(&point));
        let Some((error, penalty)) = recordings.objective(&parameters) else { continue };
        if penalty == 0.0 && error < tidied.error + WORTH_TIDYING {
            tidied = Candidate { parameters, error, point, ..tidied };
        }
    }
    tidied
}

/// The recordings and their errors at the start of the search.
struct Recordings<'a> {
    objectives: &'a [&'a Objective],
    evaluate: &'a Evaluate<'a>,
    starts: Vec<f64>,
}

impl<'a> Recordings<'a> {
    fn new(objectives: &'a [&'a Objective], evaluate: &'a Evaluate<'a>, space: &Space) -> Result<Self, TuneError> {
        let start = nearest_parameters(space, &DVector::zeros(space.dimension()));
        let starts = evaluate(objectives, &start)?.iter().map(|cost| cost.error).collect();
        Ok(Recordings { objectives, evaluate, starts })
    }

    /// The objective, and the penalty for violated constraints, 0 if all are kept. `None` where the
    /// parameters cannot be used.
    ///
    /// The objective is the mean error over the recordings, plus the weighted worst error, plus a
    /// penalty on each recording that gets worse. A set that improves one recording at another's
    /// expense is unlikely to improve an unknown recording.
    fn objective(&self, parameters: &Parameters) -> Option<(f64, f64)> {
        // Penalty for limits that are active all the time; errors are about 1. The penalty is
        // proportional to the square root of the fraction of the time: a thousandth costs 0.06.
        const PENALTY_OF_LIMITS: f64 = 2.0;
        // Additional penalty if limits are active at any time.
        const PENALTY_OF_ANY: f64 = 0.05;
        // Penalty for shake, jolt or peak beyond their bounds by a factor of e, in addition.
        const PENALTY_OF_DISCOMFORT: f64 = 0.5;
        // Weight of the worst recording's error beside the mean's.
        const WEIGHT_OF_THE_WORST: f64 = 0.5;
        // Penalty on a recording's error above that with the parameters that the search starts
        // from.
        const PENALTY_OF_WORSENING: f64 = 4.0;
        let costs = (self.evaluate)(self.objectives, parameters).ok()?;
        let mean = |of: fn(&Cost) -> f64| costs.iter().map(of).sum::<f64>() / costs.len() as f64;
        let worst = costs.iter().map(|cost| cost.error).fold(0.0, f64::max);
        let worse = costs.iter().zip(&self.starts).map(|(cost, start)| (cost.error - start).max(0.0)).sum::<f64>();
        let worse = worse / costs.len() as f64;
        let error = mean(|cost| cost.error) + WEIGHT_OF_THE_WORST * worst + PENALTY_OF_WORSENING * worse;
        if costs.iter().all(Cost::is_feasible) {
            return Some((error, 0.0));
        }
        let (violated, excess) = (mean(|cost| cost.violated), mean(|cost| cost.excess));
        Some((error, PENALTY_OF_ANY + PENALTY_OF_LIMITS * violated.sqrt() + PENALTY_OF_DISCOMFORT * excess.ln_1p()))
    }
}

/// Cost of a point; feasible points are kept if among the best.
fn penalized_cost(recordings: &Recordings, space: &Space, point: &DVector<f64>, best: &Mutex<Best>) -> f64 {
    // Penalty for a point outside the space's box by a factor of e in one parameter.
    const PENALTY_OF_OUTSIDE: f64 = 0.1;
    // Penalty for a distance from the start by a factor of e in every parameter. Of two equally
    // good sets, the one nearer to the start is chosen. A parameter without effect on the
    // recordings keeps its value.
    const PENALTY_OF_DISTANCE: f64 = 2e-3;
    let (inside, outside) = space.clamped(point);
    let parameters = space.parameters(&inside);
    // All parameters in the box can be used. If some cannot, their cost is the largest.
    let Some((error, penalty)) = recordings.objective(&parameters) else { return f64::MAX };
    let distance = inside.norm_squared() / inside.len() as f64;
    let cost = error + PENALTY_OF_DISTANCE * distance;
    if penalty == 0.0 {
        let found = Candidate { parameters, error, cost, point: inside.as_slice().to_vec() };
        best.lock().expect("no evaluation panics").add(found);
    }
    cost + PENALTY_OF_OUTSIDE * outside + penalty
}

/// The best sets so far, the best first. The order of evaluation does not matter.
#[derive(Default)]
struct Best(Vec<Candidate>);

impl Best {
    fn add(&mut self, found: Candidate) {
        // Number of best sets that are kept.
        const KEPT_SETS: usize = 10;
        let before = |other: &Candidate| {
            let by_cost = other.cost.total_cmp(&found.cost);
            let by_point = || other.point.partial_cmp(&found.point);
            by_cost.is_lt() || (by_cost.is_eq() && by_point().is_some_and(std::cmp::Ordering::is_le))
        };
        let place = self.0.partition_point(before);
        self.0.insert(place, found);
        self.0.truncate(KEPT_SETS);
    }
}
