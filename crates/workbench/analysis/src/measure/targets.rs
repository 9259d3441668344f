//! Figures that a set of parameters is to reach, and those that it misses.

use moris_simulation::capitalised;
use moris_simulation::channels::ChannelFigures;
use moris_simulation::frequency_response::channel::name;
use moris_washout::platform::reach::Axis;

use super::MeasuredRecording;
use crate::message::Message;
use crate::texts::text;

/// A force on which less than this is desired does not count. An error below it counts as
/// this \[m/s2\].
pub const LEAST_FORCE: f64 = 0.03;

/// Targets for a set of parameters.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(feature = "clap", command(next_help_heading = "Targets"))]
pub struct Targets {
    /// Largest geometric mean of the RMS errors of surge and sway over all recordings, each
    /// error at least 0.03 m/s2
    #[cfg_attr(feature = "clap", arg(long, value_name = "M/S2", default_value_t = 0.68))]
    pub geometric_mean: f64,

    /// Largest RMS error of surge and sway, as a multiple of that of a platform at rest
    #[cfg_attr(feature = "clap", arg(long, value_name = "RATIO", default_value_t = 1.15))]
    pub ratio: f64,

    /// Recordings, by name, of which no ratio is asked: they have a set of their own
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME", value_delimiter = ','))]
    pub ratio_except: Vec<String>,

    /// Largest RMS error of heave beyond that of a platform at rest
    #[cfg_attr(feature = "clap", arg(long, value_name = "M/S2", default_value_t = 0.15))]
    pub heave: f64,

    /// Largest fraction of a recording's steps in which a safety unit or the actuator
    /// guard limits the platform
    #[cfg_attr(feature = "clap", arg(long, value_name = "FRACTION", default_value_t = 0.01))]
    pub limited: f64,

    /// Largest fraction of the time with a false or a missing cue of a rate, over all recordings,
    /// beyond that of a platform at rest
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "FRACTION", default_value_t = 0.0, allow_negative_numbers = true)
    )]
    pub cues: f64,
}

/// Surge and sway, where something is desired.
pub fn counts(channel: &ChannelFigures) -> bool {
    matches!(channel.axis, Axis::Surge | Axis::Sway) && channel.at_rest >= LEAST_FORCE
}

/// Geometric mean of the RMS errors of surge and sway, each at least [`LEAST_FORCE`], and their
/// number.
pub fn geometric_mean(recordings: &[MeasuredRecording]) -> (f64, usize) {
    let channels = recordings.iter().flat_map(|recording| &recording.channels);
    let errors = channels.filter(|channel| counts(channel)).map(|channel| channel.felt.rms_error);
    let logarithms: Vec<f64> = errors.map(|error| error.max(LEAST_FORCE).ln()).collect();
    ((logarithms.iter().sum::<f64>() / logarithms.len().max(1) as f64).exp(), logarithms.len())
}

/// Fractions of the time, weighted by the recordings' durations: a false or a missing cue of a
/// rate, and the same on a platform at rest.
pub fn wrong_cues(recordings: &[MeasuredRecording], axis: Axis) -> [f64; 2] {
    let duration: f64 = recordings.iter().map(|recording| recording.duration).sum();
    let mut wrong = [0.0; 2];
    for recording in recordings {
        for channel in recording.channels.iter().filter(|channel| channel.axis == axis) {
            let weight = recording.duration / duration;
            wrong[0] += weight * (channel.cues.false_cues + channel.cues.missing_cues);
            wrong[1] += weight * channel.cues.desired;
        }
    }
    wrong
}

impl Targets {
    /// The targets that are missed, in sentences with the options that set them.
    pub fn missed(&self, recordings: &[MeasuredRecording]) -> Vec<Message> {
        let (mean, channels) = geometric_mean(recordings);
        let allowed = self.geometric_mean;
        let mean = (mean > allowed).then(|| text!["mean-above-target", channels, mean, allowed]);
        let of_axis = |axis: Axis| {
            let [wrong, at_rest] = wrong_cues(recordings, axis);
            let (channel, percent) = (capitalised(name(axis)), [100.0 * wrong, 100.0 * at_rest]);
            let is_missed = wrong > at_rest + self.cues;
            is_missed.then(|| text!["cues-above-target", channel, wrong = percent[0], at_rest = percent[1]])
        };
        let cues = [Axis::Roll, Axis::Pitch, Axis::Yaw].into_iter().filter_map(of_axis);
        let on_recordings = recordings.iter().flat_map(|recording| self.missed_on(recording));
        mean.into_iter().chain(on_recordings).chain(cues).collect()
    }

    fn missed_on(&self, recording: &MeasuredRecording) -> Vec<Message> {
        let mut missed = Vec::new();
        let recorded = &recording.name;
        for channel in &recording.channels {
            let (error, ratio, at_rest) = (channel.felt.rms_error, channel.ratio(), channel.at_rest);
            if counts(channel) && !self.ratio_except.contains(recorded) && ratio > self.ratio {
                let (channel, allowed) = (name(channel.axis), self.ratio);
                missed.push(text!["ratio-above-target", recorded, channel, error, ratio, at_rest, allowed]);
            }
            if channel.axis == Axis::Heave && error > at_rest + self.heave {
                missed.push(text!["heave-above-target", recorded, error, allowed = self.heave, at_rest]);
            }
        }
        if recording.limited > self.limited {
            let (percent, allowed) = (100.0 * recording.limited, 100.0 * self.limited);
            missed.push(text!["limits-above-target", recorded, percent, allowed]);
        }
        missed
    }
}
