//! Statistics of signals.

use std::ops::Range;

pub use moris_simulation::measures::statistics::median;

/// Correlation above which two signals count as correlated.
const TOGETHER: f64 = 0.7;
/// Time constant of the smoothing before turns are detected \[s\].
const SMOOTHING: f64 = 0.5;

/// The values from the least to the greatest.
pub fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}

/// The least and the greatest value.
pub fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, greatest), v| (least.min(v), greatest.max(v)))
}

/// The runs of samples that are alike.
pub fn runs(values: &[f64], are_alike: impl FnMut(&f64, &f64) -> bool) -> impl Iterator<Item = Range<usize>> {
    let mut end = 0;
    values.chunk_by(are_alike).map(move |run| {
        end += run.len();
        end - run.len()..end
    })
}

/// True for a signal that has one value throughout.
pub fn is_constant(values: &[f64]) -> bool {
    let (least, greatest) = extremes(values.iter().copied());
    greatest - least <= 1e-9 * greatest.abs().max(1.0)
}

pub fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

/// The values without their mean.
pub fn centred(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.iter_mut().for_each(|value| *value -= mean);
    values
}

/// The integral up to each sample.
pub fn integral(values: impl Iterator<Item = f64>, step: f64) -> Vec<f64> {
    let mut integral = 0.0;
    values
        .map(|value| {
            integral += value * step;
            integral
        })
        .collect()
}

/// A signal without its mean, after a first-order low-pass.
pub fn smooth(values: impl Iterator<Item = f64>, step: f64) -> Vec<f64> {
    let alpha = step / (SMOOTHING + step);
    let mut values = centred(values);
    let mut state = 0.0;
    for value in &mut values {
        state += alpha * (*value - state);
        *value = state;
    }
    values
}

/// Slope of y over x through the origin. None where they are not correlated.
pub fn regression(x: &[f64], y: &[f64]) -> Option<f64> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (xx, xy, yy) = (dot(x, x), dot(x, y), dot(y, y));
    (xy.abs() > TOGETHER * (xx * yy).sqrt()).then(|| xy / xx)
}
