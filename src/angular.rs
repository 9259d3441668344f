//! Blocks (5) and (6), the angular channel: high-pass the rates of roll, pitch and yaw, and integrate once.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::bump::Bump;
use crate::chain::{Chain, Denominator};
use crate::governor::Motion;
use crate::interface::AngularParameters;

/// The angular channel with its state: roll, pitch, yaw.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AngularChannel {
    axes: [Axis; 3],
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Axis {
    chain: Chain,
    bump: Bump,
    motion: Motion,
}

impl AngularChannel {
    /// At rest.
    pub fn new(parameters: &AngularParameters, order: i32) -> Self {
        AngularChannel {
            axes: denominators(parameters, order).map(|denominator| Axis {
                chain: Chain::new(denominator),
                bump: Bump::default(),
                motion: Motion::default(),
            }),
        }
    }

    /// Takes other filter parameters at an instant at which the input changes from `before` to `after` because of other
    /// new parameters: angles and rates stay what they are, and the difference fades away.
    pub fn retune(&mut self, parameters: &AngularParameters, order: i32, before: Vector3<f64>, after: Vector3<f64>) {
        for (k, denominator) in denominators(parameters, order).into_iter().enumerate() {
            let Axis { chain, bump, .. } = &mut self.axes[k];
            let rate = chain.high_pass(before[k]);
            chain.retune(denominator, 1);
            bump.add(rate - chain.high_pass(after[k]));
        }
    }

    /// Advances by `step` seconds while the rates go linearly from `start` to `end`. Returns angle, rate and
    /// acceleration of roll, pitch and yaw.
    ///
    /// The acceleration is the mean over the step, from one step's rate to the next one's: the accelerations add up to the
    /// rates, also where the input jumps between two steps.
    pub fn advance(&mut self, start: Vector3<f64>, end: Vector3<f64>, step: f64) -> [Motion; 3] {
        for (k, axis) in self.axes.iter_mut().enumerate() {
            axis.advance(start[k], end[k], step);
        }
        self.axes.map(|axis| axis.motion)
    }
}

impl Axis {
    fn advance(&mut self, start: f64, end: f64, step: f64) {
        let (bump_start, bump_end) = self.bump.advance(step);
        let (start, end) = (start + bump_start, end + bump_end);
        self.chain.advance(start, end, step);
        let rate = self.chain.high_pass(end);
        let acceleration = (rate - self.motion.velocity) / step;
        self.motion = Motion { position: self.chain.first_integral(), velocity: rate, acceleration };
    }
}

fn denominators(parameters: &AngularParameters, order: i32) -> [Denominator; 3] {
    let AngularParameters { omega1, zeta1, omega2, zeta2 } = parameters;
    [
        Denominator::new(order, omega1.roll, zeta1.roll, omega2.roll, zeta2.roll),
        Denominator::new(order, omega1.pitch, zeta1.pitch, omega2.pitch, zeta2.pitch),
        Denominator::new(order, omega1.yaw, zeta1.yaw, omega2.yaw, zeta2.yaw),
    ]
}
