//! How the platform comes to rest: the plan that has to fit before a motion is allowed.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::{Coordinates, Geometry, Legs, inverse_kinematics, leg_accelerations};
use crate::interface::SafetyParameters;
use crate::motion::Motions;
use crate::motion::braking_law::Limits;
use crate::motion::extremes::larger;

/// The decelerations of the coordinates on the way to rest, none of them negative: of surge, sway and heave \[m/s2\] and
/// of roll, pitch and yaw \[rad/s2\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Braking {
    linear: Vector3<f64>,
    angles: Vector3<f64>,
}

/// The share of the legs' acceleration that braking takes; the rest is for what the legs do because the platform turns.
pub const LEG_SHARE: f64 = 0.6;
/// What a leg may accelerate while braking, short of its limit because braking is looked at from point to point.
pub const ACCELERATION_SHARE: f64 = 0.98;
/// At so many points after the first the legs are looked at, evenly on the way to rest.
const POINTS: usize = 8;

/// The time in which all coordinates brake that need not do it sooner \[s\].
pub fn braking_time(velocity: &Vector3<f64>, fastest_leg: f64, legs: &Limits, safety: &SafetyParameters) -> f64 {
    let legs_need = fastest_leg / (LEG_SHARE * legs.acceleration);
    (0..3).fold(legs_need, |time, k| larger(velocity[k].abs() / safety.acceleration_limit[k], time))
}

impl Braking {
    /// The plan from here: every coordinate in about the same time, so that the platform stays on its path, in a time that
    /// the fastest leg \[m/s\] and the safety limits on the accelerations allow; a coordinate near its safety limit stops
    /// before that.
    pub fn from(coordinates: &Coordinates, fastest_leg: f64, legs: &Limits, safety: &SafetyParameters) -> Self {
        let Motions { position, velocity, .. } = coordinates.linear;
        let time = braking_time(&velocity, fastest_leg, legs, safety).max(f64::MIN_POSITIVE);
        let linear = Vector3::from_fn(|k, _| {
            let room = safety.position_limit[k] - position[k] * 1.0_f64.copysign(velocity[k]);
            let needed = 0.5 * velocity[k] * velocity[k] / room.max(f64::MIN_POSITIVE);
            (velocity[k].abs() / time).max(needed).min(safety.acceleration_limit[k])
        });
        Braking { linear, angles: coordinates.angles.velocity.abs() / time }
    }

    /// Where the coordinates are after braking for `time` seconds.
    pub fn after(&self, coordinates: &Coordinates, time: f64) -> Coordinates {
        Coordinates {
            linear: coordinates.linear.braked(&self.linear, time),
            angles: coordinates.angles.braked(&self.angles, time),
        }
    }

    /// Whether the legs keep their limits all the way to rest.
    ///
    /// They are looked at here and at [`POINTS`] more, evenly on the way, and where a coordinate comes to rest: what it
    /// did to the legs' accelerations ends there.
    pub fn keeps(&self, legs: &Limits, geometry: &Geometry, coordinates: &Coordinates, neutral_height: f64) -> bool {
        let stops = times(&coordinates.linear.velocity, &self.linear);
        let duration = stops.max().max(times(&coordinates.angles.velocity, &self.angles).max());
        let interval = duration / POINTS as f64;
        let within = |time: f64| {
            // The point itself is where the platform is or comes to rest; between two points a leg may be farther.
            let inside = 0.0 < time && time < duration;
            let beyond = if inside { 0.125 * legs.acceleration * interval * interval } else { 0.0 };
            let motion = self.after(coordinates, time).motion(neutral_height);
            let Legs { length, velocity } = inverse_kinematics(geometry, &motion);
            let accelerations = leg_accelerations(geometry, &motion);
            (0..6).all(|i| {
                // A leg that speeds up may do so until the next point.
                let faster = (accelerations[i] * velocity[i].signum()).max(0.0) * interval;
                length[i] - beyond >= legs.min
                    && length[i] + beyond <= legs.max
                    && velocity[i].abs() + faster <= legs.velocity
                    && accelerations[i].abs() <= ACCELERATION_SHARE * legs.acceleration
            })
        };
        (0..=POINTS).all(|point| within(point as f64 * interval)) && stops.iter().all(|&stop| within(stop))
    }
}

/// How long it takes until each is at rest \[s\].
fn times(velocities: &Vector3<f64>, decelerations: &Vector3<f64>) -> Vector3<f64> {
    velocities.zip_map(
        decelerations,
        |velocity, deceleration| {
            if velocity == 0.0 { 0.0 } else { velocity.abs() / deceleration }
        },
    )
}
