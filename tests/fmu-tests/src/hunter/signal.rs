//! Waveforms of the inputs.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::random::{bits_at, fraction_at};
use super::reach::Reach;

/// The course of one input over time.
///
/// A value follows from the step's number, the time and the last output alone, so that an episode
/// can be cut anywhere. Amplitudes are in the input's unit, frequencies in rad/s, phases in rad.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "form", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Signal {
    /// A constant.
    Held { value: f64 },
    /// A square wave: the sign of a sine.
    Square { amplitude: f64, frequency: f64, phase: f64 },
    /// A sine.
    Sine { amplitude: f64, frequency: f64, phase: f64 },
    /// A square wave whose frequency grows by `rate` \[rad/s2\].
    Chirp { amplitude: f64, frequency: f64, rate: f64 },
    /// A value for `width` steps out of every `period` steps, of alternating sign; zero otherwise.
    Impulses { amplitude: f64, period: usize, width: usize },
    /// Uniform noise, a new value every `held` steps.
    Noise { amplitude: f64, held: usize, seed: u32 },
    /// `amplitude` or its negative at random, a new choice every `held` steps.
    Flips { amplitude: f64, held: usize, seed: u32 },
    /// A value that changes by this much a second.
    Ramp { rate: f64 },
    /// NaN, infinities, numbers near the ends of the range, and ordinary ones; a new
    /// choice every `held` steps.
    NonFinite { held: usize, seed: u32 },
    /// `amplitude` with the sign of a velocity of the last output: it always pushes along, or
    /// against with a negative one.
    Pushing { amplitude: f64, velocity: usize },
    /// `amplitude` while a leg or an axis is nearer to its end than this fraction of half its
    /// range, and its negative otherwise.
    AtEnd { amplitude: f64, room: f64 },
    /// `amplitude` while a leg or an axis is faster than this fraction of its limit, and its
    /// negative otherwise.
    AtSpeed { amplitude: f64, fraction: f64 },
}

/// The velocities that [`Signal::Pushing`] may follow: three of the platform, three
/// angular, six of the legs.
pub const VELOCITIES: usize = 12;

/// Quantities of the last output that a signal may follow.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    pub velocities: [f64; VELOCITIES],
    /// Known if a signal asks for it.
    pub reach: Option<Reach>,
}

impl Signal {
    /// No signal.
    pub const ZERO: Signal = Signal::Held { value: 0.0 };

    /// True if the signal follows how near the last output is to its limits.
    pub fn follows_reach(&self) -> bool {
        matches!(self, Signal::AtEnd { .. } | Signal::AtSpeed { .. })
    }

    /// The value at step number `step`, which begins at `time` \[s\], after an output of which
    /// this is `seen`.
    #[inline]
    pub fn value(&self, step: usize, time: f64, seen: &Seen) -> f64 {
        match *self {
            Signal::Held { value } => value,
            Signal::Square { amplitude, frequency, phase } => square(amplitude, frequency * time + phase),
            Signal::Sine { amplitude, frequency, phase } => amplitude * (frequency * time + phase).sin(),
            Signal::Chirp { amplitude, frequency, rate } => square(amplitude, (frequency + 0.5 * rate * time) * time),
            Signal::Impulses { amplitude, period, width } => {
                let (number, within) = (step / period.max(1), step % period.max(1));
                if within >= width {
                    0.0
                } else if number % 2 == 0 {
                    amplitude
                } else {
                    -amplitude
                }
            }
            Signal::Noise { amplitude, held, seed } => amplitude * (2.0 * fraction_at(seed, step / held.max(1)) - 1.0),
            Signal::Flips { amplitude, held, seed } => {
                if bits_at(seed, step / held.max(1)) & 1 == 0 {
                    amplitude
                } else {
                    -amplitude
                }
            }
            Signal::Ramp { rate } => rate * time,
            Signal::NonFinite { held, seed } => non_finite(bits_at(seed, step / held.max(1))),
            Signal::Pushing { amplitude, velocity } => {
                let velocity = seen.velocities[velocity % VELOCITIES];
                if velocity == 0.0 { amplitude } else { amplitude.copysign(amplitude * velocity) }
            }
            Signal::AtEnd { amplitude, room } => {
                if seen.reach.is_some_and(|reach| reach.room < room) {
                    amplitude
                } else {
                    -amplitude
                }
            }
            Signal::AtSpeed { amplitude, fraction } => {
                if seen.reach.is_some_and(|reach| reach.speed > fraction) {
                    amplitude
                } else {
                    -amplitude
                }
            }
        }
    }

    /// The signal's numbers, for a search for simpler ones.
    pub fn numbers(&mut self) -> Vec<&mut f64> {
        match self {
            Signal::Held { value } => vec![value],
            Signal::Square { amplitude, frequency, phase } | Signal::Sine { amplitude, frequency, phase } => {
                vec![amplitude, frequency, phase]
            }
            Signal::Chirp { amplitude, frequency, rate } => vec![amplitude, frequency, rate],
            Signal::Impulses { amplitude, .. }
            | Signal::Noise { amplitude, .. }
            | Signal::Flips { amplitude, .. }
            | Signal::Pushing { amplitude, .. } => vec![amplitude],
            Signal::AtEnd { amplitude, room: threshold } | Signal::AtSpeed { amplitude, fraction: threshold } => {
                vec![amplitude, threshold]
            }
            Signal::Ramp { rate } => vec![rate],
            Signal::NonFinite { .. } => vec![],
        }
    }
}

/// The sign of the sine of an angle, times the amplitude.
fn square(amplitude: f64, angle: f64) -> f64 {
    if (angle / TAU).rem_euclid(1.0) < 0.5 { amplitude } else { -amplitude }
}

/// Values that no vehicle gives, among a few that one does.
fn non_finite(bits: u64) -> f64 {
    const VALUES: [f64; 16] = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e300,
        -1e300,
        f64::MAX,
        f64::MIN,
        f64::MIN_POSITIVE,
        5e-324,
        -0.0,
        1e9,
        -1e9,
        1.0,
        -1.0,
        0.1,
        -0.1,
    ];
    VALUES[(bits % VALUES.len() as u64) as usize]
}
