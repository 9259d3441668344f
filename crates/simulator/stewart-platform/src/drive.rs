//! The drive of a leg, or of a crank along its arc: a second-order response to the command, within
//! limits of speed, acceleration and stroke.

use moris_washout::motion::Motion;
use moris_washout::motion::braking_law::{Limits, approach_velocity};

use crate::interface::Parameters;

/// The drives over one internal step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    step: f64,
    /// Undamped natural frequency \[rad/s\] and damping ratio.
    bandwidth: f64,
    damping: f64,
    response: Response,
    limits: Limits,
}

/// Target of a drive for its leg at a step's end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveTarget {
    pub motion: Motion,
    /// True if a limit of speed, acceleration or stroke changes the second-order response.
    pub limited: bool,
}

impl Drive {
    /// For a step of `step` seconds.
    pub fn new(parameters: &Parameters, step: f64) -> Self {
        let (actuators, rig) = (&parameters.actuators, &parameters.rig);
        let [min, max] = rig.stroke();
        Drive {
            step,
            bandwidth: actuators.bandwidth,
            damping: actuators.damping,
            response: Response::new(actuators.bandwidth, actuators.damping, step),
            limits: Limits {
                min,
                max,
                velocity: rig.velocity_limit,
                acceleration: rig.acceleration_limit,
                max_step: parameters.setting.max_step,
            },
        }
    }

    /// Target for a leg of this length \[m\] and velocity \[m/s\], whose command goes linearly from
    /// one length to another.
    pub fn target(&self, length: f64, velocity: f64, from: f64, to: f64) -> DriveTarget {
        let slope = (to - from) / self.step;
        // Far behind a ramp, a second-order system follows it with this lag.
        let lag = 2.0 * self.damping / self.bandwidth * slope;
        let (offset, rate) = (length - (from - lag), velocity - slope);
        let (offset_after, rate_after) = self.response.after(offset, rate);
        let motion = Motion {
            position: to - lag + offset_after,
            velocity: slope + rate_after,
            acceleration: self.acceleration(offset_after, rate_after),
        };
        if self.acceleration(offset, rate).abs() <= self.limits.acceleration && is_allowed(&self.limits, &motion) {
            return DriveTarget { motion, limited: false };
        }
        DriveTarget { motion: self.limited(length, velocity, motion.velocity), limited: true }
    }

    /// The motion after the step that comes nearest to the demanded velocity within the limits.
    fn limited(&self, length: f64, velocity: f64, demand: f64) -> Motion {
        let now = Motion { position: length, velocity, acceleration: 0.0 };
        let next = self.limits.nearest_velocity(&now, demand, self.step);
        let coasted = length + 0.5 * velocity * self.step;
        Motion {
            position: coasted + 0.5 * next * self.step,
            velocity: next,
            acceleration: (next - velocity) / self.step,
        }
    }

    /// x'' = -2 z w x' - w^2 x.
    fn acceleration(&self, offset: f64, rate: f64) -> f64 {
        -self.bandwidth * (self.bandwidth * offset + 2.0 * self.damping * rate)
    }
}

/// Test of a leg's motion: within all limits, and able to stop ahead of the ends.
fn is_allowed(limits: &Limits, motion: &Motion) -> bool {
    let Motion { position, velocity, acceleration } = *motion;
    let ahead = if velocity > 0.0 { limits.max - position } else { position - limits.min };
    velocity.abs() <= limits.velocity
        && acceleration.abs() <= limits.acceleration
        && (limits.min..=limits.max).contains(&position)
        && velocity.abs() <= approach_velocity(ahead, limits.acceleration, limits.max_step)
}

/// The free motion of x'' + 2 z w x' + w^2 x = 0 over a step, exact: (x, x') after it from (x, x')
/// before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    position: [f64; 2],
    velocity: [f64; 2],
}

impl Response {
    /// For a natural frequency w \[rad/s\], a damping ratio z and a step \[s\].
    pub fn new(frequency: f64, damping: f64, step: f64) -> Self {
        let decay = libm::exp(-damping * frequency * step);
        let discriminant = 1.0 - damping * damping;
        let damped = frequency * discriminant.abs().sqrt();
        // Solutions are the decay times cosine and sine, or cosh and sinh, or 1 and t.
        let (even, odd) = if discriminant > 0.0 {
            (libm::cos(damped * step), libm::sin(damped * step) / damped)
        } else if discriminant < 0.0 {
            (libm::cosh(damped * step), libm::sinh(damped * step) / damped)
        } else {
            (1.0, step)
        };
        let drag = damping * frequency * odd;
        Response {
            position: [decay * (even + drag), decay * odd],
            velocity: [-decay * frequency * frequency * odd, decay * (even - drag)],
        }
    }

    /// (x, x') after the step.
    pub fn after(&self, position: f64, velocity: f64) -> (f64, f64) {
        (
            self.position[0] * position + self.position[1] * velocity,
            self.velocity[0] * position + self.velocity[1] * velocity,
        )
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, Vector2};

    use super::*;

    #[test]
    fn the_response_is_the_matrix_exponential() {
        for damping in [0.05, 0.3, 0.707, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.7, 9.0] {
            for (frequency, step) in [(60.0, 0.001), (5.0, 0.3), (900.0, 0.01)] {
                let response = Response::new(frequency, damping, step);
                let generator = Matrix2::new(0.0, 1.0, -frequency * frequency, -2.0 * damping * frequency);
                let expected = (generator * step).exp() * Vector2::new(0.7, -0.2 * frequency);
                let (position, velocity) = response.after(0.7, -0.2 * frequency);
                assert!((position - expected.x).abs() < 1e-11, "{damping} {frequency} {step}");
                assert!((velocity - expected.y).abs() < 1e-10 * frequency, "{damping} {frequency} {step}");
            }
        }
    }

    #[test]
    fn a_leg_far_from_its_command_keeps_its_limits_and_arrives() {
        let parameters = Parameters::default();
        let drive = Drive::new(&parameters, 0.001);
        for (begin, command) in [(1.3, 1.59), (1.0, 1.6), (1.59, 1.0), (1.3, 5.0), (1.3, -9.0)] {
            let mut motion = Motion::at_rest(begin);
            for _ in 0..5000 {
                let target = drive.target(motion.position, motion.velocity, command, command);
                let change = (target.motion.velocity - motion.velocity).abs();
                motion = target.motion;
                assert!((1.0 - 1e-12..=1.6 + 1e-12).contains(&motion.position), "{}", motion.position);
                assert!(motion.velocity.abs() <= 1.0 + 1e-12 && change <= 0.015 + 1e-12);
            }
            assert!((motion.position - command.clamp(1.0, 1.6)).abs() < 1e-6, "{command}: {}", motion.position);
        }
    }
}
