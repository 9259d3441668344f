//! Block (2), the gravitational strategy: tilt, so that gravity is felt as the
//! low-frequency specific force.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::cueing::strategy::law::AxisState;
use crate::cueing::strategy::smooth_tilt::TiltLimits;
use crate::interface::{TiltParameters, TiltTracking};
use crate::motion::Motion;
use crate::motion::braking_law::Limits;
use crate::motion::square_root::square_root;

/// The tilt of the platform that the gravitational strategy commands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GravitationalStrategy {
    pub roll: Motion,
    pub pitch: Motion,
    target: Tilt,
    /// Rate of the target over the last step \[rad/s\].
    target_rate: Tilt,
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
    let head_roll = libm::asin(force.y / square_root(gravity * gravity - force.x * force.x));
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
    /// the limits and by the law of the parameters. No step is ever longer than `max_step`.
    pub fn advance(
        &mut self,
        force: Vector3<f64>,
        gravity: f64,
        lean: f64,
        parameters: &TiltParameters,
        max_step: f64,
        step: f64,
    ) {
        let TiltParameters { rate_limit, acceleration_limit, angle_limit, tracking } = *parameters;
        let limits = Limits::symmetric(angle_limit, rate_limit, acceleration_limit, max_step);
        let (target, clipped) = tilt_target(force, gravity, lean, angle_limit);
        let rate = |now: f64, before: f64| ((now - before) / step).clamp(-rate_limit, rate_limit);
        let target_rate =
            Tilt { roll: rate(target.roll, self.target.roll), pitch: rate(target.pitch, self.target.pitch) };
        let smooth = TiltLimits::new(angle_limit, rate_limit, acceleration_limit);
        let track = |motion: &Motion, position: f64, velocity: f64, rate_before: f64| {
            let goal = Motion { position, velocity, acceleration: (velocity - rate_before) / step };
            let next = match tracking {
                TiltTracking::Exact => limits.follow(motion, &goal, limits.acceleration, step),
                TiltTracking::Smooth => follow_smoothly(motion, &goal, &smooth, &limits, step),
            };
            (next, (next.position - position).abs() > LIMITED_TILT_DEVIATION)
        };
        let (roll, roll_limited) = track(&self.roll, target.roll, target_rate.roll, self.target_rate.roll);
        let (pitch, pitch_limited) = track(&self.pitch, target.pitch, target_rate.pitch, self.target_rate.pitch);
        let limited = clipped || roll_limited || pitch_limited;
        *self = GravitationalStrategy { roll, pitch, target, target_rate, limited };
    }
}

/// Deviation of the tilt from its target above which it counts as limited \[rad\]: 0.001 degrees.
const LIMITED_TILT_DEVIATION: f64 = 2e-5;

/// Pace at which a deviation from the target is taken back \[rad/s\].
const CATCH_UP: f64 = 7.0;

/// One step of one angle towards its goal: the goal's acceleration, and critically damped what the
/// angle deviates by, within the limits.
fn follow_smoothly(motion: &Motion, goal: &Motion, smooth: &TiltLimits, limits: &Limits, step: f64) -> Motion {
    let behind = goal.position - step * goal.velocity - motion.position;
    let demanded = goal.acceleration + CATCH_UP * (CATCH_UP * behind + 2.0 * (goal.velocity - motion.velocity));
    let state = AxisState {
        tilt: motion.position,
        tilt_rate: motion.velocity,
        tilt_acceleration: motion.acceleration,
        ..AxisState::default()
    };
    let acceleration = smooth.nearest_acceleration(&state, demanded, step);
    limits.at_velocity(motion, motion.velocity + acceleration * step, step)
}
