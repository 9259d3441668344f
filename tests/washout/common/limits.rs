//! Watching a washout's output for anything beyond the limits.

use moris_washout::{Output, Parameters};
use nalgebra::Vector3;

/// Tolerance of rounding beyond a limit.
const ROUNDING: f64 = 1.0 + 1e-9;

/// Looks at every output of a ride and panics at the first that breaks a limit.
pub struct Watch {
    parameters: Parameters,
    last: Output,
    /// Mean velocities of the legs over the last step, and its length; none before the first step.
    last_mean: Option<([f64; 6], f64)>,
}

impl Watch {
    /// Begins with the output before the first step.
    pub fn new(parameters: &Parameters, output: &Output) -> Self {
        Watch { parameters: *parameters, last: *output, last_mean: None }
    }

    /// Looks at the output after a step of `step` seconds.
    pub fn check(&mut self, output: &Output, step: f64) {
        self.check_platform(output, step);
        self.check_machine(output, step);
    }

    /// Looks at the numbers and the legs alone, where the platform may be outside of its
    /// own limits for a while.
    pub fn check_machine(&mut self, output: &Output, step: f64) {
        self.look_for_numbers(output);
        self.check_legs(output, step);
        self.last = *output;
    }

    fn look_for_numbers(&self, output: &Output) {
        let vectors = [
            output.position,
            output.velocity,
            output.acceleration,
            output.orientation.to_vector(),
            output.angular_velocity,
            output.felt_specific_force,
            output.felt_angular_velocity,
            Vector3::new(output.tilt_roll, output.tilt_pitch, output.stroke_margin),
            Vector3::new(output.tilt_roll_rate, output.tilt_pitch_rate, 0.0),
        ];
        let finite = vectors.iter().all(|vector| vector.iter().all(|value| value.is_finite()));
        assert!(finite, "not a number in {output:?}");
    }

    fn check_legs(&mut self, output: &Output, step: f64) {
        let rig = &self.parameters.rig;
        let mut mean = [0.0; 6];
        for i in 0..6 {
            let (length, velocity) = (output.length[i], output.leg_velocity[i]);
            assert!((rig.min_length..=rig.max_length).contains(&length), "leg {i} is {length} m long");
            assert!(velocity.abs() <= rig.velocity_limit * ROUNDING, "leg {i} at {velocity} m/s");
            let change = (velocity - self.last.leg_velocity[i]) / step;
            assert!(change.abs() <= rig.acceleration_limit * (1.0 + 1e-6), "leg {i} accelerates by {change} m/s2");
            mean[i] = (length - self.last.length[i]) / step;
            // A difference of two lengths is known to the rounding of a length.
            let rounding = 1e-15 / step;
            assert!(mean[i].abs() <= rig.velocity_limit * ROUNDING + rounding, "leg {i} travels at {} m/s", mean[i]);
            if let Some((last_mean, last_step)) = self.last_mean {
                let between = 0.5 * (step + last_step);
                let second = ((mean[i] - last_mean[i]).abs() - rounding - 1e-15 / last_step) / between;
                assert!(second <= rig.acceleration_limit * (1.0 + 1e-6), "leg {i}: second difference {second} m/s2");
            }
        }
        self.last_mean = Some((mean, step));
    }

    fn check_platform(&self, output: &Output, step: f64) {
        let Parameters { safety, rig, .. } = &self.parameters;
        let neutral = Vector3::new(0.0, 0.0, rig.neutral_height);
        for k in 0..3 {
            let position = output.position[k] - neutral[k];
            assert!(position.abs() <= safety.position_limit[k] * ROUNDING, "axis {k} at {position} m");
            let velocity = output.velocity[k];
            assert!(velocity.abs() <= safety.velocity_limit[k] * ROUNDING, "axis {k} at {velocity} m/s");
            let acceleration = output.acceleration[k];
            assert!(acceleration.abs() <= safety.acceleration_limit[k] * ROUNDING, "axis {k} at {acceleration} m/s2");
            let change = (velocity - self.last.velocity[k]) / step;
            assert!(
                change.abs() <= safety.acceleration_limit[k] * (1.0 + 1e-6),
                "axis {k} accelerates by {change} m/s2"
            );
        }
    }
}
