//! The frequency response on all channels, measured on all cores.

use moris_simulation::frequency_response::channel::Channel;
use moris_simulation::frequency_response::excitation::{Amplitudes, frequencies};
use moris_simulation::frequency_response::{Response, response};
use moris_washout::{ParameterError, Parameters, Washout};
use rayon::prelude::*;

/// Amplitude of the small signals as a fraction of the test's: far from every limit.
const SMALL: f64 = 1e-3;

/// Responses on all channels at all frequencies, channel by channel in the order of the
/// frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// With the test's amplitudes.
    pub test: Vec<Response>,
    /// With a thousandth of them.
    pub small: Vec<Response>,
}

impl Measured {
    /// Measures on all cores. `progress` is called after each of [`Measured::TESTS`].
    ///
    /// # Errors
    /// A parameter cannot be used; the message names it and the reason.
    pub fn of(
        parameters: &Parameters,
        amplitudes: Amplitudes,
        gravity_turns: bool,
        progress: impl Fn() + Sync,
    ) -> Result<Self, ParameterError> {
        let tests: Vec<(Channel, f64)> =
            Channel::ALL.iter().flat_map(|&channel| frequencies().map(|frequency| (channel, frequency))).collect();
        let at_rest = Washout::new(parameters)?;
        let all = |amplitudes: Amplitudes| {
            let measure = |&(channel, frequency): &(Channel, f64)| {
                let amplitude = amplitudes.of(channel, frequency);
                let measured = response(&at_rest, channel, frequency, amplitude, gravity_turns);
                progress();
                measured
            };
            tests.par_iter().map(measure).collect()
        };
        Ok(Measured { test: all(amplitudes), small: all(amplitudes.scaled(SMALL)) })
    }

    /// Number of tests.
    pub const TESTS: u64 = 2 * 6 * 12;
}
