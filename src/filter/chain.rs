//! The filter chain: high-pass, low-pass, velocity and position from one state.
//!
//! With D(s) = s^n + c1 s^(n-1) + ... + cn, the chain is D(s) xi = u. Its highest derivative is the
//! high-pass: s^n/D u = u - (c1 xi^(n-1) + ... + cn xi). The part subtracted there is the low-pass,
//! 1 - s^n/D. The two therefore add up to the input exactly, eq. (6).
//!
//! The first integral of the high-pass is xi^(n-1), the second xi^(n-2). No integrator runs free,
//! so that nothing drifts.

use nalgebra::{SMatrix, Vector3};
use serde::{Deserialize, Serialize};
use wide::{CmpLt, f64x2, f64x4};

/// The coefficients c1..c4 of D(s); those beyond the order are zero.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Denominator {
    coefficients: f64x4,
    order: usize,
}

impl Denominator {
    /// (s^2 + 2 z1 w1 s + w1^2) times (s^2 + 2 z2 w2 s + w2^2) for order 4, times (s + w2) for
    /// order 3, alone for 2.
    ///
    /// Frequencies in rad/s. Any other order counts as 4.
    pub fn new(order: i32, omega1: f64, zeta1: f64, omega2: f64, zeta2: f64) -> Self {
        let (b1, b0) = (2.0 * zeta1 * omega1, omega1 * omega1);
        let (coefficients, order) = match order {
            2 => ([b1, b0, 0.0, 0.0], 2),
            3 => ([b1 + omega2, b0 + b1 * omega2, b0 * omega2, 0.0], 3),
            _ => {
                let (e1, e0) = (2.0 * zeta2 * omega2, omega2 * omega2);
                ([b1 + e1, b0 + e0 + b1 * e1, b1 * e0 + e1 * b0, b0 * e0], 4)
            }
        };
        Denominator { coefficients: f64x4::from(coefficients), order }
    }
}

/// The exact solution of the chain over one step for an input that is linear in
/// time (first-order hold).
///
/// Contributions of each of the four states, and of the input at the step's start and
/// end, to the four states.
type Transition = [f64x4; 6];

/// By the matrix exponential of the chain with its input and the input's slope as two more states.
fn exact_transition(denominator: &Denominator, step: f64) -> Transition {
    let mut matrix = SMatrix::<f64, 6, 6>::zeros();
    for (k, c) in denominator.coefficients.as_array_ref().iter().enumerate() {
        matrix[(0, k)] = -c;
    }
    for k in 1..denominator.order {
        matrix[(k, k - 1)] = 1.0;
    }
    matrix[(0, 4)] = 1.0;
    matrix[(4, 5)] = 1.0;
    let scaled = matrix * step;
    // A deserialized state can have any coefficients, and on infinite ones the
    // exponential never ends.
    let usable = scaled.iter().all(|entry| entry.abs() < 1e30);
    let exponential = if usable { matrix_exponential(&scaled) } else { SMatrix::zeros() };
    let [a, b, c, d, input, slope] = core::array::from_fn(|j| f64x4::from([0, 1, 2, 3].map(|i| exponential[(i, j)])));
    // The slope is the difference of the inputs at the end and at the start, over the step.
    let end = slope / step;
    [a, b, c, d, input - end, end]
}

/// The exponential of a matrix, by scaling and squaring: exp(A) = exp(A / 2^k)^(2^k).
fn matrix_exponential<const N: usize>(matrix: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let norm = matrix.column_iter().map(|column| column.abs().sum()).fold(0.0, f64::max);
    // At this norm the terms that the series leaves out add up to less than 1e-18.
    let squarings = (0..).find(|&k| libm::scalbn(norm, -k) <= 0.5).unwrap_or(0);
    let scaled = matrix * libm::scalbn(1.0, -squarings);
    let mut sum = SMatrix::identity();
    for k in (1..=15).rev() {
        sum = SMatrix::identity() + scaled * sum / f64::from(k);
    }
    (0..squarings).fold(sum, |power, _| power * power)
}

/// Three chains, one for each axis, with their states.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chains {
    denominators: [Denominator; 3],
    /// The step that the transitions are for; zero while there is none \[s\].
    step: f64,
    transitions: [Transition; 3],
    /// xi^(n-1), xi^(n-2), and down to xi, of each axis; zero beyond the order.
    states: [f64x4; 3],
}

/// State below this is set to zero: what decays for long would otherwise end in denormal
/// numbers, which are slow.
const DENORMAL_THRESHOLD: f64x4 = f64x4::new([1e-30; 4]);

impl Chains {
    /// Chains at rest, which are ready for steps of `max_step` seconds. The first step of
    /// another length takes as long as ten others.
    pub fn new(denominators: [Denominator; 3], max_step: f64) -> Self {
        let mut chains =
            Chains { denominators, step: 0.0, transitions: Default::default(), states: Default::default() };
        chains.prepare(max_step);
        chains
    }

    /// The coefficients.
    pub fn denominators(&self) -> &[Denominator; 3] {
        &self.denominators
    }

    /// True if all states are zero.
    pub fn is_at_rest(&self) -> bool {
        self.states == [f64x4::ZERO; 3]
    }

    /// Advances by `step` seconds while the input goes linearly from `start` to `end`.
    #[inline(always)]
    pub fn advance(&mut self, start: Vector3<f64>, end: Vector3<f64>, step: f64) {
        if step != self.step {
            self.prepare(step);
        }
        // States beyond the order are zero.
        if self.denominators.iter().all(|denominator| denominator.order == 2) {
            return self.advance_second_order(start, end);
        }
        for k in 0..3 {
            let [x1, x2, x3, x4] = self.states[k].to_array();
            let [a, b, c, d, u, v] = self.transitions[k];
            let state = (a * x1 + b * x2) + (c * x3 + d * x4) + (u * start[k] + v * end[k]);
            let at_rest = state.abs().cmp_lt(DENORMAL_THRESHOLD);
            self.states[k] = !at_rest & state;
        }
    }

    /// Advances chains of order 2.
    #[inline(always)]
    fn advance_second_order(&mut self, start: Vector3<f64>, end: Vector3<f64>) {
        let first_two = |lanes: &f64x4| {
            let [first, second, ..] = lanes.to_array();
            f64x2::new([first, second])
        };
        for k in 0..3 {
            let [x1, x2, ..] = self.states[k].to_array();
            let [a, b, .., u, v] = self.transitions[k].each_ref().map(first_two);
            let state = (a * x1 + b * x2) + (u * start[k] + v * end[k]);
            let at_rest = state.abs().cmp_lt(first_two(&DENORMAL_THRESHOLD));
            let [x1, x2] = (!at_rest & state).to_array();
            self.states[k] = f64x4::new([x1, x2, 0.0, 0.0]);
        }
    }

    /// Computes the transitions for steps of this length, which rarely changes.
    #[cold]
    fn prepare(&mut self, step: f64) {
        self.transitions = self.denominators.map(|denominator| exact_transition(&denominator, step));
        self.step = step;
    }

    /// The low-pass 1 - s^n/D of the input.
    pub fn low_pass(&self) -> Vector3<f64> {
        Vector3::from_fn(|k, _| {
            let [a, b, c, d] = (self.denominators[k].coefficients * self.states[k]).to_array();
            (a + b) + (c + d)
        })
    }

    /// The high-pass s^n/D of the input, whose value is `input` now.
    pub fn high_pass(&self, input: Vector3<f64>) -> Vector3<f64> {
        input - self.low_pass()
    }

    /// The first integral of the high-pass, s^(n-1)/D of the input.
    pub fn first_integral(&self) -> Vector3<f64> {
        self.state(0)
    }

    /// The second integral of the high-pass, s^(n-2)/D of the input.
    pub fn second_integral(&self) -> Vector3<f64> {
        self.state(1)
    }

    /// Sets the first and the second integral of the high-pass.
    pub fn set_integrals(&mut self, first: &Vector3<f64>, second: &Vector3<f64>) {
        for (k, state) in self.states.iter_mut().enumerate() {
            let state = state.as_array_mut();
            (state[0], state[1]) = (first[k], second[k]);
        }
    }

    /// Sets the first integral of the high-pass.
    pub fn set_first_integral(&mut self, first: &Vector3<f64>) {
        for (k, state) in self.states.iter_mut().enumerate() {
            state.as_array_mut()[0] = first[k];
        }
    }

    /// Only the last term of the low-pass, cn/D of the input: a low-pass without
    /// zeros, for an order of 2.
    pub fn all_pole_low_pass(&self) -> Vector3<f64> {
        Vector3::from_fn(|k, _| {
            let Denominator { coefficients, order } = self.denominators[k];
            (coefficients * self.states[k]).to_array()[order - 1]
        })
    }

    /// State i of each axis.
    fn state(&self, i: usize) -> Vector3<f64> {
        Vector3::from_fn(|k, _| self.states[k].as_array_ref()[i])
    }

    /// Changes the coefficients, keeping the first `kept` states and every later term of the
    /// low-pass as they are.
    ///
    /// The first states make up the platform's motion and are kept. The later ones are memory only.
    /// Later states are rescaled so that what the filter has already washed out stays so.
    pub fn retune(&mut self, denominators: [Denominator; 3], kept: usize) {
        for ((old, new), state) in self.denominators.iter().zip(&denominators).zip(&mut self.states) {
            for i in kept..new.order {
                state.as_array_mut()[i] *= old.coefficients.as_array_ref()[i] / new.coefficients.as_array_ref()[i];
            }
        }
        if denominators != self.denominators {
            self.denominators = denominators;
            // There are no transitions for these yet: the next step computes them.
            self.step = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, Matrix6};

    use super::*;

    /// exp(A) of A = D(decay) + R(angle), whose closed form needs up to seven squarings here.
    #[test]
    fn the_exponential_of_a_decaying_rotation_is_its_closed_form() {
        for (decay, angle) in [(0.0_f64, 1e-9_f64), (0.001, 0.3), (0.7, 1.1), (3.0, 7.0), (-2.0, 50.0)] {
            let found = matrix_exponential(&Matrix2::new(-decay, -angle, angle, -decay));
            let expected = (-decay).exp() * Matrix2::new(angle.cos(), -angle.sin(), angle.sin(), angle.cos());
            let error = (found - expected).norm() / expected.norm();
            assert!(error < 1e-15 * (1.0 + angle), "{error} at {decay}, {angle}");
        }
    }

    #[test]
    fn the_exponential_of_integrators_is_the_powers_of_time() {
        let time = 0.001;
        let found = matrix_exponential(&Matrix6::from_fn(|i, j| if i == j + 1 { time } else { 0.0 }));
        let mut expected = 1.0;
        for k in 0..6 {
            let error: f64 = found[(k, 0)] / expected - 1.0;
            assert!(error.abs() < 1e-15, "{error} at the power {k}");
            expected *= time / (k + 1) as f64;
        }
    }

    #[test]
    fn the_exponential_is_that_of_another_implementation() {
        for (omega, zeta, step) in [(0.3, 0.7, 0.001), (2.0, 1.0, 0.001), (40.0, 0.1, 0.01), (200.0, 2.0, 0.01)] {
            let mut matrix = Matrix6::zeros();
            for (k, c) in Denominator::new(4, omega, zeta, 0.1 * omega, 1.0).coefficients.to_array().iter().enumerate()
            {
                matrix[(0, k)] = -c;
            }
            for [i, j] in [[1, 0], [2, 1], [3, 2], [0, 4], [4, 5]] {
                matrix[(i, j)] = 1.0;
            }
            let (found, expected) = (matrix_exponential(&(matrix * step)), (matrix * step).exp());
            let error = (found - expected).norm() / expected.norm();
            // Rounding of the matrix changes its exponential by as much.
            assert!(error < 1e-15 * (1.0 + (matrix * step).norm()), "{error} at {omega}, {zeta}, {step}");
        }
    }
}
