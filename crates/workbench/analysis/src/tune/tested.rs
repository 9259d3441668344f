//! Tuning with a test on recordings that are left out. The test also determines how far the result
//! goes from the initial parameters.

use moris_setup::Setup;

use super::cost::{Cost, Objective};
use super::error::TuneError;
use super::summary::RecordingResult;
use super::tuner::{Tuner, WORST_RATIO, full_cost, full_costs, worst_ratio};

/// Fractions of the distance from the initial parameters to the best ones for the recordings
/// tuned on, in logarithms.
const TRIED_FRACTIONS: [f64; 6] = [0.1, 0.2, 0.3, 0.5, 0.7, 1.0];

/// Result of a tuning.
pub struct Tested {
    /// The tuned parameters.
    pub setup: Setup,
    /// Every recording before and after, including those that were not tuned on.
    pub results: Vec<RecordingResult>,
    /// Fraction of the distance to the best parameters; 0: the initial parameters.
    pub fraction: f64,
}

/// Costs of a recording that was left out, at each of the [`TRIED_FRACTIONS`]. `None` where the
/// limits are not kept on the other recordings.
type Trials = [Option<Cost>; TRIED_FRACTIONS.len()];

/// Tunes on all recordings and, for each fold, on the recordings outside it. The result has the
/// fraction that is best for the recordings left out. Without folds the fraction is 1.
///
/// Recordings in `held_out` have no influence on the result.
///
/// # Errors
/// No parameters keep the limits on all recordings ([`TuneError::Infeasible`]), or
/// parameters cannot be used.
pub fn tune_tested(
    tuner: &Tuner,
    objectives: &[&Objective],
    held_out: &[&Objective],
    folds: &[Vec<usize>],
) -> Result<Tested, TuneError> {
    let best = tuner.tune(objectives, "all recordings")?;
    let before = full_costs(objectives, tuner.setup)?;
    let left_out = leave_out_in_turn(tuner, objectives, folds)?;
    let pairs: Vec<(Cost, Trials)> =
        before.iter().zip(&left_out).filter_map(|(cost, of)| Some((*cost, of.trials?))).collect();
    let (setup, fraction) = as_far_as_serves(tuner, objectives, &before, &pairs, best)?;
    let after = full_costs(objectives, &setup)?;
    let index = TRIED_FRACTIONS.iter().position(|&of| of == fraction);
    let mut results = Vec::new();
    for (k, objective) in objectives.iter().enumerate() {
        let unseen = left_out[k].trials.and_then(|costs| index.map_or(Some(before[k]), |index| costs[index]));
        results.push(RecordingResult {
            tuned: Some(after[k]),
            // Recordings that are held out are the better test.
            unseen: unseen.filter(|_| held_out.is_empty()),
            infeasible_without: left_out[k].infeasible,
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
    /// None if the recording was not left out, or no parameters were found without it.
    trials: Option<Trials>,
    infeasible: bool,
}

/// Tunes without each of the folds. The result of an interrupted search is not used.
fn leave_out_in_turn(
    tuner: &Tuner,
    objectives: &[&Objective],
    folds: &[Vec<usize>],
) -> Result<Vec<LeftOut>, TuneError> {
    let mut left_out = vec![LeftOut::default(); objectives.len()];
    for fold in folds {
        if tuner.was_interrupted() {
            break;
        }
        match leave_out(tuner, objectives, fold) {
            _ if tuner.was_interrupted() => break,
            Ok(of_fold) => fold.iter().zip(of_fold).for_each(|(&k, costs)| left_out[k].trials = Some(costs)),
            // The result for all recordings remains valid.
            Err(TuneError::Infeasible(_)) => {
                fold.iter().for_each(|&k| left_out[k].infeasible = true);
            }
            Err(error) => return Err(error),
        }
    }
    Ok(left_out)
}

/// The parameters at the fraction that is best for the recordings left out and makes no recording
/// much worse, and the fraction.
fn as_far_as_serves(
    tuner: &Tuner,
    objectives: &[&Objective],
    before: &[Cost],
    pairs: &[(Cost, Trials)],
    best: Setup,
) -> Result<(Setup, f64), TuneError> {
    // Largest fraction of a recording's time in which limits may be active if the result is the
    // initial parameters.
    const MAX_LIMITED_FRACTION: f64 = 0.01;
    for index in serving_fractions(pairs) {
        let Some(setup) = within_limits(tuner, objectives, &best, TRIED_FRACTIONS[index])? else { continue };
        if worst_ratio(before, &full_costs(objectives, &setup)?) <= WORST_RATIO {
            return Ok((setup, TRIED_FRACTIONS[index]));
        }
    }
    if !pairs.is_empty() && before.iter().all(|cost| cost.violated <= MAX_LIMITED_FRACTION) {
        return Ok((Setup { parameters: tuner.setup.parameters, ..best }, 0.0));
    }
    Ok((best, 1.0))
}

/// Costs of the recordings of a fold, at each fraction of the distance to the best
/// parameters for the others.
fn leave_out(tuner: &Tuner, objectives: &[&Objective], fold: &[usize]) -> Result<Vec<Trials>, TuneError> {
    let others: Vec<&Objective> =
        objectives.iter().enumerate().filter(|(k, _)| !fold.contains(k)).map(|(_, objective)| *objective).collect();
    let names: Vec<&str> = fold.iter().map(|&k| objectives[k].name()).collect();
    let best = tuner.tune(&others, &format!("without {}", names.join(", ")))?;
    let mut trials = vec![[None; TRIED_FRACTIONS.len()]; fold.len()];
    for (index, &fraction) in TRIED_FRACTIONS.iter().enumerate() {
        let Some(setup) = within_limits(tuner, &others, &best, fraction)? else { continue };
        for (of_recording, &k) in trials.iter_mut().zip(fold) {
            of_recording[index] = Some(full_cost(objectives[k], &setup)?);
        }
    }
    Ok(trials)
}

/// The parameters at this fraction of the distance to the best ones. Their scales are reduced until
/// the limits are kept on these recordings. `None` if the limits are not kept.
fn within_limits(
    tuner: &Tuner,
    objectives: &[&Objective],
    best: &Setup,
    fraction: f64,
) -> Result<Option<Setup>, TuneError> {
    // Factor by which the scales are reduced at a time, and largest number of times, where limits
    // are active at a fraction of the distance.
    const SCALE_STEP: f64 = 0.93;
    const MAX_TRIES: i32 = 8;
    if fraction == 1.0 {
        return Ok(Some(best.clone()));
    }
    let towards = tuner.space.towards(&best.parameters, fraction);
    for k in 0..=MAX_TRIES {
        let setup = Setup { parameters: tuner.space.with_scales_times(&towards, SCALE_STEP.powi(k)), ..best.clone() };
        if full_costs(objectives, &setup)?.iter().all(Cost::is_feasible) {
            return Ok(Some(setup));
        }
        if !tuner.space.has_scales() {
            break;
        }
    }
    Ok(None)
}

/// Indices of the fractions that improve the recordings left out, the best first. Their mean error
/// is smaller than with the initial parameters, and no recording is worse by more than 5 %. First
/// come fractions with which limits are active no longer than before, and shake, jolt and peak are
/// within their bounds. If no recording was left out, the result is the last index.
fn serving_fractions(pairs: &[(Cost, Trials)]) -> Vec<usize> {
    if pairs.is_empty() {
        return vec![TRIED_FRACTIONS.len() - 1];
    }
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / pairs.len() as f64;
    let before = mean(&mut pairs.iter().map(|pair| pair.0.error));
    let violated_before = mean(&mut pairs.iter().map(|pair| pair.0.violated));
    let rank = |index: usize| {
        let costs: Vec<Cost> = pairs.iter().map(|pair| pair.1[index]).collect::<Option<_>>()?;
        let error = mean(&mut costs.iter().map(|cost| cost.error));
        let violated = mean(&mut costs.iter().map(|cost| cost.violated));
        let uncomfortable = costs.iter().any(|cost| cost.excess > 0.0);
        let worse = pairs.iter().zip(&costs).any(|(pair, cost)| cost.error > WORST_RATIO * pair.0.error);
        (error < before && !worse).then_some((violated > violated_before || uncomfortable, error, index))
    };
    let mut ranked: Vec<(bool, f64, usize)> = (0..TRIED_FRACTIONS.len()).filter_map(rank).collect();
    ranked.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    ranked.into_iter().map(|(_, _, index)| index).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cost(error: f64, violated: f64) -> Cost {
        Cost { error, violated, ..Cost::default() }
    }

    fn trials(errors: [f64; 6]) -> Trials {
        errors.map(|error| Some(cost(error, 0.0)))
    }

    #[test]
    fn fractions_that_serve_rides_left_out_come_with_the_best_first() {
        let before = cost(1.0, 0.0);
        let one = (before, trials([0.95, 0.9, 0.85, 0.8, 0.86, 0.91]));
        assert_eq!(serving_fractions(&[one]), [3, 2, 4, 1, 5, 0]);
        // Another recording is worse by more than 5 % from fraction 0.5 on.
        let other = (before, trials([1.0, 1.01, 1.02, 1.06, 1.08, 1.1]));
        assert_eq!(serving_fractions(&[one, other]), [2, 1, 0]);
        // In the mean no fraction is better.
        let worse = (before, trials([1.05, 1.11, 1.2, 1.3, 1.4, 1.5]));
        assert!(serving_fractions(&[one, worse]).is_empty());
    }

    #[test]
    fn fractions_with_which_limits_act_for_no_longer_come_first() {
        let mut costs = trials([0.95, 0.9, 0.85, 0.8, 0.75, 0.7]);
        costs[5] = Some(cost(0.7, 0.01));
        assert_eq!(serving_fractions(&[(cost(1.0, 0.0), costs)]), [4, 3, 2, 1, 0, 5]);
        assert_eq!(serving_fractions(&[(cost(1.0, 0.02), costs)])[0], 5);
        costs[4] = None;
        assert_eq!(serving_fractions(&[(cost(1.0, 0.0), costs)]), [3, 2, 1, 0, 5]);
    }

    #[test]
    fn fractions_beyond_the_bounds_of_comfort_come_last() {
        let mut costs = trials([0.95, 0.9, 0.85, 0.8, 0.75, 0.7]);
        costs[5] = Some(Cost { excess: 0.01, ..cost(0.7, 0.0) });
        assert_eq!(serving_fractions(&[(cost(1.0, 0.0), costs)]), [4, 3, 2, 1, 0, 5]);
    }

    #[test]
    fn without_recordings_left_out_it_goes_all_the_way() {
        assert_eq!(serving_fractions(&[]), [5]);
    }
}
