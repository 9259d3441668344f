//! Gaps in columns that are sampled at different rates.

use super::interpolation::between;
use super::times::LONGEST_GAP;
use crate::recording::columns::{Column, period};
use crate::recording::message::RecordingError;
use crate::recording::read::{Samples, Sheet};

/// Interpolates missing values, and cuts off samples before the first or after the last value of a
/// column. Warns about long gaps.
///
/// # Errors
/// A column has no values, or at no time do all columns have values.
pub fn fill(samples: &mut Samples, sheet: &Sheet, layout: &[Column]) -> Result<(), RecordingError> {
    if samples.columns.iter().flat_map(|(_, values)| values).all(|value| !value.is_nan()) {
        return Ok(());
    }
    let time = &samples.time;
    let (mut first, mut last) = (0, time.len() - 1);
    for (place, values) in &mut samples.columns {
        let name = sheet.header.shown(*place);
        let known: Vec<usize> = (0..values.len()).filter(|&sample| !values[sample].is_nan()).collect();
        let (Some(&begin), Some(&end)) = (known.first(), known.last()) else {
            return Err(sheet.refused(format!("column {name} is empty")));
        };
        (first, last) = (first.max(begin), last.min(end));
        for pair in known.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let span = time[b] - time[a];
            if span > LONGEST_GAP && b - a > 1 {
                let line = samples.lines[a];
                samples.warnings.push(
                    format!(
                        "Column {name} is empty for {span:.2} s after line {line}; the gap is interpolated linearly."
                    )
                    .into(),
                );
            }
            for k in a + 1..b {
                let t = if span > 0.0 { (time[k] - time[a]) / span } else { 0.0 };
                values[k] = between(values[a], values[b], t, period(layout, *place));
            }
        }
    }
    if last <= first {
        return Err(sheet.refused("has no time at which all columns have values"));
    }
    samples.keep(first..last + 1);
    Ok(())
}
