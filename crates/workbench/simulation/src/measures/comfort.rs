//! Comfort: shaking, jolts and peaks of the felt force that the desired force does not have.
//!
//! The RMS error hides them. A jolt of 10 m/s2 for 10 ms, once a minute, raises an RMS error of
//! 0.40 m/s2 to 0.42 m/s2. The rider complains of nothing else.

use std::collections::VecDeque;
use std::f64::consts::PI;

use super::zero_phase::{section, zero_phase};

/// Frequency above which a felt force is shaking \[Hz\].
pub const SHAKE_FREQUENCY: f64 = 8.0;
/// Time over which shaking is averaged \[s\].
pub const SHAKE_TIME: f64 = 2.0;
/// Time within which a change of the force is a jolt \[s\].
pub const JOLT_TIME: f64 = 0.02;

/// Largest excess of the felt force over the desired force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Excess {
    /// The excess, at least 0 \[m/s2\].
    pub value: f64,
    /// When it occurs \[s\].
    pub time: f64,
}

/// Comfort of the force on one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comfort {
    /// RMS of the felt force above [`SHAKE_FREQUENCY`] over [`SHAKE_TIME`], less that of the
    /// desired force. None where the sampling is too coarse for that frequency, or the run too
    /// short for the filter.
    pub shake: Option<Excess>,
    /// Largest difference between two values of the felt force within [`JOLT_TIME`], less the
    /// largest such difference of the desired force from [`JOLT_TIME`] before to [`JOLT_TIME`]
    /// after it. None where the sampling is too coarse for that time.
    pub jolt: Option<Excess>,
    /// Largest absolute value of the felt force, less that of the desired force at any time.
    pub peak: Excess,
}

impl Comfort {
    /// Shake, jolt and peak; 0 where one is not available \[m/s2\].
    pub fn values(&self) -> [f64; 3] {
        [self.shake.unwrap_or_default(), self.jolt.unwrap_or_default(), self.peak].map(|excess| excess.value)
    }
}

/// Compares two forces on an axis on which the force at rest is `rest`. `desired` is sampled every
/// `step` seconds and linear between its samples. `felt` has a whole number of samples to a step,
/// and begins and ends with `desired`.
pub fn comfort(desired: &[f64], felt: &[f64], rest: f64, step: f64) -> Comfort {
    comfort_once(desired, felt.iter().copied(), rest, step)
}

/// As [`comfort`], of a felt force that is computed as it is asked for.
pub(super) fn comfort_once(
    desired: &[f64],
    felt: impl ExactSizeIterator<Item = f64> + Clone,
    rest: f64,
    step: f64,
) -> Comfort {
    let divisions = divisions(desired.len(), felt.len());
    let (desired, step) = (interpolated_signal(desired, divisions), step / divisions as f64);
    let changes = jolt_samples(desired.len(), step).map(|count| changes_around(desired.clone(), count));
    comfort_beside(felt, rest, step, largest_distance(desired.clone(), rest), shake_rms(desired, step), changes)
}

/// Comfort of a felt force by the peak, RMS and changes of the desired one, as [`Reference`] has
/// them.
fn comfort_beside(
    felt: impl ExactSizeIterator<Item = f64> + Clone,
    rest: f64,
    step: f64,
    peak: f64,
    rms: Option<impl Iterator<Item = f64>>,
    around: Option<impl Iterator<Item = f64>>,
) -> Comfort {
    let jolt = |count| {
        let excess = largest_change(felt.clone(), count).zip(around?).map(|(felt, desired)| felt - desired);
        Some(largest_excess(excess, |index| (index as f64 + 0.5 * count as f64) * step))
    };
    let shake = |desired| {
        let excess = shake_rms(felt.clone(), step)?.zip(desired).map(|(felt, desired)| felt - desired);
        Some(largest_excess(excess, |index| index as f64 * step))
    };
    Comfort {
        shake: rms.and_then(shake),
        jolt: jolt_samples(felt.len(), step).and_then(jolt),
        peak: largest_excess(felt.clone().map(|value| (value - rest).abs() - peak), |index| index as f64 * step),
    }
}

/// Largest distance from rest.
fn largest_distance(force: impl Iterator<Item = f64>, rest: f64) -> f64 {
    force.map(|value| (value - rest).abs()).fold(0.0, f64::max)
}

/// Samples of the felt force to one of the desired force, of series of these lengths.
pub fn divisions(desired: usize, felt: usize) -> usize {
    (felt.max(2) - 1) / (desired.max(2) - 1)
}

/// The desired force on an axis, prepared for comparisons with several felt ones.
#[derive(Clone, Debug)]
pub struct Reference {
    rest: f64,
    /// Time between samples of the felt force \[s\].
    step: f64,
    /// RMS above [`SHAKE_FREQUENCY`] over [`SHAKE_TIME`] around each sample.
    rms: Option<Vec<f64>>,
    /// Largest change within [`JOLT_TIME`], from [`JOLT_TIME`] before to [`JOLT_TIME`] after the
    /// one from each sample.
    changes: Option<Vec<f64>>,
    /// Largest absolute value.
    peak: f64,
}

impl Reference {
    /// The desired force, sampled every `step` seconds, for felt forces of `divisions` samples to a
    /// step. The force at rest is `rest`.
    pub fn new(desired: &[f64], divisions: usize, rest: f64, step: f64) -> Self {
        let desired = interpolated_signal(desired, divisions);
        let step = step / divisions as f64;
        Reference {
            rest,
            step,
            rms: shake_rms(desired.clone(), step).map(Iterator::collect),
            changes: jolt_samples(desired.len(), step).map(|count| changes_around(desired.clone(), count).collect()),
            peak: largest_distance(desired, rest),
        }
    }

    /// True if it is for felt forces of so many samples to a step.
    pub fn is_for(&self, divisions: usize, step: f64) -> bool {
        self.step == step / divisions as f64
    }

    /// Compares a felt force, which begins and ends with the desired one.
    pub fn comfort(&self, felt: impl ExactSizeIterator<Item = f64> + Clone) -> Comfort {
        let [rms, changes] = [&self.rms, &self.changes].map(|kept| kept.as_ref().map(|kept| kept.iter().copied()));
        comfort_beside(felt, self.rest, self.step, self.peak, rms, changes)
    }
}

/// The signal with so many samples to a step.
fn interpolated_signal(signal: &[f64], divisions: usize) -> impl ExactSizeIterator<Item = f64> + Clone {
    let count = signal.len().saturating_sub(1) * divisions + signal.len().min(1);
    (0..count).map(move |sample| {
        let Some(after) = sample.checked_sub(1) else { return signal[0] };
        let (from, to) = (signal[after / divisions], signal[after / divisions + 1]);
        // Exact at the samples themselves.
        let t = (after % divisions + 1) as f64 / divisions as f64;
        (1.0 - t) * from + t * to
    })
}

/// The largest of these values with its time, at least 0.
fn largest_excess(values: impl Iterator<Item = f64>, time: impl Fn(usize) -> f64) -> Excess {
    let (index, value) = values.enumerate().fold((0, 0.0), |most, next| if next.1 > most.1 { next } else { most });
    Excess { value, time: time(index) }
}

/// Samples in [`JOLT_TIME`]; none where the sampling is too coarse or the signal too short.
fn jolt_samples(length: usize, step: f64) -> Option<usize> {
    // Rounding must not make the time a sample shorter.
    let count = (JOLT_TIME / step * (1.0 + 1e-9)).floor() as usize;
    (count > 0 && length > count).then_some(count)
}

/// Largest difference between any two of `count + 1` samples in succession, from each sample that
/// has so many after it.
fn largest_change(signal: impl ExactSizeIterator<Item = f64> + Clone, count: usize) -> impl Iterator<Item = f64> {
    let length = signal.len() - count;
    let negative = signal.clone().map(|value| -value);
    let extremes = sliding_max(signal, 0, count).zip(sliding_max(negative, 0, count));
    extremes.map(|(most, least)| most + least).take(length)
}

/// The largest of such differences from `count` samples before each to `count` samples after it.
fn changes_around(signal: impl ExactSizeIterator<Item = f64> + Clone, count: usize) -> impl Iterator<Item = f64> {
    let length = signal.len() - count;
    sliding_max(largest_change(signal, count), count, count).take(length)
}

/// The largest of the values from `before` samples before each to `after` samples after it. The
/// series continues beyond the last one.
fn sliding_max(values: impl Iterator<Item = f64>, before: usize, after: usize) -> impl Iterator<Item = f64> {
    // Values that no later one exceeds, the largest first.
    let mut candidates: VecDeque<(usize, f64)> = VecDeque::new();
    let mut coming = values.enumerate().peekable();
    (0..).map_while(move |k| {
        while let Some((index, value)) = coming.next_if(|(index, _)| *index <= k + after) {
            while candidates.back().is_some_and(|(_, last)| *last <= value) {
                candidates.pop_back();
            }
            candidates.push_back((index, value));
        }
        while candidates.front().is_some_and(|(first, _)| first + before < k) {
            candidates.pop_front();
        }
        candidates.front().map(|(_, value)| *value)
    })
}

/// RMS above [`SHAKE_FREQUENCY`] over [`SHAKE_TIME`] around each sample. Outside of the signal is
/// rest.
fn shake_rms(signal: impl ExactSizeIterator<Item = f64> + Clone, step: f64) -> Option<impl Iterator<Item = f64>> {
    let (length, window) = (signal.len(), (SHAKE_TIME / step).round() as usize);
    let mut squares = above_shake_frequency(signal, step)?.map(|value| value * value);
    // Sums of the squares before each sample of the window, and before the one behind it.
    let mut sums = VecDeque::from([0.0]);
    let (mut sum, mut summed) = (0.0, 0);
    Some((0..length).map(move |k| {
        if k > window / 2 {
            sums.pop_front();
        }
        while summed < (k + window - window / 2).min(length) {
            sum += squares.next().unwrap_or_default();
            summed += 1;
            sums.push_back(sum);
        }
        ((sum - sums[0]) / window as f64).max(0.0).sqrt()
    }))
}

/// The signal above [`SHAKE_FREQUENCY`], without a shift in time: a Butterworth high-pass of fourth
/// order, forward and backward. None where the sampling is too coarse or the signal too short.
fn above_shake_frequency(
    signal: impl ExactSizeIterator<Item = f64> + Clone,
    step: f64,
) -> Option<impl Iterator<Item = f64>> {
    zero_phase(signal, SHAKE_FREQUENCY, step, 2, high_pass)
}

/// Butterworth high-pass of fourth order by the bilinear transform, with `k` the tangent of half
/// the cutoff's angle. The filter starts as if the first value had always been there.
fn high_pass(k: f64) -> impl FnMut(f64) -> f64 + Clone {
    // A pole pair at this angle from the negative real axis has the damping cos(angle).
    let mut sections = [PI / 8.0, 3.0 * PI / 8.0].map(|angle| section(k, angle.cos(), 1.0, -2.0));
    let mut first = None;
    move |value| {
        let first = *first.get_or_insert(value);
        sections.iter_mut().fold(value - first, |value, section| section(value))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{SQRT_2, TAU};

    use super::*;

    fn sampled(rate: usize, seconds: usize, signal: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..seconds * rate).map(|k| signal(k as f64 / rate as f64)).collect()
    }

    fn after(start: f64, time: f64) -> f64 {
        if time > start - 1e-9 { 1.0 } else { 0.0 }
    }

    /// A slow swing with a vibration of 12 Hz from 1 s on and a step at 2 s.
    fn rough(t: f64) -> f64 {
        1.5 * (2.0 * t).sin() + 0.4 * after(1.0, t) * (TAU * 12.0 * t).sin() + 0.8 * after(2.0, t)
    }

    fn vibrating(t: f64) -> f64 {
        1.5 * (2.0 * t).sin() + 0.1 * (TAU * 20.0 * t).sin()
    }

    fn assert_near(value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance, "{value} is not {expected}");
    }

    #[test]
    fn the_filter_is_scipy_s_butter_and_sosfiltfilt() {
        // sosfiltfilt(butter(4, 8, "high", fs=rate, output="sos"), rough), SciPy 1.15.
        let expected_100 = [
            (0, 0.0003094285962699176),
            (3, 0.00047623290591739095),
            (98, -0.07590682969427931),
            (100, -0.10860101159643984),
            (150, 1.1702564139987048e-05),
            (199, -0.6001446266124376),
            (200, 0.3346305477750375),
            (203, 0.3228880318770464),
            (297, -0.23732499647162952),
            (299, 0.02702613713766404),
        ];
        let expected_1000 = [
            (0, -0.00244062121859),
            (30, 0.005664590628989865),
            (980, -0.07814756398746453),
            (1990, -0.5407169187744286),
            (2000, 0.39343283314131805),
            (2970, -0.17899981061604867),
            (2990, -0.09853660705067674),
        ];
        for (rate, expected) in [(100, &expected_100[..]), (1000, &expected_1000)] {
            let filtered = above_shake_frequency(sampled(rate, 3, rough).into_iter(), 1.0 / rate as f64).unwrap();
            let filtered: Vec<f64> = filtered.collect();
            for (k, value) in expected {
                assert_near(filtered[*k], *value, 1e-9);
            }
        }
    }

    #[test]
    fn shake_is_what_numpy_makes_of_both_signals() {
        // The largest difference of sqrt(convolve(y * y, ones(n) / n, "same")) with n samples in 2 s.
        for (rate, value, index) in [(100, 0.2100801792871749, 200), (1000, 0.20900338052645534, 2012)] {
            let step = 1.0 / rate as f64;
            let (desired, felt) = (sampled(rate, 3, vibrating), sampled(rate, 3, rough));
            let shake = comfort(&desired, &felt, 0.0, step).shake.unwrap();
            assert_near(shake.value, value, 1e-9);
            assert_near(shake.time, index as f64 * step, 1e-9);
        }
    }

    #[test]
    fn a_sine_shakes_by_its_rms_times_the_filter_s_modulus_squared() {
        for rate in [20, 50, 100, 1000] {
            let felt = sampled(rate, 20, |t| 0.5 * (TAU * 9.0 * t).sin());
            let still = vec![0.0; felt.len()];
            let shake = comfort(&still, &felt, 0.0, 1.0 / rate as f64).shake.unwrap();
            let tangent = |frequency: f64| (PI * frequency / rate as f64).tan();
            let modulus_squared = 1.0 / (1.0 + (tangent(8.0) / tangent(9.0)).powi(8));
            assert_near(shake.value, 0.5 / SQRT_2 * modulus_squared, 5e-3);
            // What is desired, too, is no shaking, nor is what is desired and not felt.
            assert_eq!(comfort(&felt, &felt, 0.0, 1.0 / rate as f64).shake.unwrap().value, 0.0);
            assert_eq!(comfort(&felt, &still, 0.0, 1.0 / rate as f64).shake.unwrap().value, 0.0);
        }
    }

    #[test]
    fn a_jolt_is_a_change_within_20_ms_beyond_that_of_the_desired_force_around_it() {
        let step_at = |start: f64, size: f64| move |t: f64| size * after(start, t);
        for rate in [50, 100, 128, 1000] {
            let step = 1.0 / rate as f64;
            let jolt = |desired: &dyn Fn(f64) -> f64, felt: &dyn Fn(f64) -> f64| {
                comfort(&sampled(rate, 4, desired), &sampled(rate, 4, felt), 0.0, step).jolt.unwrap()
            };
            let found = jolt(&|_| 0.0, &step_at(2.0, -6.0));
            assert_near(found.value, 6.0, 1e-12);
            assert_near(found.time, 2.0, 0.02);
            // A desired step accounts for as much of it, a little before or after as well.
            assert_near(jolt(&step_at(2.0, 4.0), &step_at(2.0, 6.0)).value, 2.0, 1e-12);
            assert_near(jolt(&step_at(2.0, 4.0), &step_at(2.0 + step, 6.0)).value, 2.0, 1e-12);
            assert_near(jolt(&step_at(1.0, 4.0), &step_at(2.0, 6.0)).value, 6.0, 1e-12);
            // A slope has what it rises by in 20 ms, in whole samples.
            let rise = 30.0 * (0.02 * rate as f64).floor() * step;
            assert_near(jolt(&|_| 0.0, &|t| 30.0 * t).value, rise, 1e-9);
        }
    }

    #[test]
    fn a_jolt_of_a_millisecond_between_the_desired_samples_is_found() {
        let desired = sampled(100, 4, |t| t);
        let felt: Vec<f64> = (0..=3990).map(|k| 0.001 * f64::from(k) + if k == 1234 { 9.0 } else { 0.0 }).collect();
        let found = comfort(&desired, &felt, 0.0, 0.01);
        let jolt = found.jolt.unwrap();
        assert_near(jolt.value, 9.0, 0.021);
        assert_near(jolt.time, 1.234, 0.011);
        assert_near(found.peak.value, 9.0 + 1.234 - 3.99, 1e-9);
        assert_near(found.peak.time, 1.234, 1e-9);
    }

    #[test]
    fn a_peak_is_measured_from_rest_and_less_than_desired_is_none() {
        const G: f64 = 9.80665;
        let desired = sampled(100, 4, |t| G + (TAU * t).sin());
        let more = sampled(100, 4, |t| G - 3.0 * (TAU * t).sin());
        let less = sampled(100, 4, |t| G + 0.3 * (TAU * t).sin());
        assert_near(comfort(&desired, &more, G, 0.01).peak.value, 2.0, 1e-12);
        assert_eq!(comfort(&desired, &less, G, 0.01).values(), [0.0; 3]);
    }

    #[test]
    fn a_reference_serves_several_felt_forces() {
        let desired = sampled(100, 4, vibrating);
        let reference = Reference::new(&desired, divisions(400, 3991), 0.5, 0.01);
        for size in [0.2, 1.0, 3.0] {
            let felt: Vec<f64> = (0..=3990).map(|k| size * rough(0.001 * f64::from(k))).collect();
            let found = reference.comfort(felt.iter().copied());
            assert_eq!(found, comfort(&desired, &felt, 0.5, 0.01));
            assert!(size < 1.0 || found.values().iter().all(|value| *value > 0.1), "{found:?}");
        }
    }

    #[test]
    fn too_coarse_a_sampling_gives_no_number() {
        let signals = |rate: usize| (sampled(rate, 20, |_| 0.0), sampled(rate, 20, |t| (TAU * t).sin()));
        let of = |rate: usize| {
            let (desired, felt) = signals(rate);
            comfort(&desired, &felt, 0.0, 1.0 / rate as f64)
        };
        assert!(of(16).shake.is_none() && of(17).shake.is_some());
        assert!(of(49).jolt.is_none() && of(50).jolt.is_some());
        assert!(of(10).peak.value > 0.9);
        // The filter needs more samples than its extension.
        assert!(comfort(&[0.0; 15], &[0.0; 15], 0.0, 0.01).shake.is_none());
        // A felt force that is sampled finely enough is judged, however coarse the desired force.
        let coarse = comfort(&[0.0; 11], &sampled(100, 10, |_| 0.0)[..=990], 0.0, 1.0);
        assert!(coarse.shake.is_some() && coarse.jolt.is_some());
    }
}
