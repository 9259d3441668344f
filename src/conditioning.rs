//! Block (1), first half: gravity removal, scaling, limiting and low-pass of what the vehicle model delivers.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::interface::{AngularVelocityFrame, ConditioningParameters, GravityRemoval, Input};
use crate::orientation::{Orientation, RollPitchYaw};

/// What is left to cue: zero at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cue {
    /// Specific force without gravity, in head axes \[m/s2\].
    pub force: Vector3<f64>,
    /// Rates of roll, pitch and yaw \[rad/s\].
    pub rates: Vector3<f64>,
}

impl Cue {
    /// The cue times a factor.
    pub fn scaled(self, factor: f64) -> Self {
        Cue { force: self.force * factor, rates: self.rates * factor }
    }
}

/// Gravity removed, scaled and limited: the cue in the vehicle's motion at one instant.
///
/// `lean` is the lean of the head's frame relative to the vehicle's \[rad\], `gravity` the magnitude of gravity \[m/s2\].
pub fn cue(input: &Input, parameters: &ConditioningParameters, gravity: f64, lean: f64) -> Cue {
    let force = input.specific_force + removed_gravity(parameters.gravity_removal, input.orientation, gravity, lean);
    let rates = euler_rates(input, parameters.angular_velocity_frame);
    Cue {
        force: force.component_mul(&parameters.force_scale).zip_map(&parameters.force_limit, soft_limit),
        rates: rates.component_mul(&parameters.rate_scale).zip_map(&parameters.rate_limit, soft_limit),
    }
}

/// The gravity vector in head axes, R_D^H g with g = (0, 0, -g), or the part of it that is removed.
fn removed_gravity(removal: GravityRemoval, vehicle: RollPitchYaw, gravity: f64, lean: f64) -> Vector3<f64> {
    if removal == GravityRemoval::None {
        return Vector3::zeros();
    }
    let (sin_roll, cos_roll) = (vehicle.roll + lean).sin_cos();
    let (sin_pitch, cos_pitch) = vehicle.pitch.sin_cos();
    let in_head = gravity * Vector3::new(sin_pitch, -cos_pitch * sin_roll, -cos_pitch * cos_roll);
    match removal {
        GravityRemoval::Full => in_head,
        _ => Vector3::new(0.0, 0.0, in_head.z),
    }
}

/// Rates of the vehicle's roll, pitch and yaw: the inverse of eq. (10), for angular velocity in either frame.
fn euler_rates(input: &Input, frame: AngularVelocityFrame) -> Vector3<f64> {
    let vehicle = match frame {
        // Eq. (10) does not depend on roll.
        AngularVelocityFrame::World => Orientation::new(RollPitchYaw { roll: 0.0, ..input.orientation }),
        // Nor does its form in body axes depend on yaw: any heading does.
        AngularVelocityFrame::Body => Orientation::new(RollPitchYaw { yaw: 0.0, ..input.orientation }),
    };
    let in_world = match frame {
        AngularVelocityFrame::World => input.angular_velocity,
        AngularVelocityFrame::Body => vehicle.rotation * input.angular_velocity,
    };
    vehicle.rates(in_world).to_vector()
}

/// The share of a limit up to which [`soft_limit`] changes nothing.
const KNEE: f64 = 0.8;

/// A smooth limit: the value itself up to 80 % of the limit, then bent towards the limit without a corner.
pub fn soft_limit(value: f64, limit: f64) -> f64 {
    let knee = KNEE * limit;
    let room = limit - knee;
    let beyond = value.abs() - knee;
    if beyond <= 0.0 { value } else { (knee + room * (beyond / room).tanh()).copysign(value) }
}

/// The optional first-order low-pass on the cue.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct InputFilter {
    cue: Cue,
}

impl InputFilter {
    /// The filter's output now.
    pub fn cue(&self) -> Cue {
        self.cue
    }

    /// Advances by `step` seconds while the cue goes linearly from `start` to `end`. Returns the filtered cue at the
    /// step's start and end. A cutoff of 0 passes the cue on unchanged.
    pub fn advance(&mut self, start: Cue, end: Cue, cutoff: f64, step: f64) -> (Cue, Cue) {
        if cutoff == 0.0 {
            self.cue = end;
            return (start, end);
        }
        let before = self.cue;
        let decay = (-cutoff * step).exp();
        // The exact response of y' = cutoff (u - y) to a ramp: it lags by slope/cutoff, and the rest decays.
        let ramp = |y: Vector3<f64>, u0: Vector3<f64>, u1: Vector3<f64>| {
            let lag = (u1 - u0) / (cutoff * step);
            u1 - lag + (y - u0 + lag) * decay
        };
        self.cue = Cue {
            force: ramp(before.force, start.force, end.force),
            rates: ramp(before.rates, start.rates, end.rates),
        };
        (before, self.cue)
    }
}
