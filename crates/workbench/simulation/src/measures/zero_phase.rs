//! Filters without a shift in time: forward and backward over the signal.

use std::f64::consts::PI;

/// The signal through a filter of this many sections of second order, forward and backward, as
/// SciPy's `sosfiltfilt`. The filter gets the tangent of half the cutoff's angle. None where the
/// sampling is too coarse for the cutoff \[Hz\], or the signal too short.
pub fn zero_phase(
    signal: impl ExactSizeIterator<Item = f64>,
    cutoff: f64,
    step: f64,
    sections: usize,
    filter: impl Fn(&mut [f64], f64),
) -> Option<Vec<f64>> {
    let (ratio, extension, end) = (cutoff * step, 3 * (2 * sections + 1), signal.len());
    if ratio >= 0.5 || end <= extension {
        return None;
    }
    // Extended by its reflection in its ends, so that value and slope are continuous.
    let mut extended = Vec::with_capacity(end + 2 * extension);
    extended.resize(extension, 0.0);
    extended.extend(signal);
    let (first, last) = (extension, extension + end - 1);
    for k in 1..=extension {
        extended[first - k] = 2.0 * extended[first] - extended[first + k];
        extended.push(2.0 * extended[last] - extended[last - k]);
    }
    for _ in 0..2 {
        filter(&mut extended, (PI * ratio).tan());
        extended.reverse();
    }
    extended.truncate(last + 1);
    extended.drain(..first);
    Some(extended)
}
