//! The figures of recordings, channel by channel, and the targets for them.

pub mod targets;

use moris_setup::Setup;
use moris_simulation::channels::{ChannelFigures, channels};
use moris_simulation::measures::{Limits, Measures};
use moris_simulation::preview::Previewer;

use crate::bounds;
use crate::error::Result;
use crate::host::Host;
use crate::outcome::Outcome;
use crate::recording::Recording;

/// The figures of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredRecording {
    /// The recording's name.
    pub name: String,
    /// Duration \[s\].
    pub duration: f64,
    /// The channels on which something is desired or felt.
    pub channels: Vec<ChannelFigures>,
    /// Fractions of the steps in which tilt coordination was limited, and in which the soft limits,
    /// a safety unit and the actuator guard were active.
    pub limits: Limits<f64>,
    /// Fraction of the steps in which a safety unit or the actuator guard limited the platform.
    pub limited: f64,
    /// Fraction of the stroke used.
    pub stroke_used: f64,
}

impl MeasuredRecording {
    /// Replays and measures a recording, with a preview that is learned, if there is one.
    ///
    /// # Errors
    /// The parameters cannot be used, the steps do not fit, or there is no bound.
    pub fn of(
        recording: &Recording,
        setup: &Setup,
        host: &Host,
        learned: Option<Previewer>,
        with_bound: bool,
    ) -> Result<Self> {
        let simulation = host.replay(recording, &recording.parameters(&setup.parameters), learned)?;
        let mut outcome = Outcome::measured(simulation, setup)?;
        if with_bound {
            outcome.bounds = bounds::bounds(&outcome.simulation)?;
        }
        let Outcome { simulation, measures: Measures { effort, .. }, .. } = &outcome;
        let steps = simulation.outputs.len().max(2) - 1;
        let limited = simulation.outputs[1..].iter().filter(|output| output.safety_active || output.actuator_limited);
        Ok(MeasuredRecording {
            name: recording.name.clone(),
            duration: recording.manoeuvre.duration(),
            channels: channels(&outcome.evaluated()),
            limits: effort.limited,
            limited: limited.count() as f64 / steps as f64,
            stroke_used: effort.stroke_used,
        })
    }
}
