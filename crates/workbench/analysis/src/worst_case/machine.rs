//! The platform's real motion under the washout's commands, and what its rider feels.

use moris_stewart_platform::{Input, Model, Output, ParameterError, Parameters, StewartPlatform};
use moris_washout::cueing::evaluator::felt;
use moris_washout::motion::orientation::Orientation;
use moris_washout::nalgebra::Vector3;
use moris_washout::platform::{LocationFrame, PlatformMotion};

use super::commands::Commands;

/// Response of a machine to the commands.
#[derive(Clone, Debug, PartialEq)]
pub struct RealMotion {
    /// Specific force that the rider feels, at each command \[m/s2\].
    pub felt: Vec<Vector3<f64>>,
    /// True if a drive was limited by its force, or a leg was at a stop.
    pub force_limited: bool,
    /// True if a drive was limited by speed or acceleration, or braked ahead of an end.
    pub drive_limited: bool,
}

/// Moves a platform by the commands, from rest at neutral. Rig, gravity and the point at which the
/// rider feels are the washout's.
///
/// # Errors
/// The parameters cannot be used.
pub fn real_motion(commands: &Commands, platform: &Parameters) -> Result<RealMotion, ParameterError> {
    let mut parameters = Parameters { rig: commands.rig, ..*platform };
    parameters.setting.gravity = commands.structure.gravity;
    // Without active limits the step is exact, however long.
    parameters.setting.max_step = commands.step.min(0.01);
    let input = |length: &[f64; 6]| Input { length: *length, ..Input::default() };
    let mut platform = StewartPlatform::new(&parameters, &Input::default())?;
    let mut real = RealMotion { felt: Vec::new(), force_limited: false, drive_limited: false };
    real.felt.push(felt_on(&platform.output(), commands, 0));
    for (k, pair) in commands.lengths.windows(2).enumerate() {
        platform.step_between(&input(&pair[0]), &input(&pair[1]), commands.step);
        let output = platform.output();
        real.force_limited |= output.force_limited || output.at_stop;
        real.drive_limited |= output.drive_limited;
        real.felt.push(felt_on(&output, commands, k + 1));
    }
    Ok(real)
}

/// Specific force at the washout's location on the real motion.
fn felt_on(output: &Output, commands: &Commands, k: usize) -> Vector3<f64> {
    let motion = PlatformMotion {
        position: output.position,
        orientation: Orientation::new(output.orientation),
        velocity: output.velocity,
        angular_velocity: output.angular_velocity,
        acceleration: output.acceleration,
        angular_acceleration: output.angular_acceleration,
    };
    let location = LocationFrame::new(&commands.structure, commands.leans[k]);
    felt(&motion, &location, commands.structure.gravity).specific_force
}
