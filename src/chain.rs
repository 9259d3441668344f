//! The filter chain: high-pass, low-pass, velocity and position from one state.
//!
//! With D(s) = s^n + c1 s^(n-1) + ... + cn, the chain is D(s) xi = u. Its highest derivative is the high-pass,
//! s^n/D u = u - (c1 xi^(n-1) + ... + cn xi), and what is subtracted there is the low-pass 1 - s^n/D, so that the two
//! add up to the input exactly, eq. (6). The first integral of the high-pass is xi^(n-1) and the second xi^(n-2): no
//! integrator runs free, nothing drifts.

use nalgebra::SMatrix;
use serde::{Deserialize, Serialize};

/// The coefficients c1..c4 of D(s); those beyond the order are zero.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Denominator {
    coefficients: [f64; 4],
    order: usize,
}

impl Denominator {
    /// (s^2 + 2 z1 w1 s + w1^2) times (s^2 + 2 z2 w2 s + w2^2) for order 4, times (s + w2) for order 3, alone for 2.
    ///
    /// Frequencies in rad/s. Any other order counts as 4.
    pub fn new(order: i32, omega1: f64, zeta1: f64, omega2: f64, zeta2: f64) -> Self {
        let (b1, b0) = (2.0 * zeta1 * omega1, omega1 * omega1);
        match order {
            2 => Denominator { coefficients: [b1, b0, 0.0, 0.0], order: 2 },
            3 => Denominator { coefficients: [b1 + omega2, b0 + b1 * omega2, b0 * omega2, 0.0], order: 3 },
            _ => {
                let (e1, e0) = (2.0 * zeta2 * omega2, omega2 * omega2);
                let coefficients = [b1 + e1, b0 + e0 + b1 * e1, b1 * e0 + e1 * b0, b0 * e0];
                Denominator { coefficients, order: 4 }
            }
        }
    }
}

/// The exact solution of the chain over one step for an input that is linear in time (first-order hold).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Transition {
    step: f64,
    /// What each of the four states, the input and the input's slope add to the four states: a column each.
    columns: [[f64; 4]; 6],
}

impl Transition {
    /// By the matrix exponential of the chain with its input and the input's slope as two more states.
    fn new(denominator: &Denominator, step: f64) -> Self {
        let mut matrix = SMatrix::<f64, 6, 6>::zeros();
        for (k, c) in denominator.coefficients.iter().enumerate() {
            matrix[(0, k)] = -c;
        }
        for k in 1..denominator.order {
            matrix[(k, k - 1)] = 1.0;
        }
        matrix[(0, 4)] = 1.0;
        matrix[(4, 5)] = 1.0;
        let scaled = matrix * step;
        // A state that somebody made up can have any coefficients, and on infinite ones the exponential never ends.
        let usable = scaled.iter().all(|entry| entry.abs() < 1e30);
        let exponential = if usable { scaled.exp() } else { SMatrix::zeros() };
        Transition { step, columns: std::array::from_fn(|j| std::array::from_fn(|i| exponential[(i, j)])) }
    }
}

/// A chain with its state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chain {
    denominator: Denominator,
    transition: Transition,
    /// xi^(n-1), xi^(n-2), and down to xi; zero beyond the order.
    state: [f64; 4],
}

/// State below this is rest: what decays for long would otherwise end in denormal numbers, which are slow.
const REST: f64 = 1e-30;

impl Chain {
    /// A chain at rest.
    pub fn new(denominator: Denominator) -> Self {
        Chain { denominator, transition: Transition::new(&denominator, 0.0), state: [0.0; 4] }
    }

    /// Advances by `step` seconds while the input goes linearly from `start` to `end`.
    pub fn advance(&mut self, start: f64, end: f64, step: f64) {
        if step != self.transition.step {
            self.transition = Transition::new(&self.denominator, step);
        }
        let [x1, x2, x3, x4] = self.state;
        let slope = (end - start) / step;
        let [a, b, c, d, u, s] = &self.transition.columns;
        let next = |i: usize| {
            let x = (a[i] * x1 + b[i] * x2) + (c[i] * x3 + d[i] * x4) + (u[i] * start + s[i] * slope);
            if x.abs() < REST { 0.0 } else { x }
        };
        self.state = std::array::from_fn(next);
    }

    /// The low-pass 1 - s^n/D of the input.
    pub fn low_pass(&self) -> f64 {
        let [c1, c2, c3, c4] = self.denominator.coefficients;
        let [x1, x2, x3, x4] = self.state;
        (c1 * x1 + c2 * x2) + (c3 * x3 + c4 * x4)
    }

    /// The high-pass s^n/D of the input, whose value is `input` now.
    pub fn high_pass(&self, input: f64) -> f64 {
        input - self.low_pass()
    }

    /// The first integral of the high-pass, s^(n-1)/D of the input.
    pub fn first_integral(&self) -> f64 {
        self.state[0]
    }

    /// The second integral of the high-pass, s^(n-2)/D of the input.
    pub fn second_integral(&self) -> f64 {
        self.state[1]
    }

    /// Only the last term of the low-pass, cn/D of the input: a low-pass without zeros, for an order of 2.
    pub fn all_pole_low_pass(&self) -> f64 {
        self.denominator.coefficients[self.denominator.order - 1] * self.state[self.denominator.order - 1]
    }

    /// Takes other coefficients, keeping the first `kept` states and every later term of the low-pass as they are.
    ///
    /// What is kept is what the platform's motion is made of; the later states only remember, and are rescaled so that
    /// what the filter has already washed out stays so.
    pub fn retune(&mut self, denominator: Denominator, kept: usize) {
        let (old, new) = (self.denominator.coefficients, denominator.coefficients);
        for k in kept..denominator.order {
            self.state[k] *= old[k] / new[k];
        }
        if denominator != self.denominator {
            self.transition = Transition::new(&denominator, self.transition.step);
            self.denominator = denominator;
        }
    }
}
