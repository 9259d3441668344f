//! The Stewart platform: its geometry, and the way from pose to legs or cranks and back.
//!
//! ```
//! use moris_washout::Rig;
//! use moris_washout::motion::orientation::{Orientation, RollPitchYaw};
//! use moris_washout::nalgebra::Vector3;
//! use moris_washout::platform::{Geometry, Pose, forward_kinematics, leg_lengths};
//!
//! let rig = Rig::default();
//! let (geometry, neutral) = (Geometry::from(&rig), Pose::neutral(&rig));
//! // The platform is 0.1 m forward of neutral and pitched nose up by 0.2 rad.
//! let orientation = Orientation::new(RollPitchYaw { pitch: -0.2, ..RollPitchYaw::default() });
//! let pose = Pose { position: neutral.position + Vector3::new(0.1, 0.0, 0.0), orientation };
//! let lengths = leg_lengths(&geometry, &pose);
//!
//! let found = forward_kinematics(&geometry, &lengths, &neutral)?;
//! assert!((found.position - pose.position).norm() < 1e-9);
//! assert!((found.orientation.angles.pitch + 0.2).abs() < 1e-9);
//! # Ok::<(), moris_washout::platform::NotConverged>(())
//! ```

mod coordinates;
mod crank;
mod forward;
mod guard;
mod inverse;
mod jacobian;
mod joints;
#[cfg(feature = "std")]
mod known_surveys;
mod location;
pub mod numbering;
pub mod reach;
mod state;
mod stop_plan;
mod survey;

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

pub(crate) use coordinates::PlatformCoordinates;
pub use crank::Cranks;
pub use forward::{MAX_ITERATIONS, NotConverged, forward_kinematics, motion_of_legs};
pub(crate) use guard::{ActuatorGuard, step_margin};
pub(crate) use inverse::joint_distances;
pub use inverse::{Legs, inverse_kinematics, leg_accelerations, leg_lengths};
pub use jacobian::{Jacobian, jacobian};
pub(crate) use jacobian::{accelerations_with_jacobian, lengths_with_jacobian};
pub use joints::Joints;
#[cfg(feature = "std")]
pub(crate) use known_surveys::known_survey;
pub use location::{LocationFrame, check_torso};
pub(crate) use state::PlatformState;
#[cfg(not(feature = "std"))]
pub(crate) use survey::survey as known_survey;
pub use survey::{Survey, SurveyFailed, mean_radius, survey};

use crate::interface::Rig;
use crate::motion::Motion;
use crate::motion::orientation::{Orientation, RollPitchYaw, RotationalMotion};

/// Where the joints are: on the base in the base frame, on the platform in the
/// platform frame \[m\]. A joint of the base is the axle's where there are cranks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Geometry {
    pub base: Joints,
    pub platform: Joints,
    /// The cranks, if the actuators are cranks and not legs.
    pub cranks: Option<Cranks>,
}

impl Geometry {
    /// The same joints with legs between them: their lengths are the distances of the joints.
    pub fn with_legs(&self) -> Self {
        Geometry { cranks: None, ..*self }
    }

    /// In a pose, the rods of cranks as legs of a fixed length, with the ends of the arms as their
    /// base joints. Legs are what they are.
    pub fn rods(&self, pose: &Pose) -> Self {
        self.cranks.map_or(*self, |cranks| cranks.rods(self, &leg_lengths(self, pose)))
    }

    /// The smallest transmission of the cranks in a pose: the rod's direction along the circle of
    /// the arm's end, 1 at best. 0 where a rod does not reach, and 1 for legs.
    pub fn transmission(&self, pose: &Pose) -> f64 {
        self.cranks.as_ref().map_or(1.0, |cranks| cranks.transmission(self, pose))
    }

    /// The vector from the base's joint `i` to the platform's, in a pose \[m\].
    pub(crate) fn between(&self, i: usize, pose: &Pose) -> Vector3<f64> {
        pose.position + pose.orientation.rotation * self.platform.joint(i) - self.base.joint(i)
    }
}

impl From<&Rig> for Geometry {
    fn from(rig: &Rig) -> Self {
        Geometry { base: Joints::from(&rig.base), platform: Joints::from(&rig.platform), cranks: Cranks::of(rig) }
    }
}

/// Position of the platform frame's origin in the base frame \[m\], and the platform's orientation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    pub position: Vector3<f64>,
    pub orientation: Orientation,
}

impl Pose {
    /// The rig's neutral pose: level, at the neutral height.
    pub fn neutral(rig: &Rig) -> Self {
        let orientation = Orientation::new(RollPitchYaw::default());
        Pose { position: Vector3::new(0.0, 0.0, rig.neutral_height), orientation }
    }
}

/// Motion of the platform: pose and its first two derivatives, in the base frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlatformMotion {
    pub position: Vector3<f64>,
    pub orientation: Orientation,
    pub velocity: Vector3<f64>,
    pub angular_velocity: Vector3<f64>,
    pub acceleration: Vector3<f64>,
    pub angular_acceleration: Vector3<f64>,
}

impl PlatformMotion {
    /// From surge, sway and heave, and how the platform turns.
    pub fn new(linear: &Motion<Vector3<f64>>, turning: &RotationalMotion, neutral_height: f64) -> Self {
        PlatformMotion {
            position: Vector3::new(linear.position.x, linear.position.y, neutral_height + linear.position.z),
            orientation: turning.orientation,
            velocity: linear.velocity,
            angular_velocity: turning.velocity,
            acceleration: linear.acceleration,
            angular_acceleration: turning.acceleration,
        }
    }

    /// As `motion` is oriented, with the velocities and accelerations of these coordinates,
    /// which have its angles.
    pub(crate) fn turning(motion: &PlatformMotion, coordinates: &PlatformCoordinates) -> Self {
        let turning = RotationalMotion::with_orientation(motion.orientation, &coordinates.angles);
        PlatformMotion { position: motion.position, ..PlatformMotion::new(&coordinates.linear, &turning, 0.0) }
    }

    /// At rest in this pose.
    pub fn at_rest(pose: Pose) -> Self {
        PlatformMotion {
            position: pose.position,
            orientation: pose.orientation,
            velocity: Vector3::zeros(),
            angular_velocity: Vector3::zeros(),
            acceleration: Vector3::zeros(),
            angular_acceleration: Vector3::zeros(),
        }
    }

    /// The rotation `step` seconds later, if the platform goes on turning as it
    /// does: to second order.
    pub fn rotation_after(&self, step: f64) -> Matrix3<f64> {
        let turn = step * (self.angular_velocity + 0.5 * step * self.angular_acceleration);
        let cross = turn.cross_matrix();
        let second = 0.5 * turn * turn.transpose() - Matrix3::from_diagonal_element(0.5 * turn.norm_squared());
        self.orientation.rotation + (cross + second) * self.orientation.rotation
    }

    /// Acceleration of the platform's point at the end of an arm from its origin \[m/s2\].
    #[inline(always)]
    pub fn acceleration_at(&self, arm: Vector3<f64>) -> Vector3<f64> {
        let omega = self.angular_velocity;
        self.acceleration + self.angular_acceleration.cross(&arm) + omega.cross(&omega.cross(&arm))
    }

    /// The pose alone.
    pub fn pose(&self) -> Pose {
        Pose { position: self.position, orientation: self.orientation }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    /// With a constant axis the rotation is known; what the second order leaves is of the third.
    #[test]
    fn the_rotation_to_come_is_exact_to_second_order() {
        let orientation = Orientation::new(RollPitchYaw { roll: 0.3, pitch: -0.2, yaw: 0.5 });
        let pose = Pose { position: Vector3::zeros(), orientation };
        let axis = Vector3::new(0.6, -0.48, 0.64);
        let (rate, acceleration) = (2.0, 30.0);
        let motion = PlatformMotion {
            angular_velocity: rate * axis,
            angular_acceleration: acceleration * axis,
            ..PlatformMotion::at_rest(pose)
        };
        for step in [1e-3, 1e-2, 3e-2] {
            let angle: f64 = rate * step + 0.5 * acceleration * step * step;
            let exact = Rotation3::new(angle * axis).matrix() * orientation.rotation;
            let error = (motion.rotation_after(step) - exact).norm();
            assert!(error > 0.0 && error < 0.3 * angle.powi(3), "{error} after {step} s, {angle} rad");
        }
    }
}
