//! The response of a real machine, from recordings of its test.

use std::f64::consts::{SQRT_2, TAU};
use std::path::Path;

use moris_simulation::frequency_response::channel::{CHANNEL_COUNT, Channel, name, unit_in_si};
use moris_simulation::frequency_response::excitation::frequencies;
use moris_simulation::frequency_response::{Response, SETTLED_FRACTION};
use moris_washout::nalgebra::{Complex, Matrix3, Vector3};

use super::Measured;
use crate::message::Message;
use crate::recording::felt::{FELT_FORCE, FELT_RATE, FeltTable};
use crate::recording::{Conventions, Recording, RecordingError};
use crate::texts::text;

impl Measured {
    /// The responses in recordings, one of each test. Each has the vehicle's motion as any
    /// recording has it. Its columns `rider.specificForce.x` to `.z` and `rider.angularVelocity.x`
    /// to `.z` were measured at the head. The later half is evaluated.
    ///
    /// # Errors
    /// A file cannot be read, lacks columns, is too short for a period, or its motion is no sine on
    /// one channel at one of the test's frequencies.
    pub fn recorded<P: AsRef<Path>>(files: &[P]) -> Result<Self, RecordingError> {
        let mut test = files.iter().map(|file| of_file(file.as_ref())).collect::<Result<Vec<_>, _>>()?;
        test.sort_by(|a, b| (a.input as usize, a.frequency).partial_cmp(&(b.input as usize, b.frequency)).unwrap());
        Ok(Measured { test, small: Vec::new() })
    }
}

fn of_file(file: &Path) -> Result<Response, RecordingError> {
    let refused = |reason: Message| RecordingError::whole(file, reason);
    let recording = Recording::read(file, &Conventions::default())?;
    let table = FeltTable::read(file)?;
    let mut notes = Vec::new();
    let force = table.measured_part(&FELT_FORCE, &recording, &mut notes).map_err(|reason| refused(reason.into()))?;
    let rate = table.measured_part(&FELT_RATE, &recording, &mut notes).map_err(|reason| refused(reason.into()))?;
    let felt = force.iter().zip(&rate).map(|([x, y, z], [p, q, r])| [*x, *y, *z, *p, *q, *r]).collect::<Vec<_>>();
    let desired: Vec<[f64; CHANNEL_COUNT]> = recording
        .inputs()
        .iter()
        .map(|input| {
            let (force, rate) = (input.specific_force, input.angular_velocity);
            [force.x, force.y, force.z, rate.x, rate.y, rate.z]
        })
        .collect();
    of_series(&desired, &felt, recording.step()).map_err(|reason| refused(reason.into()))
}

/// The response that the later half of a test shows.
fn of_series(desired: &[[f64; CHANNEL_COUNT]], felt: &[[f64; CHANNEL_COUNT]], step: f64) -> Result<Response, String> {
    // Largest part of the input beside its sine, as a fraction of the sine: more is another
    // frequency.
    const MAX_IMPURITY: f64 = 0.1;
    let count = desired.len().min(felt.len());
    let half = count / 2;
    let whole_periods = |frequency: f64| (half as f64 * step * frequency / TAU + 1e-9).floor();
    let series = |rows: &[[f64; CHANNEL_COUNT]], channel: Channel, from: usize, to: usize| -> Vec<f64> {
        rows[from..to].iter().map(|row| row[channel as usize]).collect()
    };
    let fits = |&(channel, frequency): &(Channel, f64)| {
        let sine = Sine::of(&series(desired, channel, count - half, count), frequency, step);
        sine.coefficient.norm() / unit_in_si(channel)
    };
    let candidates = Channel::ALL.into_iter().flat_map(|channel| frequencies().map(|frequency| (channel, frequency)));
    let candidates = candidates.filter(|(_, frequency)| whole_periods(*frequency) >= 1.0);
    let largest = candidates.max_by(|a, b| fits(a).total_cmp(&fits(b)));
    let Some((input, frequency)) = largest else {
        return Err("is too short: its later half must have a whole period of the sine".to_owned());
    };
    let window = (whole_periods(frequency) * TAU / frequency / step).round() as usize;
    let from = count - window.min(half);
    let excitation = Sine::of(&series(desired, input, from, count), frequency, step);
    let amplitude = excitation.coefficient.norm();
    if amplitude == 0.0 || excitation.rest > MAX_IMPURITY {
        let (channel, percent) = (name(input), 100.0 * excitation.rest);
        return Err(text!["no-sine", channel, frequency, percent].to_string());
    }
    let outputs = Channel::ALL.map(|output| Sine::of(&series(felt, output, from, count), frequency, step));
    // The two halves of the window show whether the motion repeats itself.
    let middle = (from + count) / 2;
    let changes = Channel::ALL.into_iter().map(|output| {
        let [early, late] = [(from, middle), (middle, count)]
            .map(|(from, to)| Sine::of(&series(felt, output, from, to), frequency, step).coefficient.norm());
        (early - late).abs() / unit_in_si(output)
    });
    let change = changes.fold(0.0, f64::max) / (amplitude / unit_in_si(input));
    Ok(Response {
        input,
        frequency,
        amplitude,
        ratios: std::array::from_fn(|k| outputs[k].coefficient / excitation.coefficient),
        distortion: std::array::from_fn(|k| outputs[k].rest),
        limited: [0.0; 3],
        settled: whole_periods(frequency) < 2.0 || change <= SETTLED_FRACTION,
    })
}

/// The sine of a frequency in a series, by least squares beside a mean.
struct Sine {
    /// Complex amplitude, its phase that of the cosine at the first sample.
    coefficient: Complex<f64>,
    /// What remains, as a fraction of the sine (root mean squares).
    rest: f64,
}

impl Sine {
    fn of(values: &[f64], frequency: f64, step: f64) -> Self {
        let basis = |k: usize| {
            let (sin, cos) = (frequency * step * k as f64).sin_cos();
            Vector3::new(1.0, cos, sin)
        };
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for (k, value) in values.iter().enumerate() {
            let row = basis(k);
            normal += row * row.transpose();
            right += row * *value;
        }
        let fitted = normal.lu().solve(&right).unwrap_or_default();
        let left = values.iter().enumerate().map(|(k, value)| (value - basis(k).dot(&fitted)).powi(2));
        let rest = (left.sum::<f64>() / values.len().max(1) as f64).sqrt();
        let coefficient = Complex::new(fitted.y, -fitted.z);
        Sine { coefficient, rest: rest * SQRT_2 / coefficient.norm().max(f64::MIN_POSITIVE) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A machine with a known lag: ratio 0.8 at -30 degrees, beside gravity and a little noise.
    #[test]
    fn modulus_and_phase_of_a_recorded_sine_are_found() {
        let (frequency, step) = (frequencies()[6], 0.01);
        let rows = |amplitude: f64, phase: f64, offset: f64| -> Vec<[f64; CHANNEL_COUNT]> {
            let at = |k: usize| {
                let time = k as f64 * step;
                let mut row = [0.0, 0.0, 9.80665, 0.0, 0.0, 0.0];
                row[0] = offset + amplitude * (frequency * time + phase).sin() * (time / 8.0).min(1.0);
                row
            };
            (0..4000).map(at).collect()
        };
        let found = of_series(&rows(0.9, 0.0, 0.0), &rows(0.72, -0.5, 0.3), step).unwrap();
        assert_eq!((found.input, found.frequency, found.settled), (Channel::Surge, frequency, true));
        let ratio = found.ratios[0];
        assert!((ratio.norm() - 0.8).abs() < 1e-9 && (ratio.arg() + 0.5).abs() < 1e-9, "{ratio}");
        assert!(found.ratios[1..].iter().all(|ratio| ratio.norm() < 1e-9) && found.distortion[0] < 1e-9);
        let slow: Vec<_> = (0..40).map(|_| [0.0; CHANNEL_COUNT]).collect();
        assert!(of_series(&slow, &slow, step).unwrap_err().contains("too short"));
        let square: Vec<_> = (0..4000).map(|k| [f64::from((k / 150) % 2), 0.0, 9.8, 0.0, 0.0, 0.0]).collect();
        assert!(of_series(&square, &square, step).unwrap_err().contains("one channel and one frequency"));
    }
}
