//! Delay of one signal behind another, by cross-correlation.
//!
//! Correlations at all shifts come from one Fourier transform: the cost is n log n in the number of
//! samples, not n times the number of shifts. Shifts that are as good as the best within its
//! accuracy are then computed by the definition.

use realfft::RealFftPlanner;

use super::statistics::{CONSTANT_TOLERANCE, correlation, mean};

/// Longest delay considered, of either sign \[s\].
pub const LONGEST_DELAY: f64 = 2.0;
/// Least correlation at the best shift for one signal to count as the other one delayed.
const SAME_SIGNAL: f64 = 0.9;

/// Time by which `felt` is later than `desired` \[s\]: the shift at which they correlate best,
/// found between the samples by a parabola through the best shift and its neighbours. The
/// correlation at a shift is Pearson's over the samples that overlap.
///
/// The delay is `None` where a signal is constant or the best correlation is below 0.9. The same
/// holds where the best shift is not within two seconds or half the signals' length. Such signals
/// have no common delay.
pub fn delay(desired: &[f64], felt: &[f64], step: f64) -> Option<f64> {
    delay_within(LONGEST_DELAY, desired, felt, step)
}

/// As [`delay`], within this time in place of two seconds.
pub fn delay_within(longest: f64, desired: &[f64], felt: &[f64], step: f64) -> Option<f64> {
    // Accuracy of the correlations from the Fourier transform.
    const CORRELATION_ACCURACY: f64 = 1e-9;
    let longest = ((longest / step).round() as usize).min(desired.len() / 2);
    let approximate = shifted_correlations(desired, felt, longest)?;
    let exact = |index: usize| correlation_at(desired, felt, index as i64 - longest as i64);
    let largest = approximate.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if largest < SAME_SIGNAL - CORRELATION_ACCURACY {
        return None;
    }
    let (best, at_best) = (0..approximate.len())
        .filter(|&index| approximate[index] >= largest - 2.0 * CORRELATION_ACCURACY)
        .filter_map(|index| Some((index, exact(index)?)))
        .max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    if best == 0 || best + 1 == approximate.len() || at_best < SAME_SIGNAL {
        return None;
    }
    let vertex = parabola_vertex(exact(best - 1)?, at_best, exact(best + 1)?);
    Some((best as f64 - longest as f64 + vertex) * step)
}

/// The correlations at all shifts from `-longest` to `longest` samples. `None` where
/// an overlap is constant.
fn shifted_correlations(desired: &[f64], felt: &[f64], longest: usize) -> Option<Vec<f64>> {
    // Fraction of both signals' energy that must be in an overlap for that accuracy.
    const LEAST_ENERGY: f64 = 1e-6;
    // The means are removed, so that the products and the errors of their sums are small.
    let centred = |values: &[f64]| {
        let mean = mean(values);
        values.iter().map(|value| value - mean).collect::<Vec<f64>>()
    };
    let (desired_centred, felt_centred) = (centred(desired), centred(felt));
    // Each is added up from the end that stays, so that no large sums cancel.
    let sums = |values: &[f64]| (overlap_sums(values.iter(), longest), overlap_sums(values.iter().rev(), longest));
    let ((desired_first, desired_last), (felt_first, felt_last)) = (sums(&desired_centred), sums(&felt_centred));
    let products = shifted_products(desired_centred, felt_centred, longest);
    let energy = desired_first[0].variation() * felt_first[0].variation();
    (0..=2 * longest)
        .map(|index| {
            let cut = index.abs_diff(longest);
            let (d, f) = if index < longest {
                (&desired_last[cut], &felt_first[cut])
            } else {
                (&desired_first[cut], &felt_last[cut])
            };
            if d.is_constant() || f.is_constant() {
                return None;
            }
            let variation = d.variation() * f.variation();
            if variation < LEAST_ENERGY * LEAST_ENERGY * energy {
                return correlation_at(desired, felt, index as i64 - longest as i64);
            }
            Some((products[index] - d.sum * f.sum / d.count) / variation.sqrt())
        })
        .collect()
}

/// Sums of desired\[k\] felt\[k + shift\] over all k, for shifts from `-longest` to `longest`.
fn shifted_products(desired: Vec<f64>, felt: Vec<f64>, longest: usize) -> Vec<f64> {
    let length = (desired.len() + longest + 1).next_power_of_two();
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, inverse) = (planner.plan_fft_forward(length), planner.plan_fft_inverse(length));
    let spectrum = |mut padded: Vec<f64>| {
        padded.resize(length, 0.0);
        let mut spectrum = forward.make_output_vec();
        forward.process(&mut padded, &mut spectrum).expect("the buffers are the plan's own");
        spectrum
    };
    let (desired, mut felt) = (spectrum(desired), spectrum(felt));
    felt.iter_mut().zip(&desired).for_each(|(f, d)| *f *= d.conj());
    let mut products = inverse.make_output_vec();
    // The first and the last line of the spectrum of a real signal are real. Rounding may have
    // left an imaginary part.
    let last = felt.len() - 1;
    (felt[0].im, felt[last].im) = (0.0, 0.0);
    inverse.process(&mut felt, &mut products).expect("the buffers are the plan's own");
    let scale = 1.0 / length as f64;
    (0..=2 * longest).map(|index| products[(index + length - longest) % length] * scale).collect()
}

/// Sums over a part of a signal.
#[derive(Clone, Copy)]
struct Sum {
    count: f64,
    sum: f64,
    squares: f64,
    least: f64,
    most: f64,
}

impl Sum {
    const EMPTY: Sum = Sum { count: 0.0, sum: 0.0, squares: 0.0, least: f64::INFINITY, most: f64::NEG_INFINITY };

    fn add(&mut self, value: f64) {
        self.count += 1.0;
        self.sum += value;
        self.squares += value * value;
        self.least = self.least.min(value);
        self.most = self.most.max(value);
    }

    /// Sum of the squared deviations from the mean.
    fn variation(&self) -> f64 {
        (self.squares - self.sum * self.sum / self.count).max(0.0)
    }

    fn is_constant(&self) -> bool {
        self.count == 0.0 || self.most - self.least < CONSTANT_TOLERANCE
    }
}

/// Sums over the parts of a signal that overlap at each shift: without the last 0, 1, ...
/// `longest` values.
fn overlap_sums<'a>(values: impl ExactSizeIterator<Item = &'a f64>, longest: usize) -> Vec<Sum> {
    let count = values.len();
    let mut sum = Sum::EMPTY;
    let mut sums = Vec::with_capacity(longest + 1);
    for (k, &value) in values.enumerate() {
        sum.add(value);
        if k + 1 + longest >= count {
            sums.push(sum);
        }
    }
    sums.reverse();
    sums.resize(longest + 1, Sum::EMPTY);
    sums
}

/// The correlation of `desired` with what is felt `shift` samples later.
fn correlation_at(desired: &[f64], felt: &[f64], shift: i64) -> Option<f64> {
    let offset = shift.unsigned_abs() as usize;
    let overlap = desired.len() - offset;
    if shift < 0 {
        correlation(&desired[offset..], &felt[..overlap])
    } else {
        correlation(&desired[..overlap], &felt[offset..])
    }
}

/// Abscissa, between -1 and 1, of the vertex of the parabola through the values at -1, 0 and 1; the
/// middle is the largest.
fn parabola_vertex(before: f64, middle: f64, after: f64) -> f64 {
    let curvature = before - 2.0 * middle + after;
    if curvature == 0.0 { 0.0 } else { 0.5 * (before - after) / curvature }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const STEP: f64 = 0.01;

    fn sampled(signal: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..1000).map(|k| signal(f64::from(k) * STEP)).collect()
    }

    fn assert_near(value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance, "{value} is not {expected}");
    }

    /// The definition, shift by shift.
    fn by_definition(desired: &[f64], felt: &[f64], longest: usize) -> Option<Vec<f64>> {
        let longest = longest as i64;
        (-longest..=longest).map(|shift| correlation_at(desired, felt, shift)).collect()
    }

    /// The delay from the correlations of the definition.
    fn delay_by_definition(desired: &[f64], felt: &[f64], step: f64) -> Option<f64> {
        let longest = ((LONGEST_DELAY / step).round() as usize).min(desired.len() / 2);
        let at_shift = by_definition(desired, felt, longest)?;
        let best = (0..at_shift.len()).max_by(|&i, &j| at_shift[i].total_cmp(&at_shift[j]))?;
        if best == 0 || best + 1 == at_shift.len() || at_shift[best] < SAME_SIGNAL {
            return None;
        }
        let vertex = parabola_vertex(at_shift[best - 1], at_shift[best], at_shift[best + 1]);
        Some((best as f64 - longest as f64 + vertex) * step)
    }

    /// Numbers from -1 to 1 by a linear congruential generator.
    fn noise(seed: u64) -> impl Iterator<Item = f64> {
        let mut state = seed;
        std::iter::from_fn(move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            Some((state >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
        })
    }

    /// Noise that is smooth over some samples, with an offset that the means must take out.
    fn smooth_noise(seed: u64, count: usize, offset: f64) -> Vec<f64> {
        let mut state = 0.0;
        let smoothed = noise(seed).map(|value| {
            state += 0.05 * (value - state);
            state + offset
        });
        smoothed.take(count).collect()
    }

    #[test]
    fn correlations_are_those_of_the_definition() {
        for (seed, count, longest) in [(1, 1000, 200), (2, 777, 388), (3, 64, 32), (4, 5, 2), (5, 2, 1), (6, 3000, 0)] {
            let desired = smooth_noise(seed, count, 9.8);
            let felt = smooth_noise(seed + 100, count, -3.0);
            let (found, expected) =
                (shifted_correlations(&desired, &felt, longest), by_definition(&desired, &felt, longest));
            match (found, expected) {
                (Some(found), Some(expected)) => {
                    assert_eq!(found.len(), expected.len());
                    found.iter().zip(&expected).for_each(|(&found, &expected)| assert_near(found, expected, 1e-9));
                }
                (found, expected) => assert_eq!(found, expected, "{count} samples"),
            }
        }
    }

    /// Bit for bit: the best shift and its neighbours are computed by the definition.
    #[test]
    fn the_delay_is_that_of_the_definition_to_the_last_bit() {
        let mut found_some = 0;
        for seed in 0..40 {
            let signal = smooth_noise(seed, 1600, 9.8);
            let later = 100 + (seed as usize * 37) % 200;
            let desired = &signal[200..1200];
            let felt: Vec<f64> =
                signal[later..].iter().zip(noise(seed + 7)).take(1000).map(|(v, n)| 0.7 * v + 0.004 * n).collect();
            let delay = delay(desired, &felt, STEP);
            assert_eq!(delay, delay_by_definition(desired, &felt, STEP), "seed {seed}");
            found_some += usize::from(delay.is_some());
        }
        assert!(found_some > 20, "{found_some}");
    }

    /// All of a signal's energy in the part that the overlap leaves out: the transform's
    /// rounding must not show.
    #[test]
    fn a_jolt_outside_the_overlap_does_not_hide_the_rest() {
        let quiet = |shift: f64| sampled(move |t| 1e-6 * (TAU * 0.3 * (t - shift)).sin());
        let (mut desired, felt) = (quiet(0.0), quiet(0.2));
        desired[0] = 1e6;
        let longest = 200;
        let (found, expected) =
            (shifted_correlations(&desired, &felt, longest), by_definition(&desired, &felt, longest));
        let (found, expected) = (found.unwrap(), expected.unwrap());
        found.iter().zip(&expected).for_each(|(&found, &expected)| assert_near(found, expected, 1e-9));
        assert_eq!(delay(&desired, &felt, STEP), delay_by_definition(&desired, &felt, STEP));
    }

    #[test]
    fn a_constant_signal_has_no_delay() {
        let (constant, sine) = (sampled(|_| 9.80665), sampled(f64::sin));
        assert_eq!(delay(&constant, &sine, STEP), None);
        assert_eq!(delay(&sine, &constant, STEP), None);
        assert_eq!(delay(&[], &[], STEP), None);
        assert_eq!(delay(&[1.0], &[2.0], STEP), None);
        assert_eq!(delay(&[f64::NAN; 10], &[f64::NAN; 10], STEP), None);
    }

    #[test]
    fn a_delayed_pulse_s_delay_is_found_between_the_samples_in_either_direction() {
        let pulse = |t: f64| (-(t - 5.0).powi(2)).exp();
        let desired = sampled(pulse);
        for expected in [-0.5, -0.01234, 0.0, 0.0003, 0.0417, 0.9] {
            let felt = sampled(|t| 0.8 * pulse(t - expected) + 1.0);
            assert_near(delay(&desired, &felt, STEP).unwrap(), expected, 0.001 * STEP);
        }
    }

    #[test]
    fn a_delayed_sine_s_delay_is_found() {
        let desired = sampled(|t| (TAU * 0.4 * t).sin());
        let felt = sampled(|t| (TAU * 0.4 * (t - 0.1234)).sin());
        assert_near(delay(&desired, &felt, STEP).unwrap(), 0.1234, 0.001 * STEP);
    }

    #[test]
    fn ramps_have_no_delay_in_common() {
        let desired = sampled(|t| t);
        let felt = sampled(|t| (t / 10.0).exp());
        assert_eq!(delay(&desired, &felt, STEP), None);
    }

    #[test]
    fn different_signals_have_no_delay_in_common() {
        let desired = sampled(|t| (TAU * t).sin());
        let felt = sampled(|t| (TAU * t).sin() + (TAU * 1.7 * t).sin());
        assert_eq!(delay(&desired, &felt, STEP), None);
    }
}
