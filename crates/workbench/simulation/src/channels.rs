//! One channel of a recording: desired and felt signals, and errors.

use crate::measures::comfort::Comfort;
use crate::measures::cues::Cues;
use crate::measures::fidelity::Fidelity;
use crate::measures::shape::AxisShape;
use moris_washout::platform::reach::Axis;

use crate::measures::cues::RATE_THRESHOLDS;
use crate::measures::statistics::rms;
use crate::{Evaluated, Simulation};

/// A channel's figures, in m/s2 or rad/s.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelFigures {
    /// The specific force along this axis, or the angular velocity about it.
    pub axis: Axis,
    /// RMS of the desired signal, as a deviation from rest: the error of a platform at rest.
    pub at_rest: f64,
    /// RMS error of roll or pitch rate without the rotation of tilt coordination. None where the
    /// tilt alone turns faster than the threshold of perception, and where it is not known.
    pub without_tilt: Option<f64>,
    /// The least RMS error that any controller could reach; none where it was not computed.
    pub bound: Option<f64>,
    /// Fidelity of the felt signal.
    pub felt: Fidelity,
    /// Fidelity of the vestibular model's response; none where nothing is sensed.
    pub sensed: Option<Fidelity>,
    /// Shake, jolt and peak of a force; none of a rate.
    pub comfort: Option<Comfort>,
    /// Shape, size and inverted time of surge and sway, where enough is desired.
    pub shape: Option<AxisShape>,
    /// Fractions of the time with a cue in the vehicle, a false one and a
    /// missing one on the platform.
    pub cues: Cues,
}

impl ChannelFigures {
    /// The unit that people read.
    pub fn unit(&self) -> &'static str {
        if self.axis.is_rotation() { "°/s" } else { "m/s²" }
    }

    /// A value in this unit.
    pub fn in_unit(&self, value: f64) -> f64 {
        if self.axis.is_rotation() { value.to_degrees() } else { value }
    }

    /// The error as a multiple of that of a platform at rest.
    pub fn ratio(&self) -> f64 {
        self.felt.rms_error / self.at_rest
    }
}

/// RMS error of roll or pitch rate without the rotation of tilt coordination \[rad/s\].
fn error_without_tilt(simulation: &Simulation, axis: Axis) -> Option<f64> {
    // Fraction of the time in which a tilt may turn faster than is perceived, and how much faster:
    // the start value of tilt.rateLimit is the threshold of roll, rounded up.
    const MAX_PERCEIVED_TILT: f64 = 0.05;
    const PERCEIVED_EXCESS: f64 = 1e-3;
    let place = [Axis::Roll, Axis::Pitch].iter().position(|other| *other == axis)?;
    let outputs = &simulation.outputs;
    let tilt = |sample: usize| [outputs[sample].tilt_roll_rate, outputs[sample].tilt_pitch_rate][place];
    let threshold = RATE_THRESHOLDS[place] * (1.0 + PERCEIVED_EXCESS);
    let perceived = (0..outputs.len()).filter(|sample| tilt(*sample).abs() > threshold).count();
    let is_hidden = perceived as f64 <= MAX_PERCEIVED_TILT * outputs.len() as f64;
    (simulation.foreign.is_none() && is_hidden).then(|| {
        rms((0..outputs.len()).map(|sample| {
            outputs[sample].felt_angular_velocity[place] - tilt(sample) - simulation.desired_rate(sample)[place]
        }))
    })
}

/// The channels of a recording on which something is desired or felt; without rates where another
/// washout's are not known.
pub fn channels(evaluated: &Evaluated) -> Vec<ChannelFigures> {
    let Evaluated { measures, bounds, .. } = evaluated;
    let channel = |&axis: &Axis| {
        let k = axis as usize % 3;
        let is_force = !axis.is_rotation();
        let (at_rest, felt, sensed, cues) = if is_force {
            (evaluated.desired_rms(k), measures.force[k], measures.sensed_force[k], measures.force_cues[k])
        } else {
            (evaluated.desired_rate_rms(k), measures.rate[k], measures.sensed_rate[k], measures.rate_cues[k])
        };
        Some(ChannelFigures {
            axis,
            at_rest,
            without_tilt: error_without_tilt(evaluated.simulation, axis),
            bound: bounds[k].filter(|_| is_force),
            felt: felt?,
            sensed,
            shape: measures.shape.axes.get(k).copied().flatten().filter(|_| is_force),
            comfort: measures.comfort[k].filter(|_| is_force),
            cues,
        })
    };
    let has_rate = evaluated.simulation.foreign.as_ref().is_none_or(|foreign| foreign.has_rate);
    Axis::ALL.iter().filter(|axis| has_rate || !axis.is_rotation()).filter_map(channel).collect()
}
