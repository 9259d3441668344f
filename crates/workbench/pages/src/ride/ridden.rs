//! The motorcycle on the course, whose rider obeys the player.

use moris_interface::{Model, ParameterError};
use moris_motorcycle::{Course, Input as Controls, Motorcycle, Parameters};
use moris_washout::Input;
use moris_washout::interface::AngularVelocityFrame;
use serde::{Deserialize, Serialize};

use crate::ride::course::{Circuit, PlanePose, RoadMap, RoadPlace};
use crate::ride::rider;
use crate::ride::stepping::{HALF_WIDTH, STEP};

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
pub struct Ridden {
    motorcycle: Motorcycle,
    course: Circuit,
    place: PlanePose,
    /// True once the motorcycle has fallen or left the road.
    has_ended: bool,
}

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
        Self::with(*self.motorcycle.parameters())
    }

    fn with(mut parameters: Parameters) -> Result<Self, ParameterError> {
        parameters.path.course = Course::Lap;
        parameters.path.half_width = HALF_WIDTH;
        parameters.run.angular_velocity_frame = AngularVelocityFrame::Body;
        let motorcycle = Motorcycle::new(&parameters, &Controls::default())?.commanded();
        let course = course_of(&motorcycle);
        Ok(Ridden { motorcycle, course, place: PlanePose::default(), has_ended: false })
    }

    /// Advances by [`STEP`].
    pub fn step(&mut self, command: &RiderCommand) {
        // Speed above which a motorcycle off the road turns [m/s].
        const MIN_TURNING_SPEED: f64 = 0.05;
        let RiderCommand { throttle, brake, stick, is_helped } = *command;
        let lean = rider::lean(stick, is_helped, &self.motorcycle);
        let [throttle, brake] = rider::pedals([throttle, brake], is_helped && !self.has_ended(), &self.motorcycle);
        self.motorcycle.step(&Controls { throttle, brake, lean, ..Controls::default() }, STEP);
        let now = self.motorcycle.output();
        self.has_ended |= now.fallen || now.off_path;
        self.place = if self.has_ended {
            // Off the path the model counts no distance along it.
            let turned = if now.speed > MIN_TURNING_SPEED { now.angular_velocity.z * STEP } else { 0.0 };
            self.place.moved(now.speed * STEP, now.lateral_velocity * STEP, turned)
        } else {
            self.course.at(now.path_distance, now.path_deviation, now.path_heading)
        };
    }

    /// Sets the friction of the road.
    ///
    /// # Errors
    /// The friction is out of range.
    pub fn set_friction(&mut self, friction: f64) -> Result<(), ParameterError> {
        let mut parameters = *self.motorcycle.parameters();
        parameters.tyres.friction = friction;
        self.motorcycle.retune(&parameters)?;
        // The speed that a rider plans depends on it.
        self.course = course_of(&self.motorcycle);
        Ok(())
    }

    /// The motorcycle.
    pub fn motorcycle(&self) -> &Motorcycle {
        &self.motorcycle
    }

    /// The road in the plane.
    pub fn course(&self) -> &Circuit {
        &self.course
    }

    /// Place of the motorcycle in the plane.
    pub fn place(&self) -> PlanePose {
        self.place
    }

    /// The road, for drawing.
    pub fn road(&self) -> RoadMap {
        self.course.map(HALF_WIDTH)
    }

    /// Place of the motorcycle on the road, for drawing.
    pub fn road_place(&self) -> RoadPlace {
        let now = self.motorcycle.output();
        let PlanePose { x, y, yaw } = self.place;
        RoadPlace { x, y, yaw, distance: now.path_distance, steer: now.steer_angle, advised: now.planned_speed }
    }

    /// True once the motorcycle has fallen or left the road: what it does then is no cue.
    pub fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// The washout's input.
    pub fn input(&self, engaged: bool) -> Input {
        let now = self.motorcycle.output();
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

fn course_of(motorcycle: &Motorcycle) -> Circuit {
    let Some(follower) = motorcycle.follower() else { unreachable!("the course is a path") };
    Circuit::new(follower)
}
