//! A shadow platform: one axis of travel and tilt under a linear-quadratic regulator.

use serde::{Deserialize, Serialize};

use crate::cueing::strategy::regulator::{AxisModel, State, Weights};
use crate::motion::Motion;
use crate::motion::braking_law::{Limits, approach_velocity};
use crate::motion::min_max::{max, min};

/// Weights of the regulator. With them the shadows' shape errors are those of the predictive
/// strategy, scale by scale, on recorded rides.
pub const REGULATOR_WEIGHTS: Weights = Weights {
    position: 4e-3,
    velocity: 0.6,
    tilt_rate: 9.4e-4,
    tilt_acceleration: 5e-4,
    slow_pole: 0.147,
    fast_pole: 2.24,
};

/// Time constant that splits the reference into its slow and its fast part \[s\].
const SPLIT_TIME: f64 = 0.6;
/// Deceleration with which travel stops at its limit \[m/s2\].
const BRAKING_DECELERATION: f64 = 1.3;

/// One axis at one scale.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Platform {
    travel: Motion,
    tilt: Motion,
    /// Slow part of the reference \[m/s2\].
    slow: f64,
}

impl Platform {
    /// Advances by `step` seconds with this reference and law. Returns the force that is felt
    /// \[m/s2\].
    pub fn advance(&mut self, model: &AxisModel, law: &impl Fn(&State) -> [f64; 2], reference: f64, step: f64) -> f64 {
        let Platform { travel, tilt, .. } = *self;
        self.slow += (1.0 - libm::exp(-step / SPLIT_TIME)) * (reference - self.slow);
        let (slow, fast) = (self.slow, reference - self.slow);
        let state = State::new(travel.position, travel.velocity, tilt.position, tilt.velocity, slow, fast);
        let [dropped_force, tilting] = law(&state);
        let AxisModel { angle_limit, rate_limit, acceleration_limit, .. } = *model;
        let limits = Limits::symmetric(angle_limit, rate_limit, acceleration_limit, step);
        self.tilt = limits.at_velocity(&tilt, tilt.velocity + tilting * step, step);
        // a = r + e - g q + H alpha, as far as travel reaches.
        let swung = model.head_height * self.tilt.acceleration;
        let gravity = model.gravity * tilt.position;
        let acceleration = reference + dropped_force - gravity + swung;
        self.travel = within_reach(&travel, travel.velocity + acceleration * step, model, step);
        self.travel.acceleration - swung + gravity
    }
}

/// Travel after a step with this velocity demanded at its end. Travel stops at its limit, and may
/// accelerate at will otherwise.
fn within_reach(travel: &Motion, demanded: f64, model: &AxisModel, step: f64) -> Motion {
    let Motion { position, velocity, .. } = *travel;
    let coasted = position + 0.5 * velocity * step;
    let fastest = |side: f64| {
        let clearance = model.position_limit - side * coasted;
        min(approach_velocity(clearance, BRAKING_DECELERATION, step), model.velocity_limit)
    };
    let next = max(min(demanded, fastest(1.0)), -fastest(-1.0));
    Motion { position: coasted + 0.5 * next * step, velocity: next, acceleration: (next - velocity) / step }
}
