//! The frequency response on all channels, measured on all cores.
//!
//! [`platform`] moves a platform with its drives by the washout's commands. [`recorded`] reads the
//! response off recordings of a real machine. [`limits`] compares either with bounds.

pub mod limits;
pub mod platform;
pub mod recorded;

use moris_simulation::frequency_response::channel::Channel;
use moris_simulation::frequency_response::excitation::{Amplitudes, frequencies};
use moris_simulation::frequency_response::{Response, response, response_on};
use moris_washout::{Output, ParameterError, Parameters, Washout};
use rayon::prelude::*;

use platform::NominalPlatform;

/// Responses on all channels at all frequencies, channel by channel in the order of the
/// frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// With the test's amplitudes.
    pub test: Vec<Response>,
    /// With a thousandth of them; empty for recordings of a machine.
    pub small: Vec<Response>,
}

/// True for two frequencies that are meant to be the same.
fn is_same_frequency(one: f64, other: f64) -> bool {
    // Largest distance of a frequency from the test's that it is meant to be, as a fraction.
    const SAME_FREQUENCY: f64 = 0.02;
    (one - other).abs() <= SAME_FREQUENCY * other
}

impl Measured {
    /// Measures on all cores, on the nominal platform with its drives or on one that moves exactly
    /// as commanded. `progress` is called after each of [`Measured::TESTS`].
    ///
    /// # Errors
    /// A parameter cannot be used; the message names it and the reason.
    pub fn of(
        parameters: &Parameters,
        amplitudes: Amplitudes,
        gravity_turns: bool,
        on_platform: bool,
        progress: impl Fn() + Sync,
    ) -> Result<Self, ParameterError> {
        // Amplitude of the small signals as a fraction of the test's: far from every limit.
        const SMALL_SIGNAL_FRACTION: f64 = 1e-3;
        let tests: Vec<(Channel, f64)> =
            Channel::ALL.iter().flat_map(|&channel| frequencies().map(|frequency| (channel, frequency))).collect();
        let at_rest = Washout::new(parameters)?;
        let platform = on_platform.then(|| NominalPlatform::new(parameters)).transpose()?;
        let all = |amplitudes: Amplitudes| {
            let measure = |&(channel, frequency): &(Channel, f64)| {
                let amplitude = amplitudes.of(channel, frequency);
                let measured = match platform.clone() {
                    Some(mut platform) => {
                        let felt = |commanded: &Output, step| platform.felt(commanded, step);
                        response_on(felt, &at_rest, channel, frequency, amplitude, gravity_turns)
                    }
                    None => response(&at_rest, channel, frequency, amplitude, gravity_turns),
                };
                progress();
                measured
            };
            tests.par_iter().map(measure).collect()
        };
        Ok(Measured { test: all(amplitudes), small: all(amplitudes.scaled(SMALL_SIGNAL_FRACTION)) })
    }

    /// The response with the test's amplitude to a channel at a frequency; `None` where it was not
    /// measured.
    pub fn at(&self, input: Channel, frequency: f64) -> Option<&Response> {
        self.test.iter().find(|one| one.input == input && is_same_frequency(one.frequency, frequency))
    }

    /// Number of tests.
    pub const TESTS: u64 = 2 * 6 * 12;
}
