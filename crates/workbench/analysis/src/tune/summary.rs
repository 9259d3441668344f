//! Summary of a tuning, as Markdown, with a face's words for the options that help.

use moris_interface::{Group as _, Kind, Row};
use moris_setup::{Setup, all};
use moris_simulation::frequency_response::channel::name;
use moris_simulation::measures::statistics::mean_of_any;
use moris_washout::Parameters;
use moris_washout::platform::reach::Axis;

use super::cost::{Channels, Cost, Objective, still_channels};
use super::tuner::WORST_RATIO;
use crate::message::{Message, Words};
use crate::text_table::{TextTable, or_undefined};
use crate::texts::text;

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

    /// True if the tuned parameters are worse on this recording, tuned on or not.
    fn is_worse(&self) -> bool {
        [self.tuned, self.unseen].into_iter().flatten().any(|after| !recording_losses(&self.before, &after).is_empty())
    }
}

/// The measures of comfort.
const COMFORT_MEASURES: [&str; 3] = ["shake", "jolt", "peak"];
/// Fraction of the time by which limits may be active longer than before.
const MAX_EXTRA_LIMITED_FRACTION: f64 = 0.01;

/// The result of a tuning in one word, for headline, table and exit status alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The parameters are those before.
    Unchanged,
    /// Worse on a recording, or in the mean over those that were not tuned on.
    Worse,
    /// Better in the mean and on most recordings that were not tuned on.
    Better,
    /// Neither better nor worse beyond doubt.
    NotClear,
    /// No recording was held out.
    Unknown,
}

impl Verdict {
    /// Verdict on these results. `fraction` is that of [`super::tested::Tested`].
    pub fn of(results: &[RecordingResult], fraction: f64) -> Self {
        match Comparison::unseen(results) {
            _ if fraction == 0.0 => Verdict::Unchanged,
            Some(unseen) if unseen.is_worse() => Verdict::Worse,
            _ if results.iter().any(RecordingResult::is_worse) => Verdict::Worse,
            None => Verdict::Unknown,
            Some(unseen) if unseen.is_clearly_better() => Verdict::Better,
            Some(_) => Verdict::NotClear,
        }
    }
}

/// Measures that are worse than before on a recording, with their figures:
///
/// - an error larger by more than 5 %,
/// - limits that are active, or the reserve of stroke used, for longer by more
///   than 1 % of the time,
/// - shake, jolt or peak beyond their bounds.
fn recording_losses(before: &Cost, after: &Cost) -> Vec<String> {
    let mut losses = Vec::new();
    if after.error > WORST_RATIO * before.error {
        losses.push(format!("error {:.3} → {:.3}", before.error, after.error));
    }
    if after.violated > before.violated + MAX_EXTRA_LIMITED_FRACTION {
        losses.push(format!("limits {:.1} → {:.1} % of the time", 100.0 * before.violated, 100.0 * after.violated));
    }
    if after.excess > before.excess {
        let grown = (0..3).filter(|&k| after.comfort[k] > before.comfort[k]);
        losses.extend(
            grown.map(|k| format!("{} {:.2} → {:.2} m/s²", COMFORT_MEASURES[k], before.comfort[k], after.comfort[k])),
        );
    }
    losses
}

/// The most important result in a sentence. `fraction` is that of [`super::tested::Tested`].
pub fn first_line(results: &[RecordingResult], fraction: f64, words: Words) -> String {
    let line = match Verdict::of(results, fraction) {
        Verdict::Unchanged => text!["tuning-unchanged"],
        Verdict::Unknown => text!["tuning-unknown"],
        Verdict::Worse => worse_line(results).into(),
        Verdict::Better => text!["tuning-better", figures = mean_figures(results)],
        Verdict::NotClear => text!["tuning-not-clear", figures = mean_figures(results)],
    };
    line.worded(words)
}

/// The recordings on which it is worse, with what is worse on each.
fn worse_line(results: &[RecordingResult]) -> String {
    let of = |cost: fn(&RecordingResult) -> Option<Cost>| -> Vec<String> {
        let worse = |result: &RecordingResult| {
            let losses = recording_losses(&result.before, &cost(result)?);
            (!losses.is_empty()).then(|| format!("{} ({})", result.name, losses.join(", ")))
        };
        results.iter().filter_map(worse).collect()
    };
    let (unseen, tuned) = (of(|result| result.unseen), of(|result| result.tuned));
    if !unseen.is_empty() {
        format!("WORSE than before on recordings that it was not tuned on: {}.", unseen.join("; "))
    } else if !tuned.is_empty() {
        format!("WORSE than before on recordings that it was tuned on: {}.", tuned.join("; "))
    } else {
        format!("WORSE than before in the mean over recordings that it was not tuned on: {}.", mean_figures(results))
    }
}

/// The means over the recordings that were not tuned on, before and after.
fn mean_figures(results: &[RecordingResult]) -> String {
    let Some(Comparison { recordings, before, after, better, violated_before, violated_after, .. }) =
        Comparison::unseen(results)
    else {
        return String::new();
    };
    let limits = match (violated_before, violated_after) {
        (0.0, 0.0) => "no limit active".to_owned(),
        (before, after) => format!("limits {:.1} → {:.1} % of the time", 100.0 * before, 100.0 * after),
    };
    format!("mean error {before:.3} → {after:.3}, smaller on {better} of {recordings}, {limits}")
}

/// The summary of a tuning, as text.
pub fn text(
    before: &Setup,
    tuned: &Setup,
    results: &[RecordingResult],
    fraction: f64,
    interrupted: bool,
    words: Words,
) -> String {
    let mut text = first_line(results, fraction, words);
    text += &format!("\n\n# Tuning from {} on {}\n\n", before.parameters_name, before.rig_name);
    if interrupted {
        text.push_str("The search was interrupted; this is the best result so far.\n\n");
    }
    if 0.0 < fraction && fraction < 1.0 {
        text += &text!["tuning-part-of-the-way", percent = 100.0 * fraction].worded(words);
    }
    let tuned_on = results.iter().filter(|result| result.tuned.is_some());
    let is_still = still_channels(tuned_on.map(|result| &result.desired));
    let still: Vec<&str> = (0..6).filter(|&k| is_still[k]).map(|k| name(Axis::ALL[k])).collect();
    if !still.is_empty() {
        text += &text!["tuning-still", channels = still.join(", ")].worded(words);
    }
    let verdict = verdict_text(results, &before.parameters_name).worded(words);
    let tables = [
        error_table(results),
        shape_table(results),
        comfort_table(results),
        channel_table(results),
        parameter_table(before, tuned),
    ];
    text + &format!("{verdict}\n\n{}", tables.join("\n"))
}

/// The mean errors before and after in a few sentences, on recordings tuned on and on others.
fn verdict_text(results: &[RecordingResult], name: &str) -> Message {
    let tuned = Comparison::of(results.iter().filter_map(|result| Some((result.before, result.tuned?))));
    let mut text = Message::default();
    if let Some(Comparison { recordings, before, after, limited_before, .. }) = tuned {
        text.push(text!["tuning-errors", before, after]);
        text.push(match limited_before {
            count if count > 0 && before != after => text!["tuning-limits", count, recordings, name],
            _ => ".".into(),
        });
    }
    let without = results.iter().filter(|result| result.infeasible_without).map(|result| result.name.as_str());
    let without = without.collect::<Vec<_>>().join(", or ");
    if !without.is_empty() {
        text.push(text!["tuning-without", recordings = &without]);
    }
    let Some(unseen) = Comparison::unseen(results) else {
        let other = if without.is_empty() { text!["tuning-unknown"] } else { text!["tuning-unknown-without"] };
        text.push(" ");
        text.push(other);
        return text;
    };
    let Comparison { recordings, before, after, better, .. } = unseen;
    let (limited, limited_before) = (100.0 * unseen.violated_after, 100.0 * unseen.violated_before);
    text.push(text!["tuning-errors-unseen", before, after, better, recordings, limited, name, limited_before]);
    text
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
    /// Over the recordings that were not tuned on.
    fn unseen(results: &[RecordingResult]) -> Option<Self> {
        Comparison::of(results.iter().filter_map(|result| Some((result.before, result.unseen?))))
    }

    /// Worse on average, or limited for longer.
    fn is_worse(&self) -> bool {
        self.after > self.before || self.violated_after > self.violated_before + MAX_EXTRA_LIMITED_FRACTION
    }

    /// Better on average and on most recordings, and limited for hardly longer.
    fn is_clearly_better(&self) -> bool {
        self.after < self.before
            && 2 * self.better > self.recordings
            && self.violated_after <= self.violated_before + MAX_EXTRA_LIMITED_FRACTION
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

fn error_table(results: &[RecordingResult]) -> String {
    let cell = |cost: &Option<Cost>| or_undefined(cost.as_ref().map(with_limits));
    let unseen = |result: &RecordingResult| {
        if result.infeasible_without { "none found".to_owned() } else { cell(&result.unseen) }
    };
    let rows = results
        .iter()
        .map(|result| [result.name.clone(), with_limits(&result.before), cell(&result.tuned), unseen(result)]);
    markdown_table(["error (1: platform at rest)", "before", "tuned", "tuned without it"], rows)
}

/// The error, and what fraction of the time limits were active.
fn with_limits(cost: &Cost) -> String {
    match cost.violated {
        0.0 => format!("{:.3}", cost.error),
        fraction => format!("{:.3} (limits {:.2} % of the time)", cost.error, 100.0 * fraction),
    }
}

/// Shape, inverted time and size of surge and sway, where they count.
fn shape_table(results: &[RecordingResult]) -> String {
    let rows = results.iter().flat_map(|result| {
        let after = result.tuned.or(result.unseen).unwrap_or(result.before);
        let row = move |axis: usize| {
            let (before, after) = (result.before.shape.axes[axis]?, after.shape.axes[axis]?);
            Some([
                format!("{}, {}", result.name, ["surge", "sway"][axis]),
                format!("{:.2} → {:.2}", before.shape, after.shape),
                format!("{:.1} → {:.1} %", 100.0 * before.inverted, 100.0 * after.inverted),
                format!("{:.2} → {:.2}", before.size, after.size),
            ])
        };
        (0..2).filter_map(row)
    });
    markdown_table(["felt below 2 Hz: before → after", "shape", "inverted", "size"], rows)
}

/// A strategy's tuning among others'.
#[derive(Clone, Debug)]
pub struct OfStrategy {
    /// The strategy's name.
    pub name: String,
    /// The set's recordings; none where no parameters keep the limits.
    pub results: Option<Vec<RecordingResult>>,
}

/// The cost that counts: on recordings that were not tuned on where there are any.
fn counting_costs(results: &[RecordingResult]) -> Vec<Cost> {
    let unseen: Vec<Cost> = results.iter().filter_map(|result| result.unseen).collect();
    if unseen.is_empty() { results.iter().filter_map(|result| result.tuned).collect() } else { unseen }
}

/// Index of the strategy with the least mean error on recordings that were not tuned on, or where
/// there are none on those that were. None where no strategy has a result.
pub fn winner(strategies: &[OfStrategy]) -> Option<usize> {
    let error = |index: usize| {
        let costs = counting_costs(strategies[index].results.as_ref()?);
        Some((index, mean_of_any(costs.iter().map(|cost| cost.error))?))
    };
    let least = |best: (usize, f64), next: (usize, f64)| if next.1 < best.1 { next } else { best };
    (0..strategies.len()).filter_map(error).reduce(least).map(|(index, _)| index)
}

/// A table of the strategies with the winner below it.
pub fn strategies(strategies: &[OfStrategy]) -> String {
    let row = |strategy: &OfStrategy| {
        let Some(results) = &strategy.results else {
            return [strategy.name.as_str(), "none found", "", "", "", "", ""].map(str::to_owned);
        };
        let error = |of: fn(&RecordingResult) -> Option<Cost>| {
            let mean = mean_of_any(results.iter().filter_map(of).map(|cost| cost.error));
            or_undefined(mean.map(|error| format!("{error:.3}")))
        };
        let costs = counting_costs(results);
        let axes = || costs.iter().flat_map(|cost| cost.shape.axes).flatten();
        let shape = mean_of_any(axes().map(|axis| axis.shape)).map(|shape| format!("{shape:.2}"));
        let inverted =
            mean_of_any(axes().map(|axis| axis.inverted)).map(|inverted| format!("{:.1} %", 100.0 * inverted));
        let size = mean_of_any(axes().map(|axis| axis.size.ln())).map(|size| format!("{:.2}", size.exp()));
        [
            strategy.name.clone(),
            error(|result| Some(result.before)),
            error(|result| result.tuned),
            error(|result| result.unseen),
            or_undefined(shape),
            or_undefined(inverted),
            or_undefined(size),
        ]
    };
    let header = ["mean error", "before", "tuned", "tuned without it", "shape", "inverted", "size"];
    let winner = winner(strategies).map_or("none", |index| strategies[index].name.as_str());
    format!("{}\nwinner: {winner}\n", markdown_table(header, strategies.iter().map(row)))
}

fn comfort_table(results: &[RecordingResult]) -> String {
    let row = |result: &RecordingResult| {
        let after = result.tuned.or(result.unseen).unwrap_or(result.before);
        let cell = |k: usize| format!("{:.2} → {:.2}", result.before.comfort[k], after.comfort[k]);
        [result.name.clone(), cell(0), cell(1), cell(2)]
    };
    let [shake, jolt, peak] = COMFORT_MEASURES;
    markdown_table(["felt force, m/s²: before → after", shake, jolt, peak], results.iter().map(row))
}

fn channel_table(results: &[RecordingResult]) -> String {
    let row = |result: &RecordingResult| {
        let after = result.tuned.or(result.unseen).unwrap_or(result.before);
        let cell =
            |k: usize| format!("{:.2}: {:.2} → {:.2}", result.desired[k], result.before.channels[k], after.channels[k]);
        let [x, y, z, p, q, r] = std::array::from_fn(cell);
        [result.name.clone(), x, y, z, p, q, r]
    };
    let [x, y, z, p, q, r] = Axis::ALL.map(name);
    markdown_table(["RMS in thresholds, desired: error before → after", x, y, z, p, q, r], results.iter().map(row))
}

/// A number with three decimals, or with three digits where that leaves too few.
fn significant_digits(value: f64) -> String {
    if value != 0.0 && value.abs() < 0.01 { format!("{value:.2e}") } else { format!("{value:.3}") }
}

fn parameter_table(before: &Setup, tuned: &Setup) -> String {
    let pairs = all(&before.parameters).into_iter().zip(all(&tuned.parameters));
    let changed = pairs.filter(|(old, new)| old.1 != new.1);
    let row = |((name, old), (_, new)): ((String, f64), (String, f64))| {
        let unit = unit_of(&name);
        [name, significant_digits(old), significant_digits(new), unit.to_owned()]
    };
    markdown_table(["parameter", "before", "tuned", "unit"], changed.map(row))
}

/// Unit of a parameter; empty for a number without.
fn unit_of(name: &str) -> &'static str {
    let has_name = |row: &&Row| (0..row.slots()).any(|element| row.variable_name(element) == name);
    match Parameters::ROWS.iter().find(has_name).map(|row| row.kind) {
        Some(Kind::Real(unit)) => unit.name,
        _ => "",
    }
}

fn markdown_table<const N: usize>(header: [&str; N], rows: impl Iterator<Item = [String; N]>) -> String {
    let mut table = TextTable::new(header);
    rows.for_each(|row| table.push(row.into()));
    table.markdown()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::message::Remedy;

    fn words(remedy: &Remedy) -> String {
        remedy.option.to_owned()
    }

    fn cost(error: f64, violated: f64) -> Cost {
        Cost { error, violated, ..Cost::default() }
    }

    fn result(before: Cost, unseen: Option<Cost>) -> RecordingResult {
        let tuned = Some(cost(0.5, 0.0));
        RecordingResult { name: "ride".to_owned(), desired: [1.0; 6], before, tuned, unseen, infeasible_without: false }
    }

    fn of(pairs: &[(Cost, Cost)]) -> Vec<RecordingResult> {
        pairs.iter().map(|&(before, unseen)| result(before, Some(unseen))).collect()
    }

    fn free(pairs: &[(f64, f64)]) -> Vec<RecordingResult> {
        of(&pairs.iter().map(|&(before, unseen)| (cost(before, 0.0), cost(unseen, 0.0))).collect::<Vec<_>>())
    }

    /// Verdict and headline.
    fn judged(results: &[RecordingResult]) -> (Verdict, String) {
        (Verdict::of(results, 1.0), first_line(results, 1.0, words))
    }

    #[test]
    fn what_is_worse_on_rides_not_tuned_on_is_said_first() {
        let (verdict, line) = judged(&free(&[(0.8, 0.3), (0.9, 0.96)]));
        assert_eq!(verdict, Verdict::Worse);
        assert_eq!(line, "WORSE than before on recordings that it was not tuned on: ride (error 0.900 → 0.960).");
        let (verdict, line) = judged(&free(&[(0.8, 0.83), (0.9, 0.92)]));
        assert!(verdict == Verdict::Worse && line.contains("in the mean") && line.contains("0.850 → 0.875"), "{line}");
        let unknown = vec![result(cost(0.8, 0.0), None)];
        assert!(judged(&unknown).0 == Verdict::Unknown && judged(&unknown).1.starts_with("No recording was held out"));
        let tuned_worse = RecordingResult { tuned: Some(cost(0.9, 0.0)), ..unknown[0].clone() };
        let (verdict, line) = judged(&[tuned_worse]);
        assert!(
            verdict == Verdict::Worse && line.contains("that it was tuned on: ride (error 0.800 → 0.900)"),
            "{line}"
        );
        assert!(first_line(&free(&[(0.8, 0.6)]), 0.0, words).starts_with("UNCHANGED"));
    }

    /// An error within 5 % and longer limits are not better, whatever the other recording gains.
    #[test]
    fn limits_and_comfort_count_as_the_error_does() {
        let longer = of(&[(cost(0.944, 0.008), cost(0.979, 0.077)), (cost(0.9, 0.0), cost(0.7, 0.0))]);
        let (verdict, line) = judged(&longer);
        assert_eq!(verdict, Verdict::Worse);
        assert!(line.ends_with("ride (limits 0.8 → 7.7 % of the time)."), "{line}");
        let jolting = Cost { comfort: [0.1, 6.0, 1.0], excess: 0.5, ..cost(0.5, 0.0) };
        let (verdict, line) = judged(&of(&[(Cost { comfort: [0.1, 2.0, 1.0], ..cost(0.8, 0.0) }, jolting)]));
        assert!(verdict == Verdict::Worse && line.ends_with("ride (jolt 2.00 → 6.00 m/s²)."), "{line}");
    }

    #[test]
    fn better_on_average_and_on_most_rides_is_better() {
        let results = free(&[(0.8, 0.6), (0.9, 0.7), (0.5, 0.52)]);
        let (found, line) = judged(&results);
        assert_eq!(found, Verdict::Better);
        assert!(line.ends_with("mean error 0.733 → 0.607, smaller on 2 of 3, no limit active."), "{line}");
        assert!(
            verdict_text(&results, "default")
                .worded(words)
                .contains("goes from 0.733 to 0.607; it is better on 2 of 3")
        );
    }

    #[test]
    fn better_on_average_by_one_ride_alone_is_not_clear() {
        assert_eq!(judged(&free(&[(3.0, 1.0), (0.5, 0.52), (0.5, 0.51)])).0, Verdict::NotClear);
    }

    #[test]
    fn what_was_not_held_out_is_not_claimed() {
        let text = verdict_text(&[result(cost(0.8, 0.02), None)], "default").worded(words);
        assert!(text.contains("No recording was held out: nothing is known of other recordings."), "{text}");
        assert!(text.contains("limits were active or the reserve was used on 1 of 1 with default"), "{text}");
    }

    #[test]
    fn a_ride_without_which_nothing_was_found_is_named_and_does_not_count() {
        let found = result(cost(0.8, 0.0), Some(cost(0.6, 0.0)));
        let not = RecordingResult { name: "wild".to_owned(), infeasible_without: true, ..result(cost(0.9, 0.0), None) };
        let text = verdict_text(&[found.clone(), not.clone()], "default").worded(words);
        assert!(text.contains("Tuned without wild, no parameters were found"), "{text}");
        assert!(text.contains("better on 1 of 1"), "{text}");
        assert!(
            error_table(&[found, not.clone()]).lines().any(|line| line.contains("wild") && line.contains("none found"))
        );
        let text = verdict_text(&[not], "default").worded(words);
        assert!(text.ends_with("Nothing is known of other recordings.") && !text.contains("held out"), "{text}");
    }

    #[test]
    fn channels_without_a_desired_motion_are_named_once() {
        let setup = Setup::load(None, &[]).unwrap();
        let said = |desired: Channels<f64>| {
            let result = RecordingResult { desired, ..result(cost(0.8, 0.0), None) };
            text(&setup, &setup, &[result], 1.0, false, words)
        };
        let found = said([2.0, 0.0, 0.0, 1.0, 0.05, 1.0]);
        assert!(found.contains("The recordings have no sway, heave, pitch rate: parameters of these"), "{found}");
        assert!(!said([1.0; 6]).contains("The recordings have no"));
    }

    #[test]
    fn a_table_is_markdown_and_aligned() {
        let text = markdown_table(["ride", "x"], [["a".to_owned(), "1 → 2".to_owned()]].into_iter());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[1], "|------|-------|");
        assert!(lines.iter().all(|line| line.chars().count() == lines[0].chars().count()));
    }
}
