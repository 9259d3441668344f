//! The adaptive strategy: a coordinated filter of each axis whose two gains follow
//! the gradient of a cost.
//!
//! After Parrish, Dieudonne, Bowles and Martin (*Coordinated Adaptive Washout for Motion
//! Simulators*, 1975) and Nahon, Reid and Kirdeikis (1992). With u = f - g sin q what the tilt
//! leaves of the reference f,
//!
//! ```text
//!     a = P1 (u + H alpha) - d v - e x,    q' = P2 u within the tilt's limits
//!     J = [(felt - f)^2 + rho_x x^2 + rho_v v^2 + rho_w w^2 + k1 (P1 - P10)^2 + k2 (P2 - P20)^2] / 2
//!     P1' = -K1 dJ/dP1,    P2' = -K2 dJ/dP2
//! ```
//!
//! The sensitivities dx/dP1, dx/dP2 and dq/dP2 are integrated beside the motion. The weights of
//! travel and of its velocity, rho_x and rho_v, increase near the ends of the actuators' strokes.

use serde::{Deserialize, Serialize};

use super::regulator::AxisModel;
use super::{AxisState, Decision, at_rest_if_tiny};
use crate::interface::AdaptiveParameters;

/// The strategy with its state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Adaptive {
    models: [AxisModel; 2],
    parameters: AdaptiveParameters,
    axes: [Adaptation; 2],
}

/// The gains of one axis, and the sensitivities to them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Adaptation {
    gains: [f64; 2],
    /// Of the position and the velocity to P1.
    to_travel_gain: [f64; 2],
    /// Of the position and the velocity to P2.
    to_tilt_gain: [f64; 2],
    /// Of the tilt to P2.
    tilt: f64,
}

/// Bound on the sensitivities. They are of no use long before they reach it.
const LARGEST_SENSITIVITY: f64 = 1e3;
/// The fraction of its nominal value below which no gain falls. Without a gain, the
/// tilt would never return.
const LEAST_GAIN: f64 = 0.1;
/// While a limit holds the tilt, its sensitivity decays at this rate \[1/s\].
const SENSITIVITY_DECAY: f64 = 0.2;
/// The weights of travel increase when less than this is left of a stroke \[m\] ...
const NEAR_END: f64 = 0.1;
/// ... by up to this many times their value, at its end.
const DEARER: f64 = 10.0;

impl Adaptive {
    /// At rest, with the nominal gains.
    pub fn new(models: &[AxisModel; 2], parameters: &AdaptiveParameters) -> Self {
        let gains = [parameters.nominal1, parameters.nominal2];
        let axis = Adaptation { gains, to_travel_gain: [0.0; 2], to_tilt_gain: [0.0; 2], tilt: 0.0 };
        Adaptive { models: *models, parameters: *parameters, axes: [axis; 2] }
    }

    /// Changes the parameters. The gains continue from where they are.
    pub fn retune(&mut self, models: &[AxisModel; 2], parameters: &AdaptiveParameters) {
        (self.models, self.parameters) = (*models, *parameters);
    }

    /// Decision for a step of `step` seconds. It begins in these states and has these references at
    /// its end. The actuators have `stroke_margin` left of their strokes \[m\].
    pub fn decide(
        &mut self,
        states: &[AxisState; 2],
        references: [f64; 2],
        stroke_margin: f64,
        step: f64,
    ) -> [Decision; 2] {
        let near_end = (1.0 - stroke_margin / NEAR_END).max(0.0);
        let dearer = 1.0 + DEARER * near_end * near_end;
        [0, 1].map(|k: usize| {
            self.axes[k].decide(&self.models[k], &self.parameters, &states[k], references[k], dearer, step)
        })
    }
}

impl Adaptation {
    fn decide(
        &mut self,
        model: &AxisModel,
        parameters: &AdaptiveParameters,
        state: &AxisState,
        reference: f64,
        dearer: f64,
        step: f64,
    ) -> Decision {
        let AxisState { position, velocity, tilt, tilt_rate } = *state;
        let (sin, cos) = libm::sincos(tilt);
        let [travel_gain, tilt_gain] = self.gains;
        let left = reference - model.gravity * sin;
        let rate = (tilt_gain * left).clamp(-model.rate_limit, model.rate_limit);
        let demanded = (rate - tilt_rate) / step;
        let alpha = demanded.clamp(-model.acceleration_limit, model.acceleration_limit);
        let AdaptiveParameters { omega, zeta, nominal1, nominal2, .. } = *parameters;
        let (damping, stiffness) = (2.0 * zeta * omega, omega * omega);
        let inertial = left + model.head_height * alpha;
        let dropped = (travel_gain - 1.0) * inertial - damping * velocity - stiffness * position;

        let limited = alpha != demanded || rate != tilt_gain * left || tilt.abs() >= model.angle_limit;
        let gravity = model.gravity * cos;
        let tilt_change = if limited { -SENSITIVITY_DECAY * self.tilt } else { left - tilt_gain * gravity * self.tilt };
        let forced = |[x, v]: [f64; 2], by: f64| by - damping * v - stiffness * x;
        let travel_acceleration = forced(self.to_travel_gain, inertial);
        let tilt_acceleration = forced(self.to_tilt_gain, -travel_gain * gravity * self.tilt);

        let (weight_x, weight_v) =
            (dearer * parameters.weight_position * position, dearer * parameters.weight_velocity * velocity);
        let gradients = [
            dropped * travel_acceleration
                + weight_x * self.to_travel_gain[0]
                + weight_v * self.to_travel_gain[1]
                + parameters.pull1 * (travel_gain - nominal1),
            dropped * (tilt_acceleration + gravity * self.tilt)
                + weight_x * self.to_tilt_gain[0]
                + weight_v * self.to_tilt_gain[1]
                + parameters.weight_tilt_rate * tilt_rate * tilt_change
                + parameters.pull2 * (tilt_gain - nominal2),
        ];
        let laws = [(parameters.gain1, nominal1), (parameters.gain2, nominal2)];
        for ((gain, gradient), (rate, nominal)) in self.gains.iter_mut().zip(gradients).zip(laws) {
            *gain = (*gain - step * rate * gradient).clamp(LEAST_GAIN * nominal.min(1.0), 1.0);
        }
        self.to_travel_gain = integrated(self.to_travel_gain, travel_acceleration, step);
        self.to_tilt_gain = integrated(self.to_tilt_gain, tilt_acceleration, step);
        self.tilt = sensitivity(self.tilt + step * tilt_change);
        Decision { dropped_force: dropped, tilt_acceleration: alpha }
    }
}

/// A sensitivity of position and velocity after a step.
fn integrated([x, v]: [f64; 2], acceleration: f64, step: f64) -> [f64; 2] {
    [sensitivity(x + step * v), sensitivity(v + step * acceleration)]
}

fn sensitivity(value: f64) -> f64 {
    at_rest_if_tiny(value.clamp(-LARGEST_SENSITIVITY, LARGEST_SENSITIVITY))
}
