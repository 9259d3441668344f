//! Statistics of signals.

use std::ops::Range;

pub use moris_simulation::measures::statistics::median;

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
    // Time constant of the smoothing before turns are detected [s].
    const SMOOTHING_TIME: f64 = 0.5;
    let alpha = step / (SMOOTHING_TIME + step);
    let mut values = centred(values);
    let mut state = 0.0;
    for value in &mut values {
        state += alpha * (*value - state);
        *value = state;
    }
    values
}

/// Two signals beside each other.
#[derive(Clone, Copy, Debug)]
pub struct Relation {
    /// Root mean squares of the two.
    pub sizes: [f64; 2],
    /// Slope of the second over the first, through the origin.
    slope: f64,
    /// Correlation about zero, from -1 to 1; not a number beside nothing.
    pub correlation: f64,
}

impl Relation {
    /// Slope of the second signal over the first; none where they are not correlated.
    pub fn slope(&self) -> Option<f64> {
        // Correlation above which two signals count as correlated.
        const MIN_CORRELATION: f64 = 0.7;
        (self.correlation.abs() > MIN_CORRELATION).then_some(self.slope)
    }

    /// The slope of signals that both have this size.
    pub fn slope_above(&self, least: f64) -> Option<f64> {
        self.slope().filter(|_| self.sizes.iter().all(|size| *size >= least))
    }
}

/// Relation of two signals.
pub fn relation(x: &[f64], y: &[f64]) -> Relation {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (xx, xy, yy) = (dot(x, x), dot(x, y), dot(y, y));
    let sizes = [root_mean_square(x), root_mean_square(y)];
    Relation { sizes, slope: xy / xx, correlation: xy / (xx * yy).sqrt() }
}
