//! Times from a sample to the arrival of the next: what the delay must be.

use crate::resampler::MAX_DELAY;

/// Width of a class \[s\].
const CLASS_WIDTH: f64 = 1e-3;
/// Number of classes: up to [`MAX_DELAY`].
const CLASS_COUNT: usize = 250;

/// Numbers of gaps, by their length, older ones with less weight. Gaps from 0.25 s on are holes
/// that no delay covers, and are left out.
#[derive(Clone, Debug)]
pub struct Gaps {
    weights: [f64; CLASS_COUNT],
    /// Weight of the next gap.
    weight: f64,
}

impl Default for Gaps {
    fn default() -> Self {
        Gaps { weights: [0.0; CLASS_COUNT], weight: 1.0 }
    }
}

impl Gaps {
    /// Takes a gap, so long after the one before it.
    pub fn take(&mut self, gap: f64, passed: f64) {
        // Time constant with which gaps are forgotten [s].
        const GAP_TIME_CONSTANT: f64 = 5.0;
        // Weight from which on all are made smaller.
        const MAX_WEIGHT: f64 = 1e9;
        self.weight *= libm::exp(passed.clamp(0.0, GAP_TIME_CONSTANT) / GAP_TIME_CONSTANT);
        if self.weight > MAX_WEIGHT {
            self.weights.iter_mut().for_each(|weight| *weight /= self.weight);
            self.weight = 1.0;
        }
        if gap < MAX_DELAY {
            self.weights[((gap.max(0.0) / CLASS_WIDTH) as usize).min(CLASS_COUNT - 1)] += self.weight;
        }
    }

    /// The delay with which this part of the gaps is covered, with a reserve \[s\].
    pub fn delay(&self, part: f64) -> f64 {
        // Reserve of the delay beyond the time between samples.
        const DELAY_FACTOR: f64 = 1.1;
        // Gaps from which on the longest alone does not count.
        const MIN_COUNTED_GAPS: f64 = 20.0;
        let all = self.weights.iter().sum::<f64>();
        let mut wanted = part.clamp(0.0, 1.0) * all;
        // A loading screen at the beginning is one gap of few.
        if part < 1.0 && all > MIN_COUNTED_GAPS * self.weight {
            wanted = wanted.min(all - 1.01 * self.weight);
        }
        let mut sum = 0.0;
        for (class, weight) in self.weights.iter().enumerate() {
            sum += weight;
            if sum > 0.0 && sum >= wanted * (1.0 - 1e-12) {
                // Samples that come before their time need none.
                return if class == 0 { 0.0 } else { (DELAY_FACTOR * (class + 1) as f64 * CLASS_WIDTH).min(MAX_DELAY) };
            }
        }
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_long_gap_does_not_count_and_every_twentieth_does() {
        let mut gaps = Gaps::default();
        for k in 0..2000 {
            gaps.take(if k == 1500 { 0.2 } else { 0.0105 }, 0.01);
        }
        assert!((gaps.delay(0.99) - 0.0121).abs() < 1e-9 && gaps.delay(1.0) > 0.2);
        for k in 0..2000 {
            gaps.take(if k % 20 == 0 { 0.0405 } else { 0.0105 }, 0.01);
        }
        assert!((gaps.delay(0.99) - 0.0451).abs() < 1e-9);
        // Forgotten within a minute.
        (0..10_000).for_each(|_| gaps.take(0.0105, 0.01));
        assert!((gaps.delay(0.99) - 0.0121).abs() < 1e-9);
    }
}
