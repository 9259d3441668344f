//! The nominal platform with its drives, under the washout's commands.

use moris_simulation::frequency_response::channel::CHANNEL_COUNT;
use moris_stewart_platform::{Input, Model, Parameters, StewartPlatform};
use moris_washout::cueing::evaluator::felt;
use moris_washout::motion::orientation::Orientation;
use moris_washout::platform::{LocationFrame, PlatformMotion};
use moris_washout::{Output, ParameterError};

/// The platform of the washout's rig, with the start values of its drives and masses.
#[derive(Clone)]
pub struct NominalPlatform {
    platform: StewartPlatform,
    location: LocationFrame,
    gravity: f64,
    /// The commands at the step's start; none before the first.
    last: Option<Input>,
}

impl NominalPlatform {
    /// The platform at rest at neutral.
    ///
    /// # Errors
    /// A parameter cannot be used; the message names it and the reason.
    pub fn new(washout: &moris_washout::Parameters) -> Result<Self, ParameterError> {
        let gravity = washout.structure.gravity;
        let mut parameters = Parameters { rig: washout.rig, ..Parameters::default() };
        parameters.setting.gravity = gravity;
        let platform = StewartPlatform::new(&parameters, &Input::default())?;
        Ok(NominalPlatform { platform, location: LocationFrame::new(&washout.structure, 0.0), gravity, last: None })
    }

    /// Moves to the commands at the end of a step \[s\]. Returns what is felt there, in the order
    /// of the channels.
    pub fn felt(&mut self, commanded: &Output, step: f64) -> [f64; CHANNEL_COUNT] {
        let input = Input { length: commanded.length, angle: commanded.angle, ..Input::default() };
        let start = self.last.replace(input).unwrap_or(input);
        self.platform.step_between(&start, &input, step);
        let output = self.platform.output();
        let motion = PlatformMotion {
            position: output.position,
            orientation: Orientation::new(output.orientation),
            velocity: output.velocity,
            angular_velocity: output.angular_velocity,
            acceleration: output.acceleration,
            angular_acceleration: output.angular_acceleration,
        };
        let felt = felt(&motion, &self.location, self.gravity);
        let (force, rate) = (felt.specific_force, felt.angular_velocity);
        [force.x, force.y, force.z, rate.x, rate.y, rate.z]
    }
}
