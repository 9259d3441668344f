//! The program's solver: a primal-dual interior-point method (Mehrotra's predictor and corrector)
//! whose steps are found by a Riccati recursion, in a time that is proportional to the number of
//! intervals.
//!
//! Rest at neutral lies strictly within all limits, so the method starts there, and every iterate
//! keeps the limits. See Nocedal and Wright, Numerical Optimization, 2nd edition, section 16.6, for
//! the method, and Rao, Wright and Rawlings, J. Optim. Theory Appl. 99 (1998), for the recursion.

use super::barrier::{Bounded, Multipliers};
use super::certificate;
use super::program::{Program, Rows};
use super::small_matrix::{
    add, backward_substitute, cholesky, forward_substitute, forward_substitute_columns, product, transposed_product,
};

/// A motion within the limits, and multipliers.
pub struct Solution<const N: usize, const U: usize, const E: usize> {
    /// The states at the intervals' ends, the first at rest.
    pub states: Vec<[f64; N]>,
    pub inputs: Vec<[f64; U]>,
    pub multipliers: Vec<IntervalMultipliers<N, U, E>>,
}

/// Multipliers of an interval: of the state at its end, its inputs, and its further values.
#[derive(Clone, Copy, Debug)]
pub struct IntervalMultipliers<const N: usize, const U: usize, const E: usize> {
    pub states: Multipliers<N>,
    pub inputs: Multipliers<U>,
    pub limits: Multipliers<E>,
}

/// Why no solution was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotSolved {
    /// Best value found.
    pub value: f64,
    /// Lower bound of all values.
    pub least: f64,
}

/// The same for values near 0, for an interval \[(m/s2)^2\].
const ABSOLUTE_GAP: f64 = 1e-10;

/// The recursion's result for an interval: with the state's change x, the best input's change
/// solves L' u = -(gain x + offset).
#[derive(Clone, Copy)]
struct Feedback<const N: usize, const U: usize> {
    /// Cholesky factor of the inputs' Hessian, with the inverse of its diagonal.
    factor: [[f64; U]; U],
    gain: [[f64; N]; U],
    offset: [f64; U],
}

/// A change of all states and inputs.
struct Change<const N: usize, const U: usize> {
    states: Vec<[f64; N]>,
    inputs: Vec<[f64; U]>,
}

/// The solution of the program.
///
/// # Errors
/// The value does not come near its lower bound.
pub fn solve<const N: usize, const U: usize, const E: usize>(
    program: &Program<N, U, E>,
) -> Result<Solution<N, U, E>, NotSolved> {
    // Iterations after which the solver gives up. Rides take 10 to 50.
    const MOST_ITERATIONS: usize = 200;
    solve_within(program, MOST_ITERATIONS)
}

fn solve_within<const N: usize, const U: usize, const E: usize>(
    program: &Program<N, U, E>,
    most_iterations: usize,
) -> Result<Solution<N, U, E>, NotSolved> {
    // Distances this many times as large are accepted where rounding prevents smaller ones.
    const ACCEPTED_GAP_FACTOR: f64 = 1000.0;
    // Part of the way to the nearest limit that a step goes.
    const TO_THE_LIMIT: f64 = 0.98;
    let intervals = program.desired.len();
    let limits = 2 * (N + U + E) * intervals;
    let mut solver = Solver::at_rest(program);
    for _ in 0..most_iterations {
        let products = solver.sum_of_products();
        let tolerance = solver.tolerance();
        if products <= tolerance && solver.gap() <= tolerance {
            return Ok(solver.solution);
        }
        let uncentred = solver.uncentred_step();
        let part = TO_THE_LIMIT.min(TO_THE_LIMIT / solver.largest_uncentred_decrease(&uncentred));
        let left = (1.0 - part) * products + part * part * solver.sum_of_uncentred_products(&uncentred);
        let target = (left / products).powi(3) * products / limits as f64;
        let change = solver.centred_step(&uncentred, target);
        let part = TO_THE_LIMIT.min(TO_THE_LIMIT / solver.largest_decrease(&change, &uncentred, target));
        if !change.is_finite() || !target.is_finite() {
            break;
        }
        solver.go(part, &change, &uncentred, target);
    }
    let (value, gap) = (solver.value(), solver.gap());
    if gap <= ACCEPTED_GAP_FACTOR * solver.tolerance() {
        Ok(solver.solution)
    } else {
        Err(NotSolved { value, least: value - gap })
    }
}

impl<const N: usize, const U: usize> Change<N, U> {
    fn is_finite(&self) -> bool {
        self.states.iter().flatten().chain(self.inputs.iter().flatten()).all(|value| value.is_finite())
    }
}

struct Solver<'a, const N: usize, const U: usize, const E: usize> {
    program: &'a Program<N, U, E>,
    solution: Solution<N, U, E>,
    feedback: Vec<Feedback<N, U>>,
}

/// The limits of an interval.
struct Limits<'a, const N: usize, const U: usize, const E: usize> {
    states: Bounded<'a, N>,
    inputs: Bounded<'a, U>,
    limits: Bounded<'a, E>,
}

impl<'a, const N: usize, const U: usize, const E: usize> Solver<'a, N, U, E> {
    fn at_rest(program: &'a Program<N, U, E>) -> Self {
        let intervals = program.desired.len();
        let value = 0.5 * program.desired.iter().flatten().map(|force| force * force).sum::<f64>();
        let product = (value / intervals as f64).max(ABSOLUTE_GAP) / (2 * (N + U + E)) as f64;
        let multipliers = IntervalMultipliers {
            states: Multipliers::at_rest(&program.states, product),
            inputs: Multipliers::at_rest(&program.inputs, product),
            limits: Multipliers::at_rest(&program.limits, product),
        };
        let solution = Solution {
            states: vec![[0.0; N]; intervals + 1],
            inputs: vec![[0.0; U]; intervals],
            multipliers: vec![multipliers; intervals],
        };
        let none = Feedback { factor: [[0.0; U]; U], gain: [[0.0; N]; U], offset: [0.0; U] };
        Solver { program, solution, feedback: vec![none; intervals] }
    }

    fn error(&self, k: usize) -> [f64; 2] {
        self.program.error(k, &self.solution.states[k], &self.solution.inputs[k])
    }

    fn value(&self) -> f64 {
        0.5 * (0..self.feedback.len()).flat_map(|k| self.error(k)).map(|error| error * error).sum::<f64>()
    }

    fn tolerance(&self) -> f64 {
        // Largest distance of the value from its lower bound, as a fraction of the value.
        const RELATIVE_GAP: f64 = 1e-6;
        RELATIVE_GAP * self.value() + ABSOLUTE_GAP * self.feedback.len() as f64
    }

    /// Distance of the value from its lower bound.
    fn gap(&self) -> f64 {
        self.value() - certificate::lower_bound(self.program, &self.solution)
    }

    fn limits(&self, k: usize) -> Limits<'_, N, U, E> {
        let Solution { states, inputs, multipliers } = &self.solution;
        let (program, multipliers) = (self.program, &multipliers[k]);
        let further = program.limited.of(&states[k], &inputs[k]);
        Limits {
            states: Bounded { range: &program.states, values: states[k + 1], multipliers: &multipliers.states },
            inputs: Bounded { range: &program.inputs, values: inputs[k], multipliers: &multipliers.inputs },
            limits: Bounded { range: &program.limits, values: further, multipliers: &multipliers.limits },
        }
    }

    /// Changes of the values that have limits.
    fn changes(&self, k: usize, change: &Change<N, U>) -> ([f64; N], [f64; U], [f64; E]) {
        let (states, inputs) = (&change.states, &change.inputs);
        (states[k + 1], inputs[k], self.program.limited.of(&states[k], &inputs[k]))
    }

    fn sum_of_products(&self) -> f64 {
        let of = |k| {
            let Limits { states, inputs, limits } = self.limits(k);
            states.products() + inputs.products() + limits.products()
        };
        (0..self.feedback.len()).map(of).sum()
    }

    fn sum_of_uncentred_products(&self, change: &Change<N, U>) -> f64 {
        let of = |k| {
            let Limits { states, inputs, limits } = self.limits(k);
            let (state, input, limit) = self.changes(k, change);
            states.uncentred_products(&state) + inputs.uncentred_products(&input) + limits.uncentred_products(&limit)
        };
        (0..self.feedback.len()).map(of).sum()
    }

    fn largest_uncentred_decrease(&self, change: &Change<N, U>) -> f64 {
        let of = |k| {
            let Limits { states, inputs, limits } = self.limits(k);
            let (state, input, limit) = self.changes(k, change);
            let decreases = [
                states.uncentred_decrease(&state),
                inputs.uncentred_decrease(&input),
                limits.uncentred_decrease(&limit),
            ];
            decreases.into_iter().fold(0.0, f64::max)
        };
        (0..self.feedback.len()).map(of).fold(0.0, f64::max)
    }

    fn largest_decrease(&self, change: &Change<N, U>, uncentred: &Change<N, U>, target: f64) -> f64 {
        let of = |k| {
            let Limits { states, inputs, limits } = self.limits(k);
            let (state, input, limit) = self.changes(k, change);
            let before = self.changes(k, uncentred);
            let decreases = [
                states.decrease(&state, &before.0, target),
                inputs.decrease(&input, &before.1, target),
                limits.decrease(&limit, &before.2, target),
            ];
            decreases.into_iter().fold(0.0, f64::max)
        };
        (0..self.feedback.len()).map(of).fold(0.0, f64::max)
    }

    /// Goes a part of the step.
    fn go(&mut self, part: f64, change: &Change<N, U>, uncentred: &Change<N, U>, target: f64) {
        // From the last interval on: the multipliers of each need its state before the step.
        for k in (0..self.feedback.len()).rev() {
            let (state, input, limit) = self.changes(k, change);
            let before = self.changes(k, uncentred);
            let Limits { states, inputs, limits } = self.limits(k);
            let multipliers = IntervalMultipliers {
                states: states.stepped(part, &state, &before.0, target),
                inputs: inputs.stepped(part, &input, &before.1, target),
                limits: limits.stepped(part, &limit, &before.2, target),
            };
            self.solution.multipliers[k] = multipliers;
            add(&mut self.solution.states[k + 1], part, &state);
            add(&mut self.solution.inputs[k], part, &input);
        }
    }

    /// The step that aims at products of 0: factorises on the way.
    fn uncentred_step(&mut self) -> Change<N, U> {
        // Added to the inputs' Hessian: without it, rounding may take an input's curvature below 0.
        // The solution is the same, because a step's gradient is exact.
        const HESSIAN_REGULARISATION: f64 = 1e-11;
        let Rows { of_state: a, of_input: b } = &self.program.motion;
        let (felt, limited) = (&self.program.felt, &self.program.limited);
        let (mut hessian, mut gradient) = ([[0.0; N]; N], [0.0; N]);
        for k in (0..self.feedback.len()).rev() {
            let Limits { states, inputs, limits } = self.limits(k);
            let (of_states, of_inputs, of_limits) = (states.weights(), inputs.weights(), limits.weights());
            for (n, weight) in of_states.iter().enumerate() {
                hessian[n][n] += weight;
            }
            let (ha, hb) = (product(&hessian, a), product(&hessian, b));
            let mut xx = transposed_product(a, &ha);
            let mut ux = transposed_product(b, &ha);
            let mut uu = transposed_product(b, &hb);
            add_squares(felt, &[1.0; 2], &mut xx, &mut ux, &mut uu);
            add_squares(limited, &of_limits, &mut xx, &mut ux, &mut uu);
            for (n, weight) in of_inputs.iter().enumerate() {
                uu[n][n] += weight + HESSIAN_REGULARISATION;
            }
            let (mut x, mut u) = ([0.0; N], [0.0; U]);
            self.program.motion.add_transposed(&gradient, &mut x, &mut u);
            felt.add_transposed(&self.error(k), &mut x, &mut u);
            let factor = cholesky(uu);
            let mut gain = ux;
            forward_substitute_columns(&factor, &mut gain);
            forward_substitute(&factor, &mut u);
            for (row, offset) in gain.iter().zip(&u) {
                for i in 0..N {
                    x[i] -= row[i] * offset;
                    for j in 0..N {
                        xx[i][j] -= row[i] * row[j];
                    }
                }
            }
            self.feedback[k] = Feedback { factor, gain, offset: u };
            hessian = std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (xx[i][j] + xx[j][i])));
            gradient = x;
        }
        self.roll_out()
    }

    /// The step that aims at products of `target`, with the last factors.
    fn centred_step(&mut self, uncentred: &Change<N, U>, target: f64) -> Change<N, U> {
        let program = self.program;
        let mut gradient = [0.0; N];
        for k in (0..self.feedback.len()).rev() {
            let before = self.changes(k, uncentred);
            let Limits { states, inputs, limits } = self.limits(k);
            add(&mut gradient, 1.0, &states.gradient(&before.0, target));
            let (mut x, mut u) = ([0.0; N], inputs.gradient(&before.1, target));
            program.limited.add_transposed(&limits.gradient(&before.2, target), &mut x, &mut u);
            program.motion.add_transposed(&gradient, &mut x, &mut u);
            program.felt.add_transposed(&self.error(k), &mut x, &mut u);
            let Feedback { factor, gain, offset } = &mut self.feedback[k];
            forward_substitute(factor, &mut u);
            for (row, u) in gain.iter().zip(&u) {
                add(&mut x, -u, row);
            }
            *offset = u;
            gradient = x;
        }
        self.roll_out()
    }

    /// The change of all states and inputs under the feedback.
    fn roll_out(&self) -> Change<N, U> {
        let mut states = Vec::with_capacity(self.feedback.len() + 1);
        let mut state = [0.0; N];
        states.push(state);
        let mut follow = |Feedback { factor, gain, offset }: &Feedback<N, U>| {
            let mut input: [f64; U] =
                std::array::from_fn(|u| -offset[u] - gain[u].iter().zip(&state).map(|(g, x)| g * x).sum::<f64>());
            backward_substitute(factor, &mut input);
            state = self.program.motion.of(&state, &input);
            states.push(state);
            input
        };
        let inputs = self.feedback.iter().map(&mut follow).collect();
        Change { states, inputs }
    }
}

/// Adds the weighted squares of the rows to the Hessian's blocks.
fn add_squares<const N: usize, const U: usize, const R: usize>(
    rows: &Rows<N, U, R>,
    weights: &[f64; R],
    xx: &mut [[f64; N]; N],
    ux: &mut [[f64; N]; U],
    uu: &mut [[f64; U]; U],
) {
    for ((of_state, of_input), weight) in rows.of_state.iter().zip(&rows.of_input).zip(weights) {
        for n in 0..N {
            add(&mut xx[n], weight * of_state[n], of_state);
        }
        for n in 0..U {
            add(&mut ux[n], weight * of_input[n], of_state);
            add(&mut uu[n], weight * of_input[n], of_input);
        }
    }
}

#[cfg(test)]
mod tests;
