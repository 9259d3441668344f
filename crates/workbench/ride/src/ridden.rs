//! The motorcycle on the course, whose rider obeys the player.

use moris_interface::{Model, ParameterError};
use moris_motorcycle::{Course, Input as Controls, Motorcycle, Parameters};
use moris_washout::Input;
use moris_washout::interface::AngularVelocityFrame;
use serde::{Deserialize, Serialize};

use crate::ride::{HALF_WIDTH, STEP};
use crate::rider;

/// The player's commands to the rider.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RiderCommand {
    /// From 0 to 1.
    pub throttle: f64,
    pub brake: f64,
    /// From -1, left, to 1, right: the lean that the rider aims at.
    pub stick: f64,
    /// True if the rider keeps to the road, and to the advised speed at most.
    pub is_helped: bool,
}

/// A motorcycle on the lap.
#[derive(Clone, Debug)]
pub struct Ridden(Motorcycle);

impl Ridden {
    /// At rest at the beginning of the lap.
    ///
    /// # Errors
    /// Never, because the default parameters can be used.
    pub fn new() -> Result<Self, ParameterError> {
        Self::with(Parameters::default())
    }

    /// The same motorcycle at rest at the beginning of the lap.
    ///
    /// # Errors
    /// Never, because its parameters are in use.
    pub fn restarted(&self) -> Result<Self, ParameterError> {
        Self::with(*self.0.parameters())
    }

    fn with(mut parameters: Parameters) -> Result<Self, ParameterError> {
        parameters.path.course = Course::Lap;
        parameters.path.half_width = HALF_WIDTH;
        parameters.run.angular_velocity_frame = AngularVelocityFrame::Body;
        Ok(Ridden(Motorcycle::new(&parameters, &Controls::default())?.commanded()))
    }

    /// Advances by [`STEP`].
    pub fn step(&mut self, command: &RiderCommand) {
        let RiderCommand { throttle, brake, stick, is_helped } = *command;
        let lean = rider::lean(stick, is_helped, &self.0);
        let [throttle, brake] = rider::pedals([throttle, brake], is_helped && !self.has_ended(), &self.0);
        self.0.step(&Controls { throttle, brake, lean, ..Controls::default() }, STEP);
    }

    /// Sets the friction of the road.
    ///
    /// # Errors
    /// It is out of range.
    pub fn set_friction(&mut self, friction: f64) -> Result<(), ParameterError> {
        let mut parameters = *self.0.parameters();
        parameters.tyres.friction = friction;
        self.0.retune(&parameters)
    }

    /// The motorcycle.
    pub fn motorcycle(&self) -> &Motorcycle {
        &self.0
    }

    /// True once the motorcycle has fallen or left the road: what it does then is no cue.
    pub fn has_ended(&self) -> bool {
        let now = self.0.output();
        now.fallen || now.off_path
    }

    /// The washout's input.
    pub fn input(&self, engaged: bool) -> Input {
        let now = self.0.output();
        Input {
            specific_force: now.specific_force,
            angular_velocity: now.angular_velocity,
            orientation: now.orientation,
            speed: now.speed,
            lean: now.lean,
            engaged,
        }
    }
}
