//! The filter chain: high-pass, low-pass, velocity and position from one state.
//!
//! With D(s) = s^n + c1 s^(n-1) + ... + cn, the chain is D(s) xi = u. Its highest derivative is the high-pass,
//! s^n/D u = u - (c1 xi^(n-1) + ... + cn xi), and what is subtracted there is the low-pass 1 - s^n/D, so that the two
//! add up to the input exactly, eq. (6). The first integral of the high-pass is xi^(n-1) and the second xi^(n-2): no
//! integrator runs free, nothing drifts.

use nalgebra::{SMatrix, Vector3};
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
///
/// `[i][j][axis]`: what each of the four states, the input and the input's slope (j) add to state i.
type Transition = [[[f64; 3]; 6]; 4];

/// By the matrix exponential of the chain with its input and the input's slope as two more states.
fn transition(denominators: &[Denominator; 3], step: f64) -> Transition {
    let exponentials = denominators.map(|denominator| exponential(&denominator, step));
    std::array::from_fn(|i| std::array::from_fn(|j| exponentials.map(|exponential| exponential[(i, j)])))
}

fn exponential(denominator: &Denominator, step: f64) -> SMatrix<f64, 6, 6> {
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
    if usable { scaled.exp() } else { SMatrix::zeros() }
}

/// Three chains side by side, one for each axis, with their states. They share nothing but the step; side by side the
/// processor does two at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chains {
    denominators: [Denominator; 3],
    /// The step that the transition is for \[s\].
    step: f64,
    transition: Transition,
    /// xi^(n-1), xi^(n-2), and down to xi, of each axis; zero beyond the order.
    states: [[f64; 3]; 4],
}

/// State below this is rest: what decays for long would otherwise end in denormal numbers, which are slow.
const REST: f64 = 1e-30;

impl Chains {
    /// Chains at rest.
    pub fn new(denominators: [Denominator; 3]) -> Self {
        Chains { denominators, step: 0.0, transition: transition(&denominators, 0.0), states: [[0.0; 3]; 4] }
    }

    /// Advances by `step` seconds while the input goes linearly from `start` to `end`.
    pub fn advance(&mut self, start: Vector3<f64>, end: Vector3<f64>, step: f64) {
        if step != self.step {
            self.transition = transition(&self.denominators, step);
            self.step = step;
        }
        let slope = (end - start) / step;
        let [x1, x2, x3, x4] = self.states;
        for (state, [a, b, c, d, u, s]) in self.states.iter_mut().zip(&self.transition) {
            for k in 0..3 {
                let x =
                    (a[k] * x1[k] + b[k] * x2[k]) + (c[k] * x3[k] + d[k] * x4[k]) + (u[k] * start[k] + s[k] * slope[k]);
                state[k] = if x.abs() < REST { 0.0 } else { x };
            }
        }
    }

    /// The low-pass 1 - s^n/D of the input.
    pub fn low_pass(&self) -> Vector3<f64> {
        let [x1, x2, x3, x4] = &self.states;
        Vector3::from_fn(|k, _| {
            let [c1, c2, c3, c4] = self.denominators[k].coefficients;
            (c1 * x1[k] + c2 * x2[k]) + (c3 * x3[k] + c4 * x4[k])
        })
    }

    /// The high-pass s^n/D of the input, whose value is `input` now.
    pub fn high_pass(&self, input: Vector3<f64>) -> Vector3<f64> {
        input - self.low_pass()
    }

    /// The first integral of the high-pass, s^(n-1)/D of the input.
    pub fn first_integral(&self) -> Vector3<f64> {
        self.states[0].into()
    }

    /// The second integral of the high-pass, s^(n-2)/D of the input.
    pub fn second_integral(&self) -> Vector3<f64> {
        self.states[1].into()
    }

    /// Only the last term of the low-pass, cn/D of the input: a low-pass without zeros, for an order of 2.
    pub fn all_pole_low_pass(&self) -> Vector3<f64> {
        Vector3::from_fn(|k, _| {
            let Denominator { coefficients, order } = self.denominators[k];
            coefficients[order - 1] * self.states[order - 1][k]
        })
    }

    /// Takes other coefficients, keeping the first `kept` states and every later term of the low-pass as they are.
    ///
    /// What is kept is what the platform's motion is made of; the later states only remember, and are rescaled so that
    /// what the filter has already washed out stays so.
    pub fn retune(&mut self, denominators: [Denominator; 3], kept: usize) {
        for (k, (old, new)) in self.denominators.iter().zip(&denominators).enumerate() {
            for i in kept..new.order {
                self.states[i][k] *= old.coefficients[i] / new.coefficients[i];
            }
        }
        if denominators != self.denominators {
            self.transition = transition(&denominators, self.step);
            self.denominators = denominators;
        }
    }
}
