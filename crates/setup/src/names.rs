//! Which of the right names a wrong one was meant to be.

/// The candidates that look most like `name`, the best first. Those that do not look like it are
/// left out.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    // Least similarity of a proposed name to the wrong one, from 0 to 1.
    const MIN_NAME_SIMILARITY: f64 = 0.6;
    // Largest loss of similarity of a further proposal against the best.
    const ALMOST_AS_ALIKE: f64 = 0.15;
    // No more than this many are proposed.
    const MAX_PROPOSALS: usize = 3;
    let name = name.to_lowercase();
    let mut scored: Vec<(f64, &str)> = candidates
        .into_iter()
        .map(|candidate| (strsim::normalized_damerau_levenshtein(&name, &candidate.to_lowercase()), candidate))
        .filter(|(likeness, _)| *likeness >= MIN_NAME_SIMILARITY)
        .collect();
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    let best = scored.first().map_or(0.0, |(likeness, _)| *likeness);
    let close = scored.into_iter().take_while(|(likeness, _)| best - likeness <= ALMOST_AS_ALIKE);
    close.take(MAX_PROPOSALS).map(|(_, candidate)| candidate.to_owned()).collect()
}

/// The end of a message about a wrong name: ": did you mean a, b or c?". Where nothing looks like
/// it, what to do.
pub(crate) fn suggestion(nearest: &[String], otherwise: &str) -> String {
    match nearest {
        [] => format!("; {otherwise}"),
        [only] => format!("; did you mean {only}?"),
        [first @ .., last] => format!("; did you mean {} or {last}?", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_names_come_best_first() {
        let names = ["splitter.x.omega1", "splitter.y.omega1", "splitter.x.omega2", "gravity", "tilt.rateLimit"];
        assert_eq!(nearest("spliter.x.omega1", names)[0], "splitter.x.omega1");
        assert_eq!(nearest("TILT.RATELIMIT", names), ["tilt.rateLimit"]);
        assert!(nearest("flux capacitor", names).is_empty());
    }
}
