//! The limits of a run, out of its parameters.

use moris_washout::Parameters;
use serde::Serialize;

/// The limits that the run was made under. The legs' stroke is the rig's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Limits {
    /// Limit of the tilt's angle \[rad\].
    pub tilt_angle: f64,
    /// Limit of the tilt's rate \[rad/s\].
    pub tilt_rate: f64,
    /// Limit of the tilt's acceleration \[rad/s2\].
    pub tilt_acceleration: f64,
    /// Limits of the safety units about neutral, along x, y and z \[m\].
    pub safety_position: [f64; 3],
    /// Velocity limits of the safety units along x, y and z \[m/s\].
    pub safety_velocity: [f64; 3],
    /// Acceleration limits of the safety units along x, y and z \[m/s2\].
    pub safety_acceleration: [f64; 3],
    /// Speed limit of the legs \[m/s\].
    pub actuator_velocity: f64,
    /// Acceleration limit of the legs \[m/s2\].
    pub actuator_acceleration: f64,
}

impl From<&Parameters> for Limits {
    fn from(parameters: &Parameters) -> Self {
        let Parameters { tilt, safety, rig, .. } = parameters;
        Limits {
            tilt_angle: tilt.angle_limit,
            tilt_rate: tilt.rate_limit,
            tilt_acceleration: tilt.acceleration_limit,
            safety_position: safety.position_limit.into(),
            safety_velocity: safety.velocity_limit.into(),
            safety_acceleration: safety.acceleration_limit.into(),
            actuator_velocity: rig.velocity_limit,
            actuator_acceleration: rig.acceleration_limit,
        }
    }
}
