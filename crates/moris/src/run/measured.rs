//! The measures of a recording.

use moris_measures::{Limited, Measures, Platform, Run, RunError};
use moris_washout::{Input, Output};

use super::Recording;

/// Measures a recording.
///
/// # Errors
/// It is too short to be measured.
pub fn measures(recording: &Recording) -> Result<Measures, RunError> {
    let inputs = |value: fn(&Input) -> [f64; 3]| recording.inputs.iter().map(value).collect::<Vec<_>>();
    let outputs = |value: fn(&Output) -> [f64; 3]| recording.outputs.iter().map(value).collect::<Vec<_>>();
    let limited = |output: &Output| Limited {
        tilt: output.tilt_limited,
        safety: output.safety_active,
        actuator: output.actuator_limited,
    };
    let rig = &recording.parameters.rig;
    Measures::of(&Run {
        step: recording.step,
        desired_force: &inputs(|input| input.specific_force.into()),
        felt_force: &outputs(|output| output.felt_specific_force.into()),
        desired_rate: &recording.desired_rates().into_iter().map(Into::into).collect::<Vec<_>>(),
        felt_rate: &outputs(|output| output.felt_angular_velocity.into()),
        platform: Platform {
            legs: &recording.outputs.iter().map(|output| output.length).collect::<Vec<_>>(),
            stroke: [rig.min_length, rig.max_length],
            displacement: &recording.displacements().into_iter().map(Into::into).collect::<Vec<_>>(),
            tilt_rate: &recording.outputs.iter().map(|o| [o.tilt_roll_rate, o.tilt_pitch_rate]).collect::<Vec<_>>(),
            limited: &recording.outputs.iter().map(limited).collect::<Vec<_>>(),
        },
    })
}
