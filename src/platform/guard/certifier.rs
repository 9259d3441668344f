//! The rig as the certificate needs it: geometry, limits, and the legs at neutral.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::cranks::JointLimits;
use crate::interface::Rig;
use crate::motion::braking_law::Limits;
use crate::motion::min_max::{max, min};
use crate::platform::crank::Arms;
use crate::platform::{Geometry, PlatformCoordinates, PlatformState, Pose, leg_lengths};

/// The fraction of the legs' acceleration limit that stopping uses. The rest is for the
/// accelerations that the legs' rotation causes.
pub(super) const STOP_FRACTION: f64 = 0.6;
/// The margin of the way home at neutral, as a fraction of the legs' clearance there.
pub(super) const HOME_MARGIN_FRACTION: f64 = 1.0 / 16.0;

/// Certifies motion: the legs with their limits, and the way home.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Certifier {
    pub geometry: Geometry,
    pub neutral_height: f64,
    /// The farthest joint from the platform's origin \[m\].
    pub(super) radius: f64,
    /// A leg's limits. The lengths are those between which it may come to rest: inside the stroke
    /// by [`step_margin`].
    pub limits: Limits,
    /// Duration of a stop for each m/s of a leg \[s2/m\].
    pub(super) stop_time_per_speed: f64,
    /// Requirements of the straight path to neutral.
    pub(super) home: Home,
}

/// Speed of the platform's origin \[m/s\] and the sum of the angles' rates' magnitudes \[rad/s\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Speed {
    pub(super) linear: f64,
    pub(super) angular: f64,
}

impl Speed {
    #[inline(always)]
    pub fn of(coordinates: &PlatformCoordinates) -> Self {
        Speed { linear: coordinates.linear.velocity.norm(), angular: sum_of_magnitudes(&coordinates.angles.velocity) }
    }

    /// A bound on the speed of any joint.
    #[inline(always)]
    pub(super) fn of_joints(self, radius: f64) -> f64 {
        self.linear + self.angular * radius
    }
}

/// The legs at neutral, for the way home.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Home {
    pub(super) length: [f64; 6],
    pub(super) longest: f64,
    /// The least and the greatest distance of a platform joint from its base joint \[m\].
    pub(super) joints: [f64; 2],
    /// The smallest transmission of the cranks; 1 with legs.
    pub(super) transmission: f64,
    /// The margins at neutral from the shortest and the longest length \[m\].
    pub(super) margin: [f64; 2],
    /// Least distance of the legs beyond their margins at neutral \[m\].
    pub(super) beyond_margin: [f64; 2],
    /// 1/(2 times the shortest length) \[1/m\].
    pub(super) per_two_lengths: f64,
    /// Of cranks: the arms at neutral, cosine and sine of the lowest and of the highest angle, and
    /// the margins at neutral of the joints from arms there ([`Arms::clear_of`]) \[m2\].
    pub(super) arms: Option<Arms>,
    pub(super) ends: [[f64; 2]; 2],
    pub(super) joints_margin: [f64; 2],
}

impl Home {
    /// For actuators with these joints and limits.
    pub fn new(geometry: &Geometry, neutral: &Pose, limits: &Limits) -> Self {
        let extremes = |values: &[f64; 6]| {
            let least = values.iter().fold(f64::INFINITY, |least, &value| min(value, least));
            [least, values.iter().fold(f64::NEG_INFINITY, |most, &value| max(value, most))]
        };
        let length = leg_lengths(geometry, neutral);
        let [shortest, longest] = extremes(&length);
        let clearance = [shortest - limits.min, limits.max - longest];
        let arms = geometry.cranks.as_ref().map(|cranks| cranks.arms_in(geometry, neutral));
        let ends = geometry.cranks.as_ref().map_or([[0.0; 2]; 2], |cranks| {
            [limits.min, limits.max].map(|arc| libm::sincos(arc / cranks.arm)).map(|(sin, cos)| [cos, sin])
        });
        let joints_margin = arms.as_ref().map_or([0.0; 2], |arms| {
            [0, 1].map(|end: usize| {
                let least = (0..6).fold(f64::INFINITY, |least, i| min(arms.clear_of(i, &ends)[end], least));
                HOME_MARGIN_FRACTION * least
            })
        });
        Home {
            length,
            longest,
            joints: extremes(&leg_lengths(&geometry.with_legs(), neutral)),
            transmission: arms.as_ref().map_or(1.0, Arms::least_transmission),
            margin: clearance.map(|clearance| HOME_MARGIN_FRACTION * clearance),
            beyond_margin: clearance.map(|clearance| (1.0 - HOME_MARGIN_FRACTION) * clearance),
            per_two_lengths: 0.5 / limits.min,
            arms,
            ends,
            joints_margin,
        }
    }
}

/// The margin of a stroke at either end for what happens between the ends of a step \[m\].
///
/// The margin is what a leg can move beyond both ends of a transition: A h²/8 for the longest step
/// h, or V h/2 if that is less. A and V are the leg's limits of acceleration and velocity.
pub fn step_margin(rig: &Rig, max_step: f64) -> f64 {
    (0.125 * rig.acceleration_limit * max_step * max_step).min(0.5 * rig.velocity_limit * max_step)
}

impl Certifier {
    /// Certifies the motion of a rig; no step will be longer than `max_step` \[s\].
    pub fn new(rig: &Rig, max_step: f64) -> Self {
        let margin = step_margin(rig, max_step);
        let geometry = Geometry::from(rig);
        let [start, end] = rig.stroke();
        let limits = Limits {
            min: start + margin,
            max: end - margin,
            velocity: rig.velocity_limit,
            acceleration: rig.acceleration_limit,
            max_step,
        };
        Certifier {
            home: Home::new(&geometry, &Pose::neutral(rig), &limits),
            geometry,
            neutral_height: rig.neutral_height,
            radius: rig.platform.iter().fold(0.0, |radius, joint| joint.norm().max(radius)),
            limits,
            stop_time_per_speed: 1.0 / (STOP_FRACTION * rig.acceleration_limit),
        }
    }

    /// The legs' limits as limits of the joints.
    #[inline(always)]
    pub(super) fn joint_limits_of_legs(&self) -> JointLimits {
        JointLimits {
            transmission: 1.0,
            turning_length: self.limits.min,
            velocity: self.limits.velocity,
            acceleration: self.limits.acceleration,
            stop_time_per_speed: self.stop_time_per_speed,
            travel: f64::INFINITY,
        }
    }

    /// The actuators' limits as limits of the joints about these coordinates; `transmission` is
    /// the smallest one there.
    pub(super) fn joint_limits(&self, transmission: f64) -> JointLimits {
        match &self.geometry.cranks {
            None => self.joint_limits_of_legs(),
            Some(cranks) => self.joint_limits_of_cranks(cranks, transmission),
        }
    }

    /// The smallest transmission of the cranks in these coordinates; 1 with legs.
    pub(super) fn transmission_at(&self, coordinates: &PlatformCoordinates) -> f64 {
        let pose = || coordinates.motion(self.neutral_height).pose();
        self.geometry.cranks.as_ref().map_or(1.0, |cranks| cranks.transmission(&self.geometry, &pose()))
    }

    /// The state with these coordinates.
    pub fn state(&self, coordinates: PlatformCoordinates) -> PlatformState {
        PlatformState::new(coordinates, &self.geometry, self.neutral_height)
    }

    /// The limits within which each leg pursues a demand: a little inside the certified stroke. A
    /// leg at the end of the stroke is then drawn back and does not keep the others from moving.
    pub fn pursuit_limits(&self) -> Limits {
        const PURSUIT_MARGIN_FRACTION: f64 = 1e-5;
        let margin = PURSUIT_MARGIN_FRACTION * (self.limits.max - self.limits.min);
        Limits { min: self.limits.min + margin, max: self.limits.max - margin, ..self.limits }
    }
}

#[inline(always)]
pub(super) fn sum_of_magnitudes(vector: &Vector3<f64>) -> f64 {
    vector.x.abs() + vector.y.abs() + vector.z.abs()
}
