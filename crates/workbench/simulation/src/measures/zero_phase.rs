//! Filters without a shift in time: forward and backward over the signal.

use std::f64::consts::PI;

/// The signal through a filter of this many sections of second order, forward and backward, as
/// SciPy's `sosfiltfilt`. The filter gets the tangent of half the cutoff's angle. None where the
/// sampling is too coarse for the cutoff \[Hz\], or the signal too short.
pub fn zero_phase(
    signal: &[f64],
    cutoff: f64,
    step: f64,
    sections: usize,
    filter: impl Fn(&mut [f64], f64),
) -> Option<Vec<f64>> {
    let (ratio, extension) = (cutoff * step, 3 * (2 * sections + 1));
    if ratio >= 0.5 || signal.len() <= extension {
        return None;
    }
    // Extended by its reflection in its ends, so that value and slope are continuous.
    let last = signal.len() - 1;
    let before = (1..=extension).rev().map(|k| 2.0 * signal[0] - signal[k]);
    let after = (1..=extension).map(|k| 2.0 * signal[last] - signal[last - k]);
    let mut extended: Vec<f64> = before.chain(signal.iter().copied()).chain(after).collect();
    for _ in 0..2 {
        filter(&mut extended, (PI * ratio).tan());
        extended.reverse();
    }
    Some(extended[extension..=extension + last].to_vec())
}
