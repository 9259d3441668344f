//! Samples that no vehicle causes: error values of loggers, isolated spikes, and flat tops of a
//! sensor that is at the end of its range.

use moris_interface::shown;
use moris_washout::interface::STANDARD_GRAVITY;

use crate::recording::conventions::{Dimension, Quantity};
use crate::recording::message::{RecordingError, given};
use crate::recording::signal::{median, sorted};
use crate::recording::table::Table;

/// Values that loggers and converters write where they have none, of either sign.
const ERROR_VALUES: [f64; 7] = [9999.0, 99_999.0, 32_767.0, 32_768.0, 65_535.0, 999_999.0, 1e6];
/// Samples on either side of a sample whose median shows that it is isolated.
const NEIGHBOURS: usize = 2;
/// Samples on either side whose spread is the local one.
const AROUND: usize = 50;
/// Standard deviations beyond which an isolated sample is a spike.
const SPREADS: f64 = 20.0;
/// The 90 % quantile of sizes in standard deviations: a tenth of the samples may be spikes.
const QUANTILE: f64 = 1.645;
/// Shortest run of the extreme value that is a flat top \[samples\].
const FLAT: usize = 4;
/// The same in lengths of the longest run of any other value, which signals of few digits have.
const FLAT_RUNS: usize = 3;
/// Least distance of a flat top from the values at rest \[fractions of the signal's range\].
const AWAY: f64 = 0.1;
/// Largest number of times that a message lists.
const MOST_LISTED: usize = 5;

/// Plausible values of a quantity, in SI units.
struct Range {
    /// Beyond it an isolated sample is a spike, whatever the spread.
    largest: f64,
    /// Least deviation of a spike.
    least_spike: f64,
}

fn range(dimension: Dimension) -> Range {
    let (largest, least_spike) = match dimension {
        // 10 g; a kerb; and 2000 degrees a second.
        Dimension::Force => (98.0665, 5.0),
        Dimension::Rate => (35.0, 1.0),
        Dimension::Angle => (7.0, 0.3),
        Dimension::Speed => (150.0, 5.0),
        Dimension::Time => (f64::INFINITY, f64::INFINITY),
    };
    Range { largest, least_spike }
}

/// Finds samples that no vehicle causes, and interpolates over them if `repair` is set. Returns
/// warnings that name the samples.
///
/// # Errors
/// There are error values, and `repair` is not set.
pub fn check(table: &mut Table, repair: bool) -> Result<Vec<String>, RecordingError> {
    let mut warnings = Vec::new();
    let quantities: Vec<Quantity> = table.columns.keys().copied().collect();
    for quantity in quantities {
        let values = &table.columns[&quantity];
        let errors = error_values(table, quantity, values);
        if let (Some(&first), false) = (errors.first(), repair) {
            return Err(table.refused_at(first, quantity, error_reason(table, quantity, &errors)));
        }
        let spikes: Vec<usize> =
            spikes(quantity, values).into_iter().filter(|spike| errors.binary_search(spike).is_err()).collect();
        warnings.extend(flat_tops(values).iter().map(|tops| flat_top_warning(table, quantity, tops)));
        if repair && !(errors.is_empty() && spikes.is_empty()) {
            let mut wrong = [errors, spikes].concat();
            wrong.sort_unstable();
            warnings.push(repair_warning(table, quantity, &wrong));
            let repaired = interpolated(values, &wrong);
            table.columns.insert(quantity, repaired);
        } else if !spikes.is_empty() {
            warnings.push(spike_warning(table, quantity, &spikes));
        }
    }
    Ok(warnings)
}

fn error_reason(table: &Table, quantity: Quantity, errors: &[usize]) -> String {
    format!(
        "is {}, as loggers write it where they have no value, {}; use {} to interpolate over it, or cut this part off",
        shown(table.value(quantity, errors[0]) / table.unit(quantity).0.in_si),
        times(table, errors),
        given("repair", "True")
    )
}

fn flat_top_warning(table: &Table, quantity: Quantity, tops: &[usize]) -> String {
    format!(
        "Column {} stays at its extreme {} for {FLAT} samples or more in a row, {}: the sensor seems to be at the end of \
         its range, and the peaks are cut off. They cannot be repaired.",
        quantity.key(),
        shown(table.value(quantity, tops[0])),
        times(table, tops)
    )
}

fn repair_warning(table: &Table, quantity: Quantity, wrong: &[usize]) -> String {
    let samples = match wrong.len() {
        1 => format!("a sample of column {} is", quantity.key()),
        count => format!("{count} samples of column {} are", quantity.key()),
    };
    format!("Repaired: {samples} interpolated over, {}.", times(table, wrong))
}

fn spike_warning(table: &Table, quantity: Quantity, spikes: &[usize]) -> String {
    let values = spikes.iter().map(|&spike| table.value(quantity, spike));
    let largest = values.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
    format!(
        "Column {} has isolated spikes of up to {largest:.1} in SI units, {}. If no blow caused them, use {} to \
         interpolate over them.",
        quantity.key(),
        times(table, spikes),
        given("repair", "True")
    )
}

fn error_values(table: &Table, quantity: Quantity, values: &[f64]) -> Vec<usize> {
    let unit = table.unit(quantity).0.in_si;
    let largest = range(quantity.dimension()).largest;
    let is_error = |value: f64| {
        let written = (value / unit).abs();
        value.abs() > largest && ERROR_VALUES.iter().any(|error| (written / error - 1.0).abs() < 1e-9)
    };
    (0..values.len()).filter(|&k| is_error(values[k])).collect()
}

/// Isolated samples: one or two that are far from those before and after them.
fn spikes(quantity: Quantity, values: &[f64]) -> Vec<usize> {
    // Yaw jumps by a turn.
    if quantity == Quantity::Angle(2) {
        return Vec::new();
    }
    let Range { largest, least_spike } = range(quantity.dimension());
    let window = |k: usize, reach: usize| k.saturating_sub(reach)..(k + reach + 1).min(values.len());
    let deviation = |k: usize| (values[k] - median(values[window(k, NEIGHBOURS)].iter().copied())).abs();
    let is_spike = |&k: &usize| {
        let deviation_here = deviation(k);
        deviation_here > least_spike
            && (values[k].abs() > largest || deviation_here > SPREADS * spread(window(k, AROUND).map(deviation)))
    };
    (0..values.len()).filter(is_spike).collect()
}

/// Standard deviation of sizes, which a few spikes among them do not change.
fn spread(sizes: impl Iterator<Item = f64>) -> f64 {
    let sizes = sorted(sizes);
    sizes[sizes.len() * 9 / 10] / QUANTILE
}

/// First samples of the runs of the greatest, and of the least value.
fn flat_tops(values: &[f64]) -> Vec<Vec<usize>> {
    let (least, greatest) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), &v| (low.min(v), high.max(v)));
    let mut start = 0;
    let runs: Vec<(usize, usize)> = values
        .chunk_by(|a, b| a == b)
        .map(|run| {
            start += run.len();
            (start - run.len(), run.len())
        })
        .collect();
    // A computed ride stands still at the extreme where all its bends are to one side.
    let usual = median(values.iter().copied());
    let is_rest = |extreme: &f64| {
        let near = |value: f64| (extreme - value).abs() < AWAY * (greatest - least);
        near(usual) || near(0.0) || near(STANDARD_GRAVITY)
    };
    let is_extreme = |first: usize| values[first] == least || values[first] == greatest;
    let longest = runs.iter().filter(|(first, _)| !is_extreme(*first)).map(|(_, length)| *length).max();
    // A signal of one or two values is not measured.
    let Some(longest) = longest else { return Vec::new() };
    let tops = |extreme: f64| -> Vec<usize> {
        let is_flat = |&&(first, length): &&(usize, usize)| {
            values[first] == extreme && length >= FLAT && length >= FLAT_RUNS * longest
        };
        runs.iter().filter(is_flat).map(|(first, _)| *first).collect()
    };
    [least, greatest]
        .into_iter()
        .filter(|extreme| !is_rest(extreme))
        .map(tops)
        .filter(|tops| !tops.is_empty())
        .collect()
}

/// Times and lines of samples, for a message.
fn times(table: &Table, samples: &[usize]) -> String {
    let shown: Vec<String> = samples
        .iter()
        .take(MOST_LISTED)
        .map(|&k| format!("{:.2} s (line {})", table.time[k] - table.time[0], table.lines[k]))
        .collect();
    let more = samples.len().saturating_sub(MOST_LISTED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("at {}{more}", shown.join(", "))
}

/// The values with those at the ascending indices `wrong` on straight lines
/// between their neighbours.
fn interpolated(values: &[f64], wrong: &[usize]) -> Vec<f64> {
    let mut repaired = values.to_vec();
    for part in wrong.chunk_by(|a, b| a + 1 == *b) {
        let (first, last) = (part[0], part[part.len() - 1]);
        let after = values.get(last + 1).copied();
        let before = first.checked_sub(1).map(|k| values[k]).or(after).unwrap_or(0.0);
        let after = after.unwrap_or(before);
        for (place, &k) in part.iter().enumerate() {
            let t = (place + 1) as f64 / (part.len() + 1) as f64;
            repaired[k] = before + t * (after - before);
        }
    }
    repaired
}
