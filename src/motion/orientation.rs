//! Orientation as roll, pitch, yaw: eq. (2) for the rotation, eq. (10) for the rates.

use moris_interface::{Field, Kind, units};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::motion::Motion;

/// Roll about x, pitch about y (nose down is positive), yaw about z, or three
/// quantities that belong to them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RollPitchYaw {
    pub roll: f64,
    pub pitch: f64,
    pub yaw: f64,
}

impl RollPitchYaw {
    pub const fn new(roll: f64, pitch: f64, yaw: f64) -> Self {
        RollPitchYaw { roll, pitch, yaw }
    }

    /// The three as a vector: roll, pitch, yaw.
    pub fn to_vector(self) -> Vector3<f64> {
        Vector3::new(self.roll, self.pitch, self.yaw)
    }

    /// The inverse of [`RollPitchYaw::to_vector`].
    pub fn from_vector(vector: Vector3<f64>) -> Self {
        RollPitchYaw::new(vector.x, vector.y, vector.z)
    }
}

impl Field for RollPitchYaw {
    const COMPONENTS: &'static [&'static str] = &["roll", "pitch", "yaw"];
    const KIND: Kind = Kind::Real(&units::ONE);
    fn read(slots: &[f64]) -> Self {
        RollPitchYaw::new(slots[0], slots[1], slots[2])
    }
    fn write(self, slots: &mut [f64]) {
        slots.copy_from_slice(self.to_vector().as_slice());
    }
}

/// An orientation with the sines and cosines that its rotation and its rates need, computed once.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Orientation {
    pub angles: RollPitchYaw,
    /// R from the oriented frame to the reference frame, eq. (2).
    pub rotation: Matrix3<f64>,
    sin_pitch: f64,
    cos_pitch: f64,
    sin_yaw: f64,
    cos_yaw: f64,
}

impl Orientation {
    /// R = Rz(yaw) Ry(pitch) Rx(roll), eq. (2).
    pub fn new(angles: RollPitchYaw) -> Self {
        let (sr, cr) = libm::sincos(angles.roll);
        let (sp, cp) = libm::sincos(angles.pitch);
        let (sy, cy) = libm::sincos(angles.yaw);
        #[rustfmt::skip]
        let rotation = Matrix3::new(
            cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,
            sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,
            -sp,     cp * sr,                cp * cr,
        );
        Orientation { angles, rotation, sin_pitch: sp, cos_pitch: cp, sin_yaw: sy, cos_yaw: cy }
    }

    /// Angular velocity in the reference frame from the angles' rates, eq. (10): omega = E (roll,
    /// pitch, yaw)'. E's columns are the axes about which the three angles turn. The product is
    /// computed in axes that turn with the heading.
    pub fn angular_velocity(&self, rates: RollPitchYaw) -> Vector3<f64> {
        self.out_of_heading(Vector3::new(
            self.cos_pitch * rates.roll,
            rates.pitch,
            rates.yaw - self.sin_pitch * rates.roll,
        ))
    }

    /// Angular acceleration in the reference frame: the time derivative of eq. (10).
    ///
    /// The acceleration is computed in axes that turn with the heading, as the sum of two parts.
    /// One is the derivative of the components of [`Orientation::angular_velocity`] there, the
    /// other the effect of the heading's rate.
    pub fn angular_acceleration(&self, rates: RollPitchYaw, accelerations: RollPitchYaw) -> Vector3<f64> {
        let (sin, cos) = (self.sin_pitch, self.cos_pitch);
        self.out_of_heading(Vector3::new(
            cos * accelerations.roll - rates.pitch * (sin * rates.roll + rates.yaw),
            accelerations.pitch + rates.yaw * cos * rates.roll,
            accelerations.yaw - sin * accelerations.roll - cos * rates.pitch * rates.roll,
        ))
    }

    /// A vector in axes that share only the yaw, in the reference frame.
    fn out_of_heading(&self, v: Vector3<f64>) -> Vector3<f64> {
        Vector3::new(self.cos_yaw * v.x - self.sin_yaw * v.y, self.sin_yaw * v.x + self.cos_yaw * v.y, v.z)
    }

    /// The angles' rates from an angular velocity in the reference frame: the inverse of eq. (10).
    ///
    /// Eq. (10) is singular at a pitch of 90 degrees; short of it the cosine is
    /// kept `away_from_zero`.
    pub fn rates(&self, angular_velocity: Vector3<f64>) -> RollPitchYaw {
        let pitch = (self.sin_pitch, away_from_zero(self.cos_pitch));
        rates_from_reference(angular_velocity, (self.sin_yaw, self.cos_yaw), pitch)
    }

    /// The angles' changes by a small rotation in the reference frame: the inverse of eq. (10) as
    /// it is, without a bound near a pitch of 90 degrees.
    pub fn changes(&self, rotation: Vector3<f64>) -> RollPitchYaw {
        rates_from_reference(rotation, (self.sin_yaw, self.cos_yaw), (self.sin_pitch, self.cos_pitch))
    }
}

/// An orientation that changes, with its angular velocity and acceleration in the reference frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotationalMotion {
    pub orientation: Orientation,
    pub velocity: Vector3<f64>,
    pub acceleration: Vector3<f64>,
}

impl RotationalMotion {
    /// From roll, pitch and yaw as they move.
    pub fn new(angles: &Motion<Vector3<f64>>) -> Self {
        RotationalMotion::with_orientation(Orientation::new(RollPitchYaw::from_vector(angles.position)), angles)
    }

    /// As [`RotationalMotion::new`], where the orientation at these angles is known.
    #[inline(always)]
    pub fn with_orientation(orientation: Orientation, angles: &Motion<Vector3<f64>>) -> Self {
        let rates = RollPitchYaw::from_vector(angles.velocity);
        let accelerations = RollPitchYaw::from_vector(angles.acceleration);
        RotationalMotion {
            orientation,
            velocity: orientation.angular_velocity(rates),
            acceleration: orientation.angular_acceleration(rates, accelerations),
        }
    }
}

/// The inverse of eq. (10), from sine and cosine of yaw and of pitch. The function divides by the
/// cosine of pitch: see `away_from_zero`.
pub fn rates_from_reference(
    omega: Vector3<f64>,
    (sin_yaw, cos_yaw): (f64, f64),
    (sin_pitch, cos_pitch): (f64, f64),
) -> RollPitchYaw {
    let roll = (cos_yaw * omega.x + sin_yaw * omega.y) / cos_pitch;
    RollPitchYaw::new(roll, cos_yaw * omega.y - sin_yaw * omega.x, omega.z + sin_pitch * roll)
}

/// The cosine of a pitch as a divisor, with a magnitude of at least 0.1. The inverse of eq. (10) is
/// singular at 90 degrees; so bounded, the rates stay finite beyond a pitch of 84 degrees.
fn away_from_zero(cos_pitch: f64) -> f64 {
    const SMALLEST: f64 = 0.1;
    cos_pitch.abs().max(SMALLEST).copysign(cos_pitch)
}
