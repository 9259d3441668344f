//! Position of motorcycle and head in the world, and specific force at the head: exact for any
//! angles.
//!
//! The axes are those outside [`crate::lateral`]: x forward, y left, z up. Roll, pitch (nose down)
//! and yaw are those of R = Rz(yaw) Ry(pitch) Rx(roll). The motorcycle's plane rolls about the line
//! through the rear contact along the heading. In that plane the machine heaves, and pitches about
//! the point of the road under its centre of mass:
//!
//! p_head = p_contact + Rz(yaw) Rx(roll) (x_c, 0, heave) + R (head - (x_c, 0, 0)), and the head's
//! own axes are R Rx(torso's lean).

use moris_washout::motion::Motion;
use moris_washout::motion::orientation::{Orientation, RotationalMotion};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::interface::Parameters;
use crate::lateral::bicycle;

/// Positions of the pitch axis and the head.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Geometry {
    /// The point of the road under the centre of mass.
    pitch_axis: Vector3<f64>,
    centre_height: f64,
    head_x: f64,
    head_height: f64,
    torso_length: f64,
    gravity: f64,
}

/// Motion of all coordinates: angles in rad, positive as in the module's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moving {
    pub roll: Motion,
    pub pitch: Motion,
    pub yaw: Motion,
    pub heave: Motion,
    pub torso: Motion,
    /// Position, velocity and acceleration of the rear contact in the world.
    pub contact: Point,
}

/// A point's position, velocity and acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    pub position: Vector3<f64>,
    pub velocity: Vector3<f64>,
    pub acceleration: Vector3<f64>,
}

/// The head's motion in the world, and the specific force there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Head {
    pub point: Point,
    /// In the head's axes \[m/s2\].
    pub specific_force: Vector3<f64>,
    /// Orientation of the motorcycle, and its angular velocity in the world's axes \[rad/s\].
    pub orientation: Orientation,
    pub angular_velocity: Vector3<f64>,
}

impl Geometry {
    /// From the parameters.
    pub fn new(parameters: &Parameters) -> Self {
        let t = bicycle(&parameters.machine).totals();
        let rider = &parameters.rider;
        Geometry {
            pitch_axis: Vector3::new(t.x_t, 0.0, 0.0),
            centre_height: -t.z_t,
            head_x: rider.head_x,
            head_height: rider.head_height,
            torso_length: rider.torso_length,
            gravity: parameters.run.gravity,
        }
    }

    /// Height of the centre of mass at rest \[m\].
    pub fn centre_height(&self) -> f64 {
        self.centre_height
    }

    /// The head's motion: f^H = R_H' (p_head'' - g).
    pub fn head(&self, moving: &Moving) -> Head {
        let plane = turning_motion([moving.roll, Motion::at_rest(0.0), moving.yaw]);
        let chassis = turning_motion([moving.roll, moving.pitch, moving.yaw]);
        let heave = moving.heave;
        let axis = Point {
            position: self.pitch_axis + Vector3::z() * heave.position,
            velocity: Vector3::z() * heave.velocity,
            acceleration: Vector3::z() * heave.acceleration,
        };
        let point =
            moving.contact + carried_point(&plane, &axis) + carried_point(&chassis, &self.head_from_axis(moving.torso));
        let felt = point.acceleration + Vector3::z() * self.gravity;
        let in_chassis = chassis.orientation.rotation.transpose() * felt;
        let (sin, cos) = libm::sincos(moving.torso.position);
        let specific_force = Vector3::new(
            in_chassis.x,
            cos * in_chassis.y + sin * in_chassis.z,
            cos * in_chassis.z - sin * in_chassis.y,
        );
        Head { point, specific_force, orientation: chassis.orientation, angular_velocity: chassis.velocity }
    }

    /// The head relative to the pitch axis in the chassis, with the torso rotating about the seat:
    /// eq. (4) of the paper.
    fn head_from_axis(&self, torso: Motion) -> Point {
        let (sin, cos) = libm::sincos(torso.position);
        let along = Vector3::new(0.0, -sin, cos) * self.torso_length;
        let across = Vector3::new(0.0, -cos, -sin) * self.torso_length;
        let seat = Vector3::new(self.head_x, 0.0, self.head_height - self.torso_length);
        Point {
            position: seat + along - self.pitch_axis,
            velocity: across * torso.velocity,
            acceleration: across * torso.acceleration - along * (torso.velocity * torso.velocity),
        }
    }
}

/// Motion in the reference frame of a point that moves in a frame that rotates about the origin.
fn carried_point(frame: &RotationalMotion, point: &Point) -> Point {
    let rotation = frame.orientation.rotation;
    let (position, velocity) = (rotation * point.position, rotation * point.velocity);
    let (angular_velocity, angular_acceleration) = (frame.velocity, frame.acceleration);
    Point {
        position,
        velocity: velocity + angular_velocity.cross(&position),
        acceleration: rotation * point.acceleration
            + 2.0 * angular_velocity.cross(&velocity)
            + angular_acceleration.cross(&position)
            + angular_velocity.cross(&angular_velocity.cross(&position)),
    }
}

impl std::ops::Add for Point {
    type Output = Point;

    fn add(self, other: Point) -> Point {
        Point {
            position: self.position + other.position,
            velocity: self.velocity + other.velocity,
            acceleration: self.acceleration + other.acceleration,
        }
    }
}

/// Rotation by roll, pitch and yaw with these motions.
fn turning_motion(angles: [Motion; 3]) -> RotationalMotion {
    RotationalMotion::new(&Motion::from_axes(|k| angles[k]))
}
