//! Series with times of their own, brought to a recording's samples.

use crate::{Refusal, refuse, sentence};

/// A series at a recording's samples, from `times` of its own, and a sentence if it was
/// interpolated. Times that are those of the samples, or divide its steps into whole parts, keep
/// their values. Others are interpolated linearly.
///
/// The times are the recording's where they begin with its `start`, and else count from its first
/// sample.
///
/// # Errors
/// Times do not increase, or do not cover the recording.
pub fn on_samples<const N: usize>(
    argument: &'static str,
    times: &[f64],
    values: &[[f64; N]],
    start: f64,
    step: f64,
    samples: usize,
) -> Result<(Vec<[f64; N]>, Option<String>), Refusal> {
    // Tolerance of a time, as a fraction of the recording's step.
    const TIME_TOLERANCE: f64 = 1e-3;
    // Excess of times over a whole number of parts of a step that counts as rounding.
    const COUNT_ROUNDING: f64 = 1e-6;
    let refused = |reason: String| Refusal(format!("{argument}: {reason}"));
    if times.len() < 2 || times.len() != values.len() {
        let (times, rows) = (times.len(), values.len());
        return Err(refused(format!("has {times} times for {rows} rows; give a time for each of at least two")));
    }
    if let Some(k) = times.windows(2).position(|pair| pair[1].is_nan() || pair[1] <= pair[0]) {
        let (before, after) = (times[k], times[k + 1]);
        return Err(refused(format!("time {after} s of row {} follows {before} s; time must increase", k + 1)));
    }
    if let Some(k) = times.iter().position(|time| !time.is_finite()) {
        return Err(refused(format!("time of row {k} is {}; every time must be a finite number", times[k])));
    }
    let steps = samples.saturating_sub(1);
    let end = steps as f64 * step;
    let is_shifted = start != 0.0 && (times[0] - start).abs() <= 0.5 * step + times[0].abs() * COUNT_ROUNDING;
    let shift = if is_shifted { start } else { 0.0 };
    let time = |k: usize| times[k] - shift;
    let last = times.len() - 1;
    let mean = (times[last] - times[0]) / last as f64;
    let tolerance = TIME_TOLERANCE * step + mean;
    if time(0) > tolerance || time(last) < end - tolerance {
        let (from, to) = (time(0), time(last));
        refuse!(sentence!["times-too-short", argument, from, to, end]);
    }
    let parts = (step / mean).round().max(1.0) as usize;
    let part = step / parts as f64;
    let count = parts * steps + 1;
    let is_regular = times.len() >= count
        && (0..count)
            .all(|k| (time(k) - k as f64 * part).abs() <= TIME_TOLERANCE * part + COUNT_ROUNDING * times[0].abs());
    if is_regular {
        return Ok((values[..count].to_vec(), None));
    }
    let mut next = 1;
    let at = |k: usize| {
        let wanted = k as f64 * step;
        while next < last && time(next) < wanted {
            next += 1;
        }
        let fraction = ((wanted - time(next - 1)) / (time(next) - time(next - 1))).clamp(0.0, 1.0);
        std::array::from_fn(|i| values[next - 1][i] + fraction * (values[next][i] - values[next - 1][i]))
    };
    let note = sentence!["interpolated", argument, rate = 1.0 / mean, recorded = 1.0 / step];
    Ok(((0..samples).map(at).collect(), Some(note)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(times: &[f64]) -> Vec<[f64; 1]> {
        times.iter().map(|time| [2.0 * time]).collect()
    }

    #[test]
    fn equal_and_finer_times_keep_their_values_and_others_are_interpolated() {
        let on = |step: f64, count: usize, offset: f64, start: f64| {
            let times: Vec<f64> = (0..count).map(|k| offset + step * k as f64).collect();
            on_samples("pose", &times, &ramp(&times), start, 0.01, 101)
        };
        assert!(matches!(on(0.01, 101, 0.0, 0.0), Ok((values, None)) if values.len() == 101));
        assert!(matches!(on(0.002, 501, 0.0, 0.0), Ok((values, None)) if values.len() == 501));
        // The recording's own times, from 7 s on.
        assert!(matches!(on(0.01, 101, 7.0, 7.0), Ok((values, None)) if values.len() == 101 && values[0] == [14.0]));
        let (values, note) = on(1.0 / 60.0, 61, 0.0, 0.0).unwrap();
        assert_eq!(values.len(), 101);
        assert!(values.iter().enumerate().all(|(k, [value])| (value - 0.02 * k as f64).abs() < 1e-12));
        assert!(note.unwrap().contains("60.0000 samples a second"));
    }

    #[test]
    fn times_that_end_early_or_go_back_are_refused() {
        let error = |times: &[f64]| on_samples("pose", times, &ramp(times), 0.0, 0.01, 101).unwrap_err().to_string();
        assert!(error(&[0.0, 0.1, 0.2]).contains("covers 0 to 0.2 s, but the recording 0 to 1 s"));
        assert!(error(&[0.0, 0.5, 0.5, 1.0]).contains("time must increase"));
        assert!(error(&[f64::NAN, 0.5, 1.0]).contains("must be a finite number"));
    }
}
