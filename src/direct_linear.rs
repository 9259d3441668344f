//! Block (3), direct linear motion: the high-frequency specific force, integrated twice, moves the platform, and the
//! safety units keep it inside its limits.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::bump::Bump;
use crate::chain::Chain;
use crate::governor::{Governor, Limits, Motion};
use crate::interface::{SafetyParameters, SplitterParameters};
use crate::splitter::high_pass_denominators;

/// The linear channel with its state, one axis each for x, y and z of the base frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DirectLinearMotion {
    axes: [Axis; 3],
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Axis {
    chain: Chain,
    bump: Bump,
    safety: Governor,
}

/// Position, velocity and acceleration of the platform relative to neutral, in the base frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearMotion {
    pub position: Vector3<f64>,
    pub velocity: Vector3<f64>,
    pub acceleration: Vector3<f64>,
}

impl DirectLinearMotion {
    /// At rest at neutral.
    pub fn new(parameters: &SplitterParameters, order: i32) -> Self {
        DirectLinearMotion {
            axes: high_pass_denominators(parameters, order).map(|denominator| Axis {
                chain: Chain::new(denominator),
                bump: Bump::default(),
                safety: Governor::at_rest(0.0),
            }),
        }
    }

    /// Takes other filter parameters at an instant at which the input changes from `before` to `after` because of other
    /// new parameters: position, velocity and acceleration stay what they are, and the difference fades away.
    pub fn retune(&mut self, parameters: &SplitterParameters, order: i32, before: Vector3<f64>, after: Vector3<f64>) {
        for (k, denominator) in high_pass_denominators(parameters, order).into_iter().enumerate() {
            let Axis { chain, bump, .. } = &mut self.axes[k];
            let acceleration = chain.high_pass(before[k]);
            chain.retune(denominator, 2);
            bump.add(acceleration - chain.high_pass(after[k]));
        }
    }

    /// Advances by `step` seconds while the input, a force in the base frame, goes linearly from `start` to `end`.
    /// No step is ever longer than `longest_step`.
    pub fn advance(
        &mut self,
        start: Vector3<f64>,
        end: Vector3<f64>,
        safety: &SafetyParameters,
        longest_step: f64,
        step: f64,
    ) -> LinearMotion {
        let SafetyParameters { position_limit, velocity_limit, acceleration_limit } = safety;
        for (k, axis) in self.axes.iter_mut().enumerate() {
            let limits = Limits::symmetric(position_limit[k], velocity_limit[k], acceleration_limit[k], longest_step);
            axis.advance(start[k], end[k], &limits, step);
        }
        self.motion()
    }

    /// The motion now.
    pub fn motion(&self) -> LinearMotion {
        let [x, y, z] = self.axes.map(|axis| axis.safety.motion);
        LinearMotion {
            position: Vector3::new(x.position, y.position, z.position),
            velocity: Vector3::new(x.velocity, y.velocity, z.velocity),
            acceleration: Vector3::new(x.acceleration, y.acceleration, z.acceleration),
        }
    }

    /// Whether a safety unit acted in the last step.
    pub fn limited(&self) -> bool {
        self.axes.iter().any(|axis| axis.safety.acting)
    }
}

impl Axis {
    fn advance(&mut self, start: f64, end: f64, limits: &Limits, step: f64) {
        let (bump_start, bump_end) = self.bump.advance(step);
        let end = end + bump_end;
        self.chain.advance(start + bump_start, end, step);
        let washed_out = Motion {
            position: self.chain.second_integral(),
            velocity: self.chain.first_integral(),
            acceleration: self.chain.high_pass(end),
        };
        self.safety.advance(&washed_out, limits, step);
    }
}
