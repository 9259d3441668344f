//! Filters without a shift in time: forward and backward over the signal.

use std::f64::consts::PI;

/// Samples that are kept at a time. Of longer signals each block is filtered again from the states
/// of both passes at its ends.
const BLOCK_SAMPLES: usize = 1 << 18;

/// The signal through a filter of this many sections of second order, forward and backward, as
/// SciPy's `sosfiltfilt`. `filter` makes a filter at rest from the tangent of half the cutoff's
/// angle. None where the sampling is too coarse for the cutoff \[Hz\], or the signal too short.
pub fn zero_phase<F: FnMut(f64) -> f64 + Clone>(
    signal: impl ExactSizeIterator<Item = f64> + Clone,
    cutoff: f64,
    step: f64,
    sections: usize,
    filter: impl Fn(f64) -> F,
) -> Option<impl Iterator<Item = f64>> {
    let (ratio, extension, end) = (cutoff * step, 3 * (2 * sections + 1), signal.len());
    if ratio >= 0.5 || end <= extension {
        return None;
    }
    // Extended by its reflection in its ends, so that value and slope are continuous.
    let first: Vec<f64> = signal.clone().take(extension + 1).collect();
    let last: Vec<f64> = signal.clone().skip(end - extension - 1).collect();
    let reflected =
        |around: f64, values: &[f64]| -> Vec<f64> { values.iter().rev().map(|value| 2.0 * around - value).collect() };
    let before = reflected(first[0], &first[1..]).into_iter();
    let after = reflected(last[extension], &last[..extension]).into_iter();
    let at_rest = filter((PI * ratio).tan());
    let forward = before.chain(signal).chain(after).map(at_rest.clone());
    let blocks = (end + 2 * extension).div_ceil(BLOCK_SAMPLES);
    // The forward pass at each block's start, and the backward pass at its end.
    let mut starts = vec![forward];
    for block in 1..blocks {
        let mut start = starts[block - 1].clone();
        start.nth(BLOCK_SAMPLES - 1);
        starts.push(start);
    }
    let filtered = move |block: usize, backward: &mut F| {
        let mut values: Vec<f64> = starts[block].clone().take(BLOCK_SAMPLES).collect();
        values.iter_mut().rev().for_each(|value| *value = backward(*value));
        values
    };
    let mut ends = vec![at_rest; blocks];
    for block in (1..blocks).rev() {
        let mut backward = ends[block].clone();
        filtered(block, &mut backward);
        ends[block - 1] = backward;
    }
    let all = ends.into_iter().enumerate().flat_map(move |(block, mut backward)| filtered(block, &mut backward));
    Some(all.skip(extension).take(end))
}

/// A section of second order at rest, by the bilinear transform with `k` the tangent of half the
/// cutoff's angle. The numerator is `scale`² (1 + `middle` z⁻¹ + z⁻²), by `k` and 2 for a low-pass,
/// and by 1 and -2 for a high-pass.
pub fn section(k: f64, damping: f64, scale: f64, middle: f64) -> impl FnMut(f64) -> f64 + Clone {
    let damping = 2.0 * k * damping;
    let gain = 1.0 / (1.0 + damping + k * k);
    let (b, a1, a2) = (gain * scale * scale, 2.0 * gain * (k * k - 1.0), gain * (1.0 - damping + k * k));
    let (mut z1, mut z2) = (0.0, 0.0);
    move |value| {
        let input = b * value;
        let output = input + z1;
        z1 = z2 + middle * input - a1 * output;
        z2 = input - a2 * output;
        output
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn low_pass(k: f64) -> impl FnMut(f64) -> f64 + Clone {
        let mut state = 0.0;
        move |value| {
            state += k * (value - state);
            state
        }
    }

    /// To the last bit.
    #[test]
    fn blocks_are_the_whole() {
        let (cutoff, step, extension) = (8.0, 0.001, 9);
        for count in [10, BLOCK_SAMPLES - 18, BLOCK_SAMPLES - 17, 3 * BLOCK_SAMPLES] {
            let signal: Vec<f64> = (0..count).map(|k| (0.01 * k as f64).sin() + (k % 7) as f64).collect();
            let mut whole: Vec<f64> = (1..=extension).rev().map(|k| 2.0 * signal[0] - signal[k]).collect();
            whole.extend(&signal);
            whole.extend((1..=extension).map(|k| 2.0 * signal[count - 1] - signal[count - 1 - k]));
            for _ in 0..2 {
                whole = whole.into_iter().map(low_pass((PI * cutoff * step).tan())).collect();
                whole.reverse();
            }
            let found: Vec<f64> = zero_phase(signal.into_iter(), cutoff, step, 1, low_pass).unwrap().collect();
            assert_eq!(found, whole[extension..][..count]);
        }
    }
}
