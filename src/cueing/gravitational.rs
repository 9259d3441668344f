//! Block (2), the gravitational strategy: tilt, so that gravity is felt as the
//! low-frequency specific force.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::interface::TiltParameters;
use crate::motion::Motion;
use crate::motion::braking_law::Limits;

/// The tilt of the platform that the gravitational strategy commands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GravitationalStrategy {
    pub roll: Motion,
    pub pitch: Motion,
    target: Tilt,
    /// True if a limit kept the tilt from its target in the last step.
    pub limited: bool,
}

/// A roll and a pitch \[rad\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tilt {
    pub roll: f64,
    pub pitch: f64,
}

/// Eq. (8): the tilt at which the rider, whose head leans by `lean`, feels `force` (in
/// head axes) along x and y.
///
/// pitch = -asin(ax/g), roll = asin(ay/(g cos pitch)) - lean. The arcsines are kept inside
/// the angle limit, and so is the roll after the lean is subtracted. Also returns true if
/// one of them had to be.
pub fn tilt_target(force: Vector3<f64>, gravity: f64, lean: f64, angle_limit: f64) -> (Tilt, bool) {
    let pitch = -libm::asin(force.x / gravity);
    // g cos(pitch), as a root that does not depend on the arcsine.
    let head_roll = libm::asin(force.y / (gravity * gravity - force.x * force.x).sqrt());
    let roll = head_roll - lean;
    // The arcsine of a number beyond 1 is NaN, which is not inside.
    let inside = |angle: f64| angle.abs() <= angle_limit;
    if inside(pitch) && inside(head_roll) && inside(roll) {
        (Tilt { roll, pitch }, false)
    } else {
        (limited_tilt_target(force, gravity, lean, angle_limit), true)
    }
}

fn limited_tilt_target(force: Vector3<f64>, gravity: f64, lean: f64, angle_limit: f64) -> Tilt {
    let limited_arcsine = |sine: f64| libm::asin(sine.clamp(-1.0, 1.0)).clamp(-angle_limit, angle_limit);
    let pitch = -limited_arcsine(force.x / gravity);
    let head_roll = limited_arcsine(force.y / (gravity * libm::cos(pitch)));
    Tilt { roll: (head_roll - lean).clamp(-angle_limit, angle_limit), pitch }
}

impl GravitationalStrategy {
    /// Advances by `step` seconds towards the tilt for this low-frequency force in head axes, under
    /// the rate and the acceleration limit. No step is ever longer than `longest_step`.
    pub fn advance(
        &mut self,
        force: Vector3<f64>,
        gravity: f64,
        lean: f64,
        parameters: &TiltParameters,
        longest_step: f64,
        step: f64,
    ) {
        let TiltParameters { rate_limit, acceleration_limit, angle_limit } = *parameters;
        let limits = Limits::symmetric(angle_limit, rate_limit, acceleration_limit, longest_step);
        let (target, clipped) = tilt_target(force, gravity, lean, angle_limit);
        let (roll, roll_limited) = track(&self.roll, self.target.roll, target.roll, &limits, step);
        let (pitch, pitch_limited) = track(&self.pitch, self.target.pitch, target.pitch, &limits, step);
        *self = GravitationalStrategy { roll, pitch, target, limited: clipped || roll_limited || pitch_limited };
    }
}

/// Deviation of the tilt from its target above which it counts as limited \[rad\]: 0.001 degrees.
const LAGGING: f64 = 2e-5;

/// One step of one angle towards its target, and true if the angle then lags behind.
///
/// The target's rate is taken from its last two values. A target inside the limits is tracked
/// without lag. Any other is tracked in nearly the shortest time and without overshoot.
#[inline(always)]
fn track(motion: &Motion, previous: f64, target: f64, limits: &Limits, step: f64) -> (Motion, bool) {
    let rate = ((target - previous) / step).clamp(-limits.velocity, limits.velocity);
    let goal = Motion { position: target, velocity: rate, acceleration: 0.0 };
    let next = limits.follow(motion, &goal, limits.acceleration, step);
    (next, (next.position - target).abs() > LAGGING)
}
