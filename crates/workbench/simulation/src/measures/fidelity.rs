//! Fidelity with which one signal follows another: errors, correlation and delay.

use super::delay::delay;
use super::statistics::{CONSTANT_TOLERANCE, correlation, is_constant};

/// Fidelity of a felt signal to the desired one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fidelity {
    /// Root mean square of the error \[the signal's unit\].
    pub rms_error: f64,
    /// Largest error \[the signal's unit\].
    pub peak_error: f64,
    /// Pearson's correlation; none where one of the signals is constant.
    pub correlation: Option<f64>,
    /// Time by which the felt signal is later \[s\]; see [`delay`].
    pub delay: Option<f64>,
}

/// Compares two signals that are sampled every `step` seconds. None where both are constant and
/// equal: there is nothing to feel and nothing is felt.
pub fn fidelity(desired: &[f64], felt: &[f64], step: f64) -> Option<Fidelity> {
    let peak_error = peak_error(desired, felt);
    if is_constant(desired) && peak_error < CONSTANT_TOLERANCE {
        return None;
    }
    Some(Fidelity {
        rms_error: rms_error(desired, felt),
        peak_error,
        correlation: correlation(desired, felt),
        delay: delay(desired, felt, step),
    })
}

/// Root mean square of the difference.
pub fn rms_error(desired: &[f64], felt: &[f64]) -> f64 {
    let squares: f64 = desired.iter().zip(felt).map(|(d, f)| (f - d).powi(2)).sum();
    (squares / desired.len() as f64).sqrt()
}

/// Largest difference.
pub fn peak_error(desired: &[f64], felt: &[f64]) -> f64 {
    desired.iter().zip(felt).map(|(d, f)| (f - d).abs()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_1_SQRT_2, TAU};

    use super::*;

    const STEP: f64 = 0.01;

    fn sampled(signal: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..1000).map(|k| signal(f64::from(k) * STEP)).collect()
    }

    fn assert_near(value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance, "{value} is not {expected}");
    }

    #[test]
    fn the_rms_error_of_a_lost_sine_is_its_amplitude_over_root_two() {
        let desired = sampled(|t| 3.0 * (TAU * t).sin());
        let felt = sampled(|_| 0.0);
        assert_near(rms_error(&desired, &felt), 3.0 * FRAC_1_SQRT_2, 1e-12);
        assert_near(peak_error(&desired, &felt), 3.0, 1e-12);
    }

    #[test]
    fn the_errors_of_an_offset_are_the_offset() {
        let desired = sampled(|t| t * t);
        let felt = sampled(|t| t * t - 0.25);
        assert_near(rms_error(&desired, &felt), 0.25, 1e-12);
        assert_near(peak_error(&desired, &felt), 0.25, 1e-12);
    }

    #[test]
    fn the_correlation_of_sines_over_whole_periods_is_the_cosine_of_the_phase_between_them() {
        let desired = sampled(|t| (TAU * t).sin());
        for phase in [0.0, 0.3, 1.0, 2.0, 3.0] {
            let felt = sampled(|t| 5.0 + 2.0 * (TAU * t - phase).sin());
            assert_near(correlation(&desired, &felt).unwrap(), phase.cos(), 1e-12);
        }
    }

    #[test]
    fn a_constant_signal_correlates_with_nothing() {
        let (constant, sine) = (sampled(|_| 9.80665), sampled(f64::sin));
        assert_eq!(correlation(&constant, &sine), None);
        assert_eq!(correlation(&sine, &constant), None);
    }

    #[test]
    fn nothing_desired_and_nothing_felt_is_nothing_to_measure() {
        let rest = sampled(|_| 9.80665);
        assert_eq!(fidelity(&rest, &rest, STEP), None);
        let disturbed = sampled(|t| 9.80665 + 0.1 * t.sin());
        let fidelity = fidelity(&rest, &disturbed, STEP).unwrap();
        assert_eq!((fidelity.correlation, fidelity.delay), (None, None));
        assert_near(fidelity.peak_error, 0.1, 1e-6);
    }
}
