//! Whether what the search found in long steps holds in the steps that it will be used with.

use anyhow::Result;
use moris_washout::Parameters;
use rayon::prelude::*;
use washout_setup::Setup;

use super::cost::{Cost, Judge};
use super::search::Found;
use crate::run::Outcome;

/// What each ride comes to with these parameters, step by internal step as the washout will take them.
///
/// # Errors
/// The parameters cannot be used.
pub fn costs(judges: &[&Judge], setup: &Setup) -> Result<Vec<Cost>> {
    judges.par_iter().map(|judge| Ok(judge.cost(&Outcome::of(judge.ride(), setup, || ())?.recording))).collect()
}

/// The first of the sets that keeps all constraints on every ride, with its costs; none where none does.
///
/// # Errors
/// Parameters cannot be used.
pub fn first_that_holds(judges: &[&Judge], setup: &Setup, best: &[Found]) -> Result<Option<(Parameters, Vec<Cost>)>> {
    for found in best {
        let parameters = found.parameters;
        let costs = costs(judges, &Setup { parameters, ..setup.clone() })?;
        if costs.iter().all(Cost::is_feasible) {
            return Ok(Some((parameters, costs)));
        }
    }
    Ok(None)
}
