//! The search for samples that no vehicle causes.

use moris_washout::interface::STANDARD_GRAVITY;

use crate::recording::conventions::{Dimension, Quantity};
use crate::recording::signal::{extremes, median, runs, sorted};
use crate::recording::table::Table;

/// Shortest run of the extreme value that is a flat top \[samples\].
pub const MIN_FLAT_SAMPLES: usize = 4;

/// The largest plausible size of a quantity, beyond which an isolated sample is a spike whatever
/// the spread, and the least deviation of a spike, in SI units.
fn largest_and_least_spike(dimension: Dimension) -> (f64, f64) {
    match dimension {
        // 10 g; a kerb; and 2000 degrees a second.
        Dimension::Force => (98.0665, 5.0),
        Dimension::Rate => (35.0, 1.0),
        Dimension::Angle => (7.0, 0.3),
        Dimension::Speed => (150.0, 5.0),
        Dimension::Time | Dimension::Length => (f64::INFINITY, f64::INFINITY),
    }
}

/// Samples with the error values of loggers.
pub fn error_values(table: &Table, quantity: Quantity, values: &[f64]) -> Vec<usize> {
    // Values that loggers and converters write where they have none, of either sign.
    const ERROR_VALUES: [f64; 7] = [9999.0, 99_999.0, 32_767.0, 32_768.0, 65_535.0, 999_999.0, 1e6];
    let unit = table.unit(quantity).0.in_si;
    let (largest, _) = largest_and_least_spike(quantity.dimension());
    let is_error = |value: f64| {
        let written = (value / unit).abs();
        value.abs() > largest && ERROR_VALUES.iter().any(|error| (written / error - 1.0).abs() < 1e-9)
    };
    (0..values.len()).filter(|&k| is_error(values[k])).collect()
}

/// Isolated samples: one or two that are far from those before and after them.
pub fn spikes(quantity: Quantity, values: &[f64]) -> Vec<usize> {
    // Samples on either side of a sample whose median shows that it is isolated.
    const NEIGHBOURS: usize = 2;
    // Samples on either side whose spread is the local one.
    const AROUND: usize = 50;
    // Standard deviations beyond which an isolated sample is a spike.
    const SPREADS: f64 = 20.0;
    // Angles jump by a turn.
    if quantity.is_angle() {
        return Vec::new();
    }
    let (largest, least_spike) = largest_and_least_spike(quantity.dimension());
    let window = |k: usize, reach: usize| k.saturating_sub(reach)..(k + reach + 1).min(values.len());
    let deviation = |k: usize| (values[k] - median(values[window(k, NEIGHBOURS)].iter().copied())).abs();
    let deviations: Vec<f64> = (0..values.len()).map(deviation).collect();
    let is_spike = |&k: &usize| {
        let around = || robust_spread(deviations[window(k, AROUND)].iter().copied());
        deviations[k] > least_spike && (values[k].abs() > largest || deviations[k] > SPREADS * around())
    };
    (0..values.len()).filter(is_spike).collect()
}

/// Standard deviation of sizes, which a few spikes among them do not change.
fn robust_spread(sizes: impl Iterator<Item = f64>) -> f64 {
    // The 90 % quantile of sizes in standard deviations: a tenth of the samples may be spikes.
    const QUANTILE: f64 = 1.645;
    let sizes = sorted(sizes);
    sizes[sizes.len() * 9 / 10] / QUANTILE
}

/// True if the values before or after a run would not have come to rest at its value. A sensor at
/// the end of its range stops them, and what is computed slows down before.
fn is_cut(values: &[f64], first: usize, length: usize) -> bool {
    // Samples in which what slows down towards a flat top of its own comes to rest, at most.
    const SLOWED: f64 = 2.0;
    // The three values next to an end of the run, the nearest first.
    let is_stopped = |beside: [Option<f64>; 3]| {
        let [Some(near), Some(farther), Some(farthest)] = beside else { return false };
        let (last, earlier) = ((farther - near).abs(), (farthest - farther).abs());
        last > 0.0 && last > SLOWED * (earlier - last)
    };
    is_stopped([1, 2, 3].map(|k| first.checked_sub(k).map(|k| values[k])))
        || is_stopped([0, 1, 2].map(|k| values.get(first + length + k).copied()))
}

/// First samples of the runs of the greatest, and of the least value, at which a sensor would have
/// been cut off.
pub fn flat_tops(values: &[f64]) -> Vec<Vec<usize>> {
    // Shortest flat top in lengths of the longest run of any other value: signals of few digits have
    // long runs.
    const FLAT_RUNS: usize = 3;
    // Least distance of a flat top from the values at rest [fractions of the signal's range].
    const AWAY: f64 = 0.1;
    let (least, greatest) = extremes(values.iter().copied());
    let runs: Vec<(usize, usize)> = runs(values, |a, b| a == b).map(|run| (run.start, run.len())).collect();
    // A computed ride stands still at the extreme where all its bends are to one side.
    let usual = median(values.iter().copied());
    let is_rest = |extreme: &f64| {
        let near = |value: f64| (extreme - value).abs() < AWAY * (greatest - least);
        near(usual) || near(0.0) || near(STANDARD_GRAVITY)
    };
    let is_extreme = |first: usize| [least, greatest].contains(&values[first]) && !is_rest(&values[first]);
    let longest = runs.iter().filter(|(first, _)| !is_extreme(*first)).map(|(_, length)| *length).max();
    // A signal of one or two values is not measured.
    let Some(longest) = longest else { return Vec::new() };
    let tops = |extreme: f64| -> Vec<usize> {
        let is_flat = |&&(first, length): &&(usize, usize)| {
            values[first] == extreme && length >= MIN_FLAT_SAMPLES && length >= FLAT_RUNS * longest
        };
        let flat: Vec<(usize, usize)> = runs.iter().filter(is_flat).copied().collect();
        if !flat.iter().any(|&(first, length)| is_cut(values, first, length)) {
            return Vec::new();
        }
        flat.into_iter().map(|(first, _)| first).collect()
    };
    [least, greatest]
        .into_iter()
        .filter(|extreme| !is_rest(extreme))
        .map(tops)
        .filter(|tops| !tops.is_empty())
        .collect()
}
