//! Gaps in columns that are sampled at different rates.

use std::path::Path;

use super::interpolation::between;
use super::times::LONGEST_GAP;
use crate::message::Message;
use crate::recording::columns::{Column, Header, period};
use crate::recording::conventions::Conventions;
use crate::recording::message::RecordingError;
use crate::recording::read::Samples;
use crate::texts::text;

/// Interpolates missing values, and cuts off samples before the first or after the last value of a
/// column that the recording needs. Other columns hold their first and last values. Warns about
/// these and about long gaps.
///
/// # Errors
/// A column has no values, or at no time do all columns that the recording needs have values.
pub fn fill(
    samples: &mut Samples,
    (file, header): (&Path, &Header),
    layout: &[Column],
    conventions: &Conventions,
) -> Result<(), RecordingError> {
    if samples.columns.iter().flat_map(|(_, values)| values).all(|value| !value.is_nan()) {
        return Ok(());
    }
    let time = &samples.time;
    let is_needed = |place: usize| {
        let mut holds = layout.iter().filter(|column| column.terms.iter().any(|term| term.place == place));
        holds.any(|column| conventions.needs(column.quantity))
    };
    let (mut first, mut last) = (0, time.len() - 1);
    let mut complete = (0, last);
    for (place, values) in &mut samples.columns {
        let name = header.shown(*place);
        let known: Vec<usize> = (0..values.len()).filter(|&sample| !values[sample].is_nan()).collect();
        let (Some(&begin), Some(&end)) = (known.first(), known.last()) else {
            return Err(RecordingError::whole(file, format!("column {name} is empty")));
        };
        complete = (complete.0.max(begin), complete.1.min(end));
        if is_needed(*place) {
            (first, last) = (first.max(begin), last.min(end));
        } else {
            samples.warnings.extend(held_warning(&name, time, begin, end));
            let (at_begin, at_end) = (values[begin], values[end]);
            values[..begin].fill(at_begin);
            values[end + 1..].fill(at_end);
        }
        for pair in known.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let span = time[b] - time[a];
            if span > LONGEST_GAP && b - a > 1 {
                let line = samples.lines[a];
                samples.warnings.push(text!["column-with-a-gap", name = &name, span, line]);
            }
            for k in a + 1..b {
                let t = if span > 0.0 { (time[k] - time[a]) / span } else { 0.0 };
                values[k] = between(values[a], values[b], t, period(layout, *place));
            }
        }
    }
    if last <= first {
        return Err(RecordingError::whole(file, "has no time at which all columns have values"));
    }
    if complete != (first, last) {
        samples.complete = Some((time[complete.0], time[complete.1]));
    }
    samples.keep(first..last + 1);
    Ok(())
}

/// A warning about a column without values at the recording's beginning or end.
fn held_warning(name: &str, time: &[f64], begin: usize, end: usize) -> Option<Message> {
    let [from, to] = [begin, end].map(|sample| time[sample] - time[0]);
    match (begin > 0, end + 1 < time.len()) {
        (false, false) => None,
        (true, false) => Some(text!["column-begins-late", name, from]),
        (false, true) => Some(text!["column-ends-early", name, to]),
        (true, true) => Some(text!["column-begins-late-and-ends-early", name, from, to]),
    }
}
