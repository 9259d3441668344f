//! Summary of a tuning, as Markdown.

use moris_setup::{Setup, all};

use super::cost::{Channels, Cost, Objective};
use super::tuner::WORST_RATIO;

/// A recording before and after.
#[derive(Clone, Debug)]
pub struct RecordingResult {
    /// The recording's name.
    pub name: String,
    /// RMS of each desired channel, in thresholds.
    pub desired: Channels<f64>,
    /// Cost with the parameters that the search started from.
    pub before: Cost,
    /// Cost with the tuned parameters; none for a recording that was not tuned on.
    pub tuned: Option<Cost>,
    /// Cost with parameters that were tuned without this recording.
    pub unseen: Option<Cost>,
    /// True if no parameters that keep the limits were found without this recording.
    pub infeasible_without: bool,
}

impl RecordingResult {
    /// A recording with only its cost before.
    pub fn new(objective: &Objective, before: Cost) -> Self {
        let (name, desired) = (objective.name().to_owned(), *objective.desired_rms());
        RecordingResult { name, desired, before, tuned: None, unseen: None, infeasible_without: false }
    }
}

/// The channels' names.
const CHANNELS: [&str; 6] = ["force x", "force y", "force z", "rate x", "rate y", "rate z"];

/// Recordings that were not tuned on and whose error is more than 5 % above the error before.
pub fn worsened(results: &[RecordingResult]) -> Vec<&RecordingResult> {
    let unseen =
        |result: &&RecordingResult| result.unseen.is_some_and(|after| after.error > WORST_RATIO * result.before.error);
    results.iter().filter(unseen).collect()
}

/// True if the tuned parameters are worse than before in one of these ways:
///
/// - in the mean over the recordings that they were not tuned on;
/// - by more than 5 % on any recording.
pub fn is_worse(results: &[RecordingResult]) -> bool {
    let unseen = Comparison::of(results.iter().filter_map(|result| Some((result.before, result.unseen?))));
    let tuned =
        |result: &RecordingResult| result.tuned.is_some_and(|after| after.error > WORST_RATIO * result.before.error);
    unseen.is_some_and(|unseen| unseen.after > unseen.before)
        || !worsened(results).is_empty()
        || results.iter().any(tuned)
}

/// The most important result in a sentence. `fraction` is that of [`super::tested::Tested`].
pub fn first_line(results: &[RecordingResult], fraction: f64) -> String {
    if fraction == 0.0 {
        return "UNCHANGED: no fraction of the way to the best parameters for these recordings is better on recordings left out. \
                With --folds 0 the result goes all the way."
            .to_owned();
    }
    let names = |recordings: Vec<&RecordingResult>| {
        recordings.iter().map(|recording| recording.name.as_str()).collect::<Vec<_>>().join(", ")
    };
    if is_worse(results) {
        let worse = worsened(results);
        return if worse.is_empty() {
            "WORSE than before: in the mean over recordings that it was not tuned on, or on one that it was tuned on."
                .to_owned()
        } else {
            format!("WORSE than before on recordings that it was not tuned on: {}.", names(worse))
        };
    }
    match results.iter().filter(|result| result.unseen.is_some()).count() {
        0 => "No recording was held out: nothing is known of other recordings.".to_owned(),
        count => format!("Not worse than before on any of {count} recordings that it was not tuned on."),
    }
}

/// The whole summary.
pub fn text(before: &Setup, tuned: &Setup, results: &[RecordingResult], fraction: f64, interrupted: bool) -> String {
    let mut text = first_line(results, fraction);
    text += &format!("\n\n# Tuning from {} on {}\n\n", before.parameters_name, before.rig_name);
    if interrupted {
        text.push_str("The search was interrupted; this is the best result so far.\n\n");
    }
    if 0.0 < fraction && fraction < 1.0 {
        text += &format!(
            "The result goes {:.0} % of the way to the best parameters for these recordings: that is best for recordings left out. \
             With --folds 0 it goes all the way.\n\n",
            100.0 * fraction
        );
    }
    let verdict = verdict(results, &before.parameters_name);
    let (errors, comfort, channels) = (errors(results), comfort(results), channels(results));
    text + &format!("{verdict}\n\n{errors}\n{comfort}\n{channels}\n{}", parameters(before, tuned))
}

/// The mean errors before and after in a few sentences, on recordings tuned on and on others.
fn verdict(results: &[RecordingResult], before_name: &str) -> String {
    let tuned = Comparison::of(results.iter().filter_map(|result| Some((result.before, result.tuned?))));
    let unseen = Comparison::of(results.iter().filter_map(|result| Some((result.before, result.unseen?))));
    let mut text = String::new();
    if let Some(tuned) = tuned {
        text += &format!(
            "On the recordings that it was tuned on, the mean error goes from {:.3} to {:.3}",
            tuned.before, tuned.after
        );
        match tuned.limited_before {
            _ if tuned.before == tuned.after => text.push('.'),
            0 => text.push('.'),
            count => {
                text += &format!(
                    "; limits were active or the reserve was used on {count} of {} with {before_name}, on none when tuned.",
                    tuned.recordings
                )
            }
        }
    }
    text.push_str(&without_result(results));
    let Some(unseen) = unseen else {
        text.push_str(if results.iter().any(|result| result.infeasible_without) {
            " Nothing is known of other recordings."
        } else {
            " No recording was held out: nothing is known of other recordings."
        });
        return text;
    };
    let Comparison { recordings, before, after, better, .. } = unseen;
    text += &format!(
        "\n\nOn recordings that it was not tuned on, the mean error goes from {before:.3} to {after:.3}; it is better on {better} of {recordings}. \
         Limits are active, or the reserve of stroke is used, for {:.2} % of their time, with {before_name} for {:.2} %.",
        100.0 * unseen.violated_after,
        100.0 * unseen.violated_before
    );
    if unseen.before == unseen.after {
        return text;
    }
    text.push_str(if unseen.is_clearly_better() {
        " **It beats the parameters that it started from.**"
    } else {
        " **It does not clearly beat the parameters that it started from**: these recordings have too little in common, or are too few."
    });
    text
}

/// Without which recordings nothing was found; empty where there are none.
fn without_result(results: &[RecordingResult]) -> String {
    let recordings: Vec<&str> =
        results.iter().filter(|result| result.infeasible_without).map(|result| result.name.as_str()).collect();
    if recordings.is_empty() {
        return String::new();
    }
    format!(
        "\n\nTuned without {}, no parameters were found that keep the limits on the others: nothing is known of it as a recording not tuned on. \
         More --evaluations may find some.",
        recordings.join(", or ")
    )
}

/// Errors before and after over some recordings.
struct Comparison {
    recordings: usize,
    before: f64,
    after: f64,
    better: usize,
    limited_before: usize,
    violated_before: f64,
    violated_after: f64,
}

impl Comparison {
    /// Better on average and on most recordings, and limited for hardly longer.
    fn is_clearly_better(&self) -> bool {
        /// Fraction of the time.
        const HARDLY: f64 = 0.01;
        self.after < self.before
            && 2 * self.better > self.recordings
            && self.violated_after <= self.violated_before + HARDLY
    }

    fn of(pairs: impl Iterator<Item = (Cost, Cost)>) -> Option<Self> {
        let pairs: Vec<(Cost, Cost)> = pairs.collect();
        let mean = |error: fn(&(Cost, Cost)) -> f64| pairs.iter().map(error).sum::<f64>() / pairs.len() as f64;
        let count = |holds: fn(&(Cost, Cost)) -> bool| pairs.iter().filter(|pair| holds(pair)).count();
        (!pairs.is_empty()).then(|| Comparison {
            recordings: pairs.len(),
            before: mean(|pair| pair.0.error),
            after: mean(|pair| pair.1.error),
            better: count(|pair| pair.1.error < pair.0.error),
            limited_before: count(|pair| !pair.0.is_feasible()),
            violated_before: mean(|pair| pair.0.violated),
            violated_after: mean(|pair| pair.1.violated),
        })
    }
}

fn errors(results: &[RecordingResult]) -> String {
    let cell = |cost: &Option<Cost>| cost.map_or_else(|| "–".to_owned(), |cost| with_limits(&cost));
    let unseen = |result: &RecordingResult| match result.infeasible_without {
        true => "none found".to_owned(),
        false => cell(&result.unseen),
    };
    let rows = results
        .iter()
        .map(|result| [result.name.clone(), with_limits(&result.before), cell(&result.tuned), unseen(result)]);
    table(["recording", "before", "tuned", "tuned without it"], rows)
}

/// The error, and what fraction of the time limits were active.
fn with_limits(cost: &Cost) -> String {
    match cost.violated {
        0.0 => format!("{:.3}", cost.error),
        fraction => format!("{:.3} (limits {:.2} %)", cost.error, 100.0 * fraction),
    }
}

fn comfort(results: &[RecordingResult]) -> String {
    let row = |result: &RecordingResult| {
        let after = result.tuned.or(result.unseen).unwrap_or(result.before);
        let cell = |k: usize| format!("{:.2} → {:.2}", result.before.comfort[k], after.comfort[k]);
        [result.name.clone(), cell(0), cell(1), cell(2)]
    };
    table(["felt force, m/s²: before → after", "shake", "jolt", "peak"], results.iter().map(row))
}

fn channels(results: &[RecordingResult]) -> String {
    let row = |result: &RecordingResult| {
        let after = result.tuned.or(result.unseen).unwrap_or(result.before);
        let cell =
            |k: usize| format!("{:.2}: {:.2} → {:.2}", result.desired[k], result.before.channels[k], after.channels[k]);
        let [x, y, z, p, q, r] = std::array::from_fn(cell);
        [result.name.clone(), x, y, z, p, q, r]
    };
    let [x, y, z, p, q, r] = CHANNELS;
    table(["thresholds, desired: error before → after", x, y, z, p, q, r], results.iter().map(row))
}

/// A number with three decimals, or with three digits where that leaves too few.
fn significant(value: f64) -> String {
    if value != 0.0 && value.abs() < 0.01 { format!("{value:.2e}") } else { format!("{value:.3}") }
}

fn parameters(before: &Setup, tuned: &Setup) -> String {
    let pairs = all(&before.parameters).into_iter().zip(all(&tuned.parameters));
    let changed = pairs.filter(|(old, new)| old.1 != new.1);
    let row = |((name, old), (_, new)): ((String, f64), (String, f64))| [name, significant(old), significant(new)];
    table(["parameter", "before", "tuned"], changed.map(row))
}

/// A Markdown table whose columns are aligned for those who read it as text.
fn table<const N: usize>(header: [&str; N], rows: impl Iterator<Item = [String; N]>) -> String {
    let mut all = vec![header.map(str::to_owned)];
    all.extend(rows);
    let widths: [usize; N] =
        std::array::from_fn(|k| all.iter().map(|row| row[k].chars().count()).max().unwrap_or(0).max(3));
    let mut text = String::new();
    for (index, row) in all.iter().enumerate() {
        for (cell, &width) in row.iter().zip(&widths) {
            text += &format!("| {cell:<width$} ");
        }
        text.push_str("|\n");
        if index == 0 {
            widths.iter().for_each(|width| text.push_str(&format!("|{}", "-".repeat(width + 2))));
            text.push_str("|\n");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cost(error: f64, violated: f64) -> Cost {
        Cost { channels: [error; 6], error, violated, comfort: [0.0; 3], excess: 0.0 }
    }

    fn result(before: Cost, unseen: Option<Cost>) -> RecordingResult {
        let tuned = Some(cost(0.5, 0.0));
        RecordingResult { name: "ride".to_owned(), desired: [1.0; 6], before, tuned, unseen, infeasible_without: false }
    }

    #[test]
    fn what_is_worse_on_rides_not_tuned_on_is_said_first() {
        let of = |pairs: &[(f64, f64)]| -> Vec<RecordingResult> {
            pairs.iter().map(|&(before, unseen)| result(cost(before, 0.0), Some(cost(unseen, 0.0)))).collect()
        };
        let better = of(&[(0.8, 0.6), (0.9, 0.92)]);
        assert!(!is_worse(&better) && first_line(&better, 1.0).starts_with("Not worse than before on any of 2"));
        let one_worse = of(&[(0.8, 0.3), (0.9, 0.96)]);
        assert!(
            is_worse(&one_worse)
                && first_line(&one_worse, 1.0) == "WORSE than before on recordings that it was not tuned on: ride."
        );
        let worse_in_the_mean = of(&[(0.8, 0.83), (0.9, 0.92)]);
        assert!(is_worse(&worse_in_the_mean) && first_line(&worse_in_the_mean, 1.0).contains("in the mean"));
        let unknown = vec![result(cost(0.8, 0.0), None)];
        assert!(!is_worse(&unknown) && first_line(&unknown, 1.0).starts_with("No recording was held out"));
        let tuned_worse = RecordingResult { tuned: Some(cost(0.9, 0.0)), ..unknown[0].clone() };
        assert!(is_worse(&[tuned_worse]));
        assert!(first_line(&better, 0.0).starts_with("UNCHANGED"));
    }

    const BEATS: &str = "**It beats the parameters that it started from.**";

    #[test]
    fn better_on_average_and_on_most_rides_beats() {
        let results = [(0.8, 0.6), (0.9, 0.7), (0.5, 0.6)];
        let results = results.map(|(before, unseen)| result(cost(before, 0.0), Some(cost(unseen, 0.0))));
        let text = verdict(&results, "default");
        assert!(text.contains("goes from 0.733 to 0.633; it is better on 2 of 3") && text.contains(BEATS), "{text}");
    }

    #[test]
    fn better_on_average_by_one_ride_alone_or_at_the_price_of_limits_does_not() {
        let results = [(3.0, 1.0), (0.5, 0.6), (0.5, 0.6)];
        let results = results.map(|(before, unseen)| result(cost(before, 0.0), Some(cost(unseen, 0.0))));
        assert!(!verdict(&results, "default").contains(BEATS));
        let results = [0.0, 0.03].map(|violated| result(cost(0.8, 0.0), Some(cost(0.4, violated))));
        assert!(!verdict(&results, "default").contains(BEATS));
    }

    #[test]
    fn what_was_not_held_out_is_not_claimed() {
        let text = verdict(&[result(cost(0.8, 0.02), None)], "default");
        assert!(text.contains("No recording was held out: nothing is known of other recordings."), "{text}");
        assert!(text.contains("limits were active or the reserve was used on 1 of 1 with default"), "{text}");
        assert!(!text.contains(BEATS));
    }

    #[test]
    fn a_ride_without_which_nothing_was_found_is_named_and_does_not_count() {
        let found = result(cost(0.8, 0.0), Some(cost(0.6, 0.0)));
        let not = RecordingResult { name: "wild".to_owned(), infeasible_without: true, ..result(cost(0.9, 0.0), None) };
        let text = verdict(&[found.clone(), not.clone()], "default");
        assert!(text.contains("Tuned without wild, no parameters were found"), "{text}");
        assert!(text.contains("better on 1 of 1"), "{text}");
        assert!(errors(&[found, not.clone()]).lines().any(|line| line.contains("wild") && line.contains("none found")));
        let text = verdict(&[not], "default");
        assert!(text.ends_with("Nothing is known of other recordings.") && !text.contains("held out"), "{text}");
    }

    #[test]
    fn a_table_is_markdown_and_aligned() {
        let text = table(["ride", "x"], [["a".to_owned(), "1 → 2".to_owned()]].into_iter());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[1], "|------|-------|");
        assert!(lines.iter().all(|line| line.chars().count() == lines[0].chars().count()));
    }
}
