//! Mean and slope of a signal over an interval.

/// Mean and slope of a signal over an interval of length T: its projections on 1 and
/// w = sqrt(12) (t/T - 1/2), each with a mean square of 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    pub mean: f64,
    pub slope: f64,
}

impl Projection {
    /// Projections of a signal that is linear between samples with equal distances. Simpson's
    /// rule is exact for it.
    pub fn of_line(samples: &[f64]) -> Self {
        let steps = (samples.len() - 1) as f64;
        let (mut mean, mut slope) = (0.0, 0.0);
        for (k, pair) in samples.windows(2).enumerate() {
            let weight = |places: f64| (k as f64 + places) / steps - 0.5;
            let middle = 0.5 * (pair[0] + pair[1]);
            mean += middle / steps;
            slope += (weight(0.0) * pair[0] + 4.0 * weight(0.5) * middle + weight(1.0) * pair[1]) / (6.0 * steps);
        }
        Projection { mean, slope: slope * 12_f64.sqrt() }
    }
}
