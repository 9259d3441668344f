//! Samples that no vehicle causes: error values of loggers, isolated spikes, and flat tops of a
//! sensor that is at the end of its range.

mod find;

use moris_interface::shown;

use crate::message::Message;
use crate::recording::conventions::Quantity;
use crate::recording::message::RecordingError;
use crate::recording::table::Table;
use crate::texts::text;

use find::{MIN_FLAT_SAMPLES, error_values, flat_tops, spikes};

/// Finds samples that no vehicle causes, and interpolates over them if `repair` is set. Returns
/// warnings that name the samples.
///
/// # Errors
/// There are error values, and `repair` is not set.
pub fn check(table: &mut Table, repair: bool) -> Result<Vec<Message>, RecordingError> {
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
        let is_sensor = matches!(quantity, Quantity::Force(_) | Quantity::Rate(_));
        let tops = if is_sensor { flat_tops(values) } else { Vec::new() };
        warnings.extend(tops.iter().map(|tops| flat_top_warning(table, quantity, tops)));
        if repair && !(errors.is_empty() && spikes.is_empty()) {
            let mut wrong = [errors, spikes].concat();
            wrong.sort_unstable();
            warnings.push(repair_warning(table, quantity, &wrong));
            let repaired = interpolated_over(values, &wrong);
            table.columns.insert(quantity, repaired);
        } else if !spikes.is_empty() {
            warnings.push(spike_warning(table, quantity, &spikes));
        }
    }
    Ok(warnings)
}

fn error_reason(table: &Table, quantity: Quantity, errors: &[usize]) -> Message {
    let value = shown(table.value(quantity, errors[0]) / table.unit(quantity).0.in_si);
    text!["error-value", value, times = listed_times(table, errors)]
}

fn flat_top_warning(table: &Table, quantity: Quantity, tops: &[usize]) -> Message {
    let (name, value) = (quantity.key(), shown(table.value(quantity, tops[0])));
    text!["flat-top", name, value, count = MIN_FLAT_SAMPLES, times = listed_times(table, tops)]
}

fn repair_warning(table: &Table, quantity: Quantity, wrong: &[usize]) -> Message {
    let (name, times) = (quantity.key(), listed_times(table, wrong));
    match wrong.len() {
        1 => text!["sample-repaired", name, times],
        count => text!["samples-repaired", count, name, times],
    }
}

fn spike_warning(table: &Table, quantity: Quantity, spikes: &[usize]) -> Message {
    let values = spikes.iter().map(|&spike| table.value(quantity, spike));
    let largest = values.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
    text!["spikes", name = quantity.key(), largest, times = listed_times(table, spikes)]
}

/// Times and lines of samples, for a message.
fn listed_times(table: &Table, samples: &[usize]) -> String {
    // Largest number of times that a message lists.
    const MOST_LISTED: usize = 5;
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
fn interpolated_over(values: &[f64], wrong: &[usize]) -> Vec<f64> {
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
