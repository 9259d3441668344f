//! The measures of a simulation.

use crate::measures::{Limits, Measures, Platform, References, Run, RunError};
use moris_washout::{Input, Output};

use crate::Simulation;

/// Measures a simulation.
///
/// # Errors
/// It is too short to be measured.
pub fn measures(simulation: &Simulation) -> Result<Measures, RunError> {
    measures_with(simulation, &mut References::default())
}

/// As [`measures`] for one of several simulations of a recording.
///
/// # Errors
/// As [`measures`].
pub fn measures_with(simulation: &Simulation, references: &mut References) -> Result<Measures, RunError> {
    let inputs = |value: fn(&Input) -> [f64; 3]| simulation.inputs.iter().map(value).collect::<Vec<_>>();
    let outputs = |value: fn(&Output) -> [f64; 3]| simulation.outputs.iter().map(value).collect::<Vec<_>>();
    let tilt_limits = simulation.tilt_limits();
    let limited = |(sample, output): (usize, &Output)| Limits {
        tilt: tilt_limits.iter().flatten().any(|flags| flags[sample]),
        soft: output.soft_limited,
        safety: output.safety_active,
        actuator: output.actuator_limited,
    };
    let rig = &simulation.parameters.rig;
    let scale = &simulation.parameters.conditioning.force_scale;
    let run = Run {
        step: simulation.step,
        desired_force: &inputs(|input| input.specific_force.into()),
        felt_force: &outputs(|output| output.felt_specific_force.into()),
        felt_force_within_steps: &simulation.felt_within_steps.iter().map(|&felt| felt.into()).collect::<Vec<_>>(),
        desired_rate: &simulation.desired_rates().into_iter().map(Into::into).collect::<Vec<_>>(),
        scale: [scale.x, scale.y],
        felt_rate: &outputs(|output| output.felt_angular_velocity.into()),
        platform: Platform {
            legs: &simulation.outputs.iter().map(|output| output.length).collect::<Vec<_>>(),
            stroke: [rig.min_length, rig.max_length],
            displacement: &simulation.displacements().into_iter().map(Into::into).collect::<Vec<_>>(),
            tilt_rate: &simulation.outputs.iter().map(|o| [o.tilt_roll_rate, o.tilt_pitch_rate]).collect::<Vec<_>>(),
            limited: &simulation.outputs.iter().enumerate().map(limited).collect::<Vec<_>>(),
        },
    };
    Measures::with(&run, references)
}
