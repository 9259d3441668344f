//! Tuning with a test on recordings that are left out, which also decides how far the result goes
//! from the initial parameters.

use anyhow::Result;
use moris_setup::Setup;

use super::cost::{Cost, Objective};
use super::summary::RecordingResult;
use super::tuner::{NoFeasibleParameters, Tuner, WORST_RATIO, full_cost, full_costs, smaller, worst_ratio};

/// Fractions of the way from the initial parameters to the best ones for the recordings
/// tuned on, by logarithms.
const FRACTIONS: [f64; 6] = [0.1, 0.2, 0.3, 0.5, 0.7, 1.0];

/// Fraction of a recording's time in which limits may be active with initial parameters that stay.
const TOLERATED: f64 = 0.01;

/// Result of a tuning.
pub struct Tested {
    /// The tuned parameters.
    pub setup: Setup,
    /// Every recording before and after, those that were not tuned on among them.
    pub results: Vec<RecordingResult>,
    /// Fraction of the way that they go; 0: they are the initial ones.
    pub fraction: f64,
}

/// Costs of a recording that was left out, at each of the [`FRACTIONS`]; none where the limits are
/// not kept on the others.
type Trials = [Option<Cost>; FRACTIONS.len()];

/// Factor on the scales at a time, and largest number of times, where limits are active part of the
/// way.
const SMALLER: f64 = 0.93;
const TRIES: i32 = 8;

/// Tunes on all recordings and, for each fold of them, on the others. The fraction of the
/// way that is best for recordings left out is that of the result. Without folds the
/// result goes all the way.
///
/// Rides in `held_out` decide nothing.
///
/// # Errors
/// No parameters keep the limits on all recordings ([`NoFeasibleParameters`]), or
/// parameters cannot be used.
pub fn tune_tested(
    tuner: &Tuner,
    objectives: &[&Objective],
    held_out: &[&Objective],
    folds: &[Vec<usize>],
) -> Result<Tested> {
    let best = tuner.tune(objectives, "all recordings")?;
    let before = full_costs(objectives, tuner.setup)?;
    let left_out = leave_out_in_turn(tuner, objectives, folds)?;
    let pairs: Vec<(Cost, Trials)> =
        before.iter().zip(&left_out).filter_map(|(cost, of)| Some((*cost, of.trials?))).collect();
    let (setup, fraction) = as_far_as_serves(tuner, objectives, &before, &pairs, best)?;
    let after = full_costs(objectives, &setup)?;
    let index = FRACTIONS.iter().position(|&of| of == fraction);
    let mut results = Vec::new();
    for (k, objective) in objectives.iter().enumerate() {
        let unseen = left_out[k].trials.and_then(|costs| index.map_or(Some(before[k]), |index| costs[index]));
        results.push(RecordingResult {
            tuned: Some(after[k]),
            // Rides that are held out are the better test.
            unseen: unseen.filter(|_| held_out.is_empty()),
            nothing_found_without: left_out[k].nothing_found,
            ..RecordingResult::new(objective, before[k])
        });
    }
    for objective in held_out {
        let unseen = Some(full_cost(objective, &setup)?);
        results.push(RecordingResult { unseen, ..RecordingResult::new(objective, full_cost(objective, tuner.setup)?) });
    }
    Ok(Tested { setup, results, fraction })
}

/// Result of tuning without a recording.
#[derive(Clone, Copy, Default)]
struct LeftOut {
    /// None where it was not left out, or nothing was found without it.
    trials: Option<Trials>,
    nothing_found: bool,
}

/// Tunes without each of the folds. A search that was broken off says nothing.
fn leave_out_in_turn(tuner: &Tuner, objectives: &[&Objective], folds: &[Vec<usize>]) -> Result<Vec<LeftOut>> {
    let mut left_out = vec![LeftOut::default(); objectives.len()];
    for fold in folds {
        if tuner.was_interrupted() {
            break;
        }
        match leave_out(tuner, objectives, fold) {
            _ if tuner.was_interrupted() => break,
            Ok(of_fold) => fold.iter().zip(of_fold).for_each(|(&k, costs)| left_out[k].trials = Some(costs)),
            // All recordings together are worth no less for it.
            Err(error) if error.is::<NoFeasibleParameters>() => {
                fold.iter().for_each(|&k| left_out[k].nothing_found = true);
            }
            Err(error) => return Err(error),
        }
    }
    Ok(left_out)
}

/// As much of the way to the best parameters as serves the recordings that were left out, and makes
/// no recording much worse; and how much that is.
fn as_far_as_serves(
    tuner: &Tuner,
    objectives: &[&Objective],
    before: &[Cost],
    pairs: &[(Cost, Trials)],
    best: Setup,
) -> Result<(Setup, f64)> {
    for index in serving(pairs) {
        let Some(setup) = within_limits(tuner, objectives, &best, FRACTIONS[index])? else { continue };
        if worst_ratio(before, &full_costs(objectives, &setup)?) <= WORST_RATIO {
            return Ok((setup, FRACTIONS[index]));
        }
    }
    if !pairs.is_empty() && before.iter().all(|cost| cost.violated <= TOLERATED) {
        return Ok((Setup { parameters: tuner.setup.parameters, ..best }, 0.0));
    }
    Ok((best, 1.0))
}

/// Costs of the recordings of a fold, at each fraction of the way to the best
/// parameters for the others.
fn leave_out(tuner: &Tuner, objectives: &[&Objective], fold: &[usize]) -> Result<Vec<Trials>> {
    let others: Vec<&Objective> =
        objectives.iter().enumerate().filter(|(k, _)| !fold.contains(k)).map(|(_, objective)| *objective).collect();
    let names: Vec<&str> = fold.iter().map(|&k| objectives[k].name()).collect();
    let best = tuner.tune(&others, &format!("without {}", names.join(", ")))?;
    let mut trials = vec![[None; FRACTIONS.len()]; fold.len()];
    for (index, &fraction) in FRACTIONS.iter().enumerate() {
        let Some(setup) = within_limits(tuner, &others, &best, fraction)? else { continue };
        for (of_recording, &k) in trials.iter_mut().zip(fold) {
            of_recording[index] = Some(full_cost(objectives[k], &setup)?);
        }
    }
    Ok(trials)
}

/// The parameters at this fraction of the way to the best ones, with scales as much smaller as it
/// takes to keep the limits on these recordings. None if they are not kept.
fn within_limits(tuner: &Tuner, objectives: &[&Objective], best: &Setup, fraction: f64) -> Result<Option<Setup>> {
    if fraction == 1.0 {
        return Ok(Some(best.clone()));
    }
    let towards = tuner.space.towards(&best.parameters, fraction);
    for k in 0..=TRIES {
        let setup = Setup { parameters: smaller(&towards, SMALLER.powi(k)), ..best.clone() };
        if full_costs(objectives, &setup)?.iter().all(Cost::is_feasible) {
            return Ok(Some(setup));
        }
        if !tuner.space.has_scales() {
            break;
        }
    }
    Ok(None)
}

/// Indices of the fractions that serve recordings that were left out, the best first: their mean
/// error is smaller than with the initial parameters, and no recording is worse by more than 5
/// %. Those with which limits are active for no longer come first. The last one where no
/// recording was left out.
fn serving(pairs: &[(Cost, Trials)]) -> Vec<usize> {
    if pairs.is_empty() {
        return vec![FRACTIONS.len() - 1];
    }
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / pairs.len() as f64;
    let before = mean(&mut pairs.iter().map(|pair| pair.0.error));
    let violated_before = mean(&mut pairs.iter().map(|pair| pair.0.violated));
    let rank = |index: usize| {
        let costs: Vec<Cost> = pairs.iter().map(|pair| pair.1[index]).collect::<Option<_>>()?;
        let error = mean(&mut costs.iter().map(|cost| cost.error));
        let violated = mean(&mut costs.iter().map(|cost| cost.violated));
        let worse = pairs.iter().zip(&costs).any(|(pair, cost)| cost.error > WORST_RATIO * pair.0.error);
        (error < before && !worse).then_some((violated > violated_before, error, index))
    };
    let mut ranked: Vec<(bool, f64, usize)> = (0..FRACTIONS.len()).filter_map(rank).collect();
    ranked.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    ranked.into_iter().map(|(_, _, index)| index).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cost(error: f64, violated: f64) -> Cost {
        Cost { channels: [error; 6], error, violated }
    }

    fn trials(errors: [f64; 6]) -> Trials {
        errors.map(|error| Some(cost(error, 0.0)))
    }

    #[test]
    fn fractions_that_serve_rides_left_out_come_with_the_best_first() {
        let before = cost(1.0, 0.0);
        let one = (before, trials([0.95, 0.9, 0.85, 0.8, 0.86, 0.91]));
        assert_eq!(serving(&[one]), [3, 2, 4, 1, 5, 0]);
        // Another recording is worse by more than 5 % from half of the way on.
        let other = (before, trials([1.0, 1.01, 1.02, 1.06, 1.08, 1.1]));
        assert_eq!(serving(&[one, other]), [2, 1, 0]);
        // In the mean nothing is better.
        let worse = (before, trials([1.05, 1.11, 1.2, 1.3, 1.4, 1.5]));
        assert!(serving(&[one, worse]).is_empty());
    }

    #[test]
    fn fractions_with_which_limits_act_for_no_longer_come_first() {
        let mut costs = trials([0.95, 0.9, 0.85, 0.8, 0.75, 0.7]);
        costs[5] = Some(cost(0.7, 0.01));
        assert_eq!(serving(&[(cost(1.0, 0.0), costs)]), [4, 3, 2, 1, 0, 5]);
        assert_eq!(serving(&[(cost(1.0, 0.02), costs)])[0], 5);
        costs[4] = None;
        assert_eq!(serving(&[(cost(1.0, 0.0), costs)]), [3, 2, 1, 0, 5]);
    }

    #[test]
    fn without_recordings_left_out_it_goes_all_the_way() {
        assert_eq!(serving(&[]), [5]);
    }
}
