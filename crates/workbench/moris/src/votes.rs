//! Votes of a person who felt two parameter sets: `moris live` writes them, `moris tune` starts
//! from the preferred set.
//!
//! A file has a vote a line, as JSON: the values of the better set and of the worse one that differ
//! from those of the rig with default parameters.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result, bail};
use moris_live::log::slot_of;
use moris_setup::NamedValues;
use serde::{Deserialize, Serialize};

/// Values of a set by their names.
pub type Set = BTreeMap<String, f64>;

/// A vote for the better of two parameter sets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vote {
    pub better: Set,
    pub worse: Set,
}

/// Reads a file of votes.
///
/// # Errors
/// It cannot be read, has no vote, or a line is none.
pub fn read(file: &Path) -> Result<Vec<Vote>> {
    let text =
        moris_fmu_host::files::text(file, moris_fmu_host::files::TEXT).with_context(|| file.display().to_string())?;
    let vote = |(place, line): (usize, &str)| -> Result<Vote> {
        let here = || format!("{}, line {}", file.display(), place + 1);
        let vote: Vote = serde_json::from_str(line)
            .with_context(|| format!("{} is no vote; moris live --votes writes them", here()))?;
        match vote.better.keys().chain(vote.worse.keys()).find(|name| slot_of(name).is_none()) {
            Some(name) => bail!("{}: there is no parameter {name}", here()),
            None => Ok(vote),
        }
    };
    let votes: Vec<Vote> = text.lines().enumerate().map(vote).collect::<Result<_>>()?;
    if votes.is_empty() {
        bail!("{} has no vote", file.display());
    }
    Ok(votes)
}

/// Rounds in which the strengths settle.
const ROUNDS: usize = 500;

/// The strengths of the sets in the votes, by Bradley and Terry: a set of strength p is better than
/// one of strength q with the probability p / (p + q). Each set has won and lost once, in addition,
/// against a set of strength 1: a set with a single vote is no certain winner.
fn strengths(votes: &[Vote]) -> Vec<(&Set, f64)> {
    let mut sets: Vec<&Set> = Vec::new();
    let mut place = |set| {
        sets.iter().position(|known| *known == set).unwrap_or_else(|| {
            sets.push(set);
            sets.len() - 1
        })
    };
    let pairs: Vec<[usize; 2]> = votes.iter().map(|vote| [place(&vote.better), place(&vote.worse)]).collect();
    let mut strengths = vec![1.0; sets.len()];
    for _ in 0..ROUNDS {
        let of = |set: usize| {
            let wins = pairs.iter().filter(|pair| pair[0] == set).count() as f64;
            let met = pairs.iter().filter(|pair| pair.contains(&set));
            let shares: f64 = met.map(|pair| 1.0 / (strengths[pair[0]] + strengths[pair[1]])).sum();
            (wins + 1.0) / (shares + 2.0 / (strengths[set] + 1.0))
        };
        strengths = (0..sets.len()).map(of).collect();
    }
    sets.into_iter().zip(strengths).collect()
}

/// The set that the votes prefer; of equal ones the first. None without a vote.
pub fn preferred(votes: &[Vote]) -> Option<NamedValues> {
    let strengths = strengths(votes);
    let (best, _) = strengths.into_iter().reduce(|best, other| if other.1 > best.1 + 1e-9 { other } else { best })?;
    Some(best.iter().map(|(name, value)| (name.clone(), *value)).collect())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn set(value: f64) -> Set {
        [("scale.specificForce.x".to_owned(), value)].into()
    }

    fn vote(better: f64, worse: f64) -> Vote {
        Vote { better: set(better), worse: set(worse) }
    }

    fn best(votes: &[Vote]) -> f64 {
        preferred(votes).unwrap()[0].1
    }

    #[test]
    fn strengths_satisfy_the_condition_of_the_largest_likelihood() {
        // The wins of each set, with its won draw, are those expected of its strength.
        let votes = [vote(0.5, 0.7), vote(0.5, 0.7), vote(0.7, 0.5), vote(0.5, 0.9), vote(0.9, 0.7)];
        let found = strengths(&votes);
        let of = |value: f64| found.iter().find(|(known, _)| **known == set(value)).unwrap().1;
        for (set, wins, met) in
            [(0.5, 3.0, &[0.7, 0.7, 0.7, 0.9][..]), (0.7, 1.0, &[0.5, 0.5, 0.5, 0.9]), (0.9, 1.0, &[0.5, 0.7])]
        {
            let chance = |other: f64| of(set) / (of(set) + other);
            let expected: f64 = met.iter().map(|other| chance(of(*other))).sum::<f64>() + 2.0 * chance(1.0);
            assert!((wins + 1.0 - expected).abs() < 1e-9, "{set}: {expected}");
        }
        assert_eq!(best(&votes), 0.5);
    }

    #[test]
    fn a_set_that_wins_against_strong_ones_is_preferred() {
        // 0.3 has won as often, but against a set that has lost every time.
        let votes = [vote(0.5, 0.7), vote(0.5, 0.7), vote(0.7, 0.1), vote(0.7, 0.1), vote(0.3, 0.1), vote(0.3, 0.1)];
        assert_eq!(best(&votes), 0.5);
        assert_eq!(best(&[vote(0.5, 0.7)]), 0.5);
        // Equal ones: the first that has been felt.
        assert_eq!(best(&[vote(0.5, 0.7), vote(0.7, 0.5)]), 0.5);
    }

    #[test]
    fn a_file_is_read_line_by_line() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("votes");
        let line = |vote: &Vote| serde_json::to_string(vote).unwrap() + "\n";
        let votes = vec![vote(0.5, 0.7), Vote { better: Set::new(), worse: set(0.7) }];
        fs::write(&file, votes.iter().map(line).collect::<String>()).unwrap();
        assert_eq!(read(&file).unwrap(), votes);
        for (wrong, why) in [
            ("", "has no vote"),
            ("{\"better\":{},\"worse\":{\"nothing\":1}}", "line 1: there is no parameter nothing"),
            ("{\"better\":{}}", "line 1"),
            ("better,worse", "line 1"),
        ] {
            fs::write(&file, wrong).unwrap();
            let said = format!("{:#}", read(&file).unwrap_err());
            assert!(said.contains(why), "{wrong}: {said}");
        }
    }
}
