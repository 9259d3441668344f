//! Block (1), second half: the low-frequency part of the specific force, which tilt
//! coordination reproduces.
//!
//! The high-frequency part is in [`crate::cueing::direct_linear`], where it is also integrated.
//! With the complementary low-pass both are the same chain, D(s) xi = u, and add up to the input
//! exactly, eq. (6). The two are kept apart because the compensation of spurious accelerations
//! enters only the high-pass.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::filter::chain::{Chains, Denominator};
use crate::interface::{LowPassKind, SplitterParameters};

/// The low-pass filters, one for each axis of the base frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LowPass {
    chains: Chains,
    complementary: bool,
}

impl LowPass {
    /// Filters at rest, ready for steps of `max_step` seconds. `order` is that of the high-pass
    /// to which a complementary low-pass belongs.
    pub fn new(parameters: &SplitterParameters, order: i32, kind: LowPassKind, max_step: f64) -> Self {
        let complementary = kind == LowPassKind::Complementary;
        let denominators = denominators(parameters, order, complementary);
        LowPass { chains: Chains::new(denominators, max_step), complementary }
    }

    /// Changes frequencies and dampings; the output stays what it is.
    pub fn retune(&mut self, parameters: &SplitterParameters, order: i32) {
        self.chains.retune(denominators(parameters, order, self.complementary), 0);
    }

    /// Advances by `step` seconds while the force goes linearly from `start` to `end`; returns
    /// its low-frequency part.
    pub fn advance(&mut self, start: Vector3<f64>, end: Vector3<f64>, step: f64) -> Vector3<f64> {
        self.chains.advance(start, end, step);
        if self.complementary { self.chains.low_pass() } else { self.chains.all_pole_low_pass() }
    }
}

fn denominators(parameters: &SplitterParameters, order: i32, complementary: bool) -> [Denominator; 3] {
    let SplitterParameters { omega1, zeta1, omega2, zeta2, low_pass_omega, low_pass_zeta } = parameters;
    core::array::from_fn(|axis| {
        if complementary {
            Denominator::new(order, omega1[axis], zeta1[axis], omega2[axis], zeta2[axis])
        } else {
            Denominator::new(2, low_pass_omega[axis], low_pass_zeta[axis], 1.0, 1.0)
        }
    })
}

/// The high-pass filters' D(s), one for each axis of the base frame.
pub fn high_pass_denominators(parameters: &SplitterParameters, order: i32) -> [Denominator; 3] {
    denominators(parameters, order, true)
}
