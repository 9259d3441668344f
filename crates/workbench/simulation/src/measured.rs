//! The measures of a simulation.

use crate::measures::{Limits, Measures, Platform, References, Run};
use moris_washout::Output;
use moris_washout::platform::Pose;

use crate::{Refusal, Simulation};

/// Measures a simulation.
///
/// # Errors
/// The simulation is too short to be measured.
pub fn measures(simulation: &Simulation) -> Result<Measures, Refusal> {
    measures_with(simulation, None)
}

/// As [`measures`], with references where it is one of several simulations of a recording.
///
/// # Errors
/// As [`measures`].
pub fn measures_with(simulation: &Simulation, references: Option<&mut References>) -> Result<Measures, Refusal> {
    let tilt_limits = simulation.tilt_limits();
    let limited = |(sample, output): (usize, &Output)| Limits {
        tilt: tilt_limits.iter().flatten().any(|flags| flags[sample]),
        soft: output.soft_limited,
        safety: output.safety_active,
        actuator: output.actuator_limited,
    };
    let Simulation { inputs, outputs, parameters, felt_within_steps, step, .. } = simulation;
    let (rig, scale) = (&parameters.rig, &parameters.conditioning.force_scale);
    let neutral = Pose::neutral(rig).position;
    let count = outputs.len();
    let run = Run {
        step: *step,
        desired_force: &(inputs.len(), |k: usize| inputs[k].specific_force.into()),
        felt_force: &(count, |k: usize| outputs[k].felt_specific_force.into()),
        felt_force_within_steps: &(felt_within_steps.len(), |k: usize| felt_within_steps[k].into()),
        desired_rate: &(inputs.len(), |k| simulation.desired_rate(k).into()),
        scale: [scale.x, scale.y],
        felt_rate: &(count, |k: usize| outputs[k].felt_angular_velocity.into()),
        platform: Platform {
            legs: &(count, |k: usize| outputs[k].actuators(rig)[0]),
            stroke: rig.stroke(),
            displacement: &(count, |k: usize| (outputs[k].position - neutral).into()),
            tilt_rate: &(count, |k: usize| [outputs[k].tilt_roll_rate, outputs[k].tilt_pitch_rate]),
            limited: &outputs.iter().enumerate().map(limited).collect::<Vec<_>>(),
        },
    };
    Measures::with(&run, references)
}
