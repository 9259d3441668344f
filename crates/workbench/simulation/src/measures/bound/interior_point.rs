//! The program's solver: a primal-dual interior-point method (Mehrotra's predictor and corrector)
//! whose steps are found by a Riccati recursion, in a time that is proportional to the number of
//! intervals.
//!
//! Rest at neutral lies strictly within all limits, so the method starts there, and every iterate
//! keeps the limits. See Nocedal and Wright, Numerical Optimization, 2nd edition, section 16.6, for
//! the method, and Rao, Wright and Rawlings, J. Optim. Theory Appl. 99 (1998), for the recursion.

use nalgebra::{Cholesky, SMatrix, SVector};

use super::certificate;
use super::limits::Limits;
use super::program::{Program, Rows};

/// A motion within the limits, and multipliers.
pub struct Solution<const N: usize, const U: usize, const R: usize> {
    /// The states at the intervals' ends, the first at rest.
    pub states: Vec<SVector<f64, N>>,
    pub inputs: Vec<SVector<f64, U>>,
    /// Multipliers of each interval's lower and upper limits.
    pub multipliers: Vec<[SVector<f64, R>; 2]>,
}

/// Why no solution was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotSolved {
    /// Best value found.
    pub value: f64,
    /// Lower bound of all values.
    pub least: f64,
}

/// The recursion's result for an interval: with the state's change x, the best input's change
/// solves L' u = -(gain x + offset).
#[derive(Clone, Copy)]
struct Feedback<const N: usize, const U: usize> {
    /// Cholesky factor L of the inputs' Hessian; what is above its diagonal has no meaning.
    factor: SMatrix<f64, U, U>,
    gain: SMatrix<f64, U, N>,
    offset: SVector<f64, U>,
}

/// A change of all states and inputs, and of the values that have limits.
struct Change<const N: usize, const U: usize, const R: usize> {
    states: Vec<SVector<f64, N>>,
    inputs: Vec<SVector<f64, U>>,
    limited: Vec<SVector<f64, R>>,
}

/// The solution of the program.
///
/// # Errors
/// The value does not come near its lower bound.
pub fn solve<const N: usize, const U: usize, const R: usize>(
    program: &Program<N, U, R>,
) -> Result<Solution<N, U, R>, NotSolved> {
    // Iterations after which the solver gives up. Rides take 10 to 50.
    const MOST_ITERATIONS: usize = 200;
    solve_within(program, MOST_ITERATIONS)
}

fn solve_within<const N: usize, const U: usize, const R: usize>(
    program: &Program<N, U, R>,
    most_iterations: usize,
) -> Result<Solution<N, U, R>, NotSolved> {
    // Distances this many times as large are accepted where rounding prevents smaller ones.
    const ACCEPTED_GAP_FACTOR: f64 = 1000.0;
    // Part of the way to the nearest limit that a step goes.
    const TO_THE_LIMIT: f64 = 0.98;
    let intervals = program.desired.len();
    let no_aims = vec![[SVector::zeros(); 2]; intervals];
    let mut solver = Solver::at_rest(program);
    for _ in 0..most_iterations {
        let limits = solver.limits();
        let products: f64 = limits.iter().map(Limits::products).sum();
        let tolerance = solver.tolerance();
        if products <= tolerance && solver.gap() <= tolerance {
            return Ok(solver.solution);
        }
        let part = |change: &Change<N, U, R>, aims: &[[SVector<f64, R>; 2]]| {
            let steps = limits.iter().zip(&change.limited).zip(aims);
            let decreases = steps.map(|((limits, change), aims)| limits.largest_decrease(change, aims));
            TO_THE_LIMIT.min(TO_THE_LIMIT / decreases.fold(0.0, f64::max))
        };
        solver.factorise(&limits);
        let uncentred = solver.step(&limits, &no_aims);
        let uncentred_part = part(&uncentred, &no_aims);
        // Mehrotra's corrector takes these products off the target.
        let mut aims: Vec<_> =
            limits.iter().zip(&uncentred.limited).map(|(limits, change)| limits.uncentred_products(change)).collect();
        let left = (1.0 - uncentred_part) * products
            + uncentred_part.powi(2) * aims.iter().flatten().map(SVector::sum).sum::<f64>();
        let target = (left / products).powi(3) * products / (2 * R * intervals) as f64;
        aims.iter_mut().flatten().for_each(|aim| *aim = -aim.add_scalar(-target));
        let change = solver.step(&limits, &aims);
        let part = part(&change, &aims);
        if !target.is_finite() || !change.limited.iter().flatten().all(|value| value.is_finite()) {
            break;
        }
        solver.advance(part, &change, &limits, &aims);
    }
    let (value, gap) = (solver.value(), solver.gap());
    if gap <= ACCEPTED_GAP_FACTOR * solver.tolerance() {
        Ok(solver.solution)
    } else {
        Err(NotSolved { value, least: value - gap })
    }
}

/// Largest distance of a value near 0 from its lower bound, for an interval \[(m/s2)^2\].
const ABSOLUTE_GAP: f64 = 1e-10;

struct Solver<'a, const N: usize, const U: usize, const R: usize> {
    program: &'a Program<N, U, R>,
    motion: Rows<N, U, N>,
    solution: Solution<N, U, R>,
    feedback: Vec<Feedback<N, U>>,
}

impl<'a, const N: usize, const U: usize, const R: usize> Solver<'a, N, U, R> {
    /// All products of slack and multiplier are the same.
    fn at_rest(program: &'a Program<N, U, R>) -> Self {
        let intervals = program.desired.len();
        let value = 0.5 * program.desired.iter().map(SVector::norm_squared).sum::<f64>();
        let product = (value / intervals as f64).max(ABSOLUTE_GAP) / (2 * R) as f64;
        let multipliers = [program.min.map(|min| product / -min), program.max.map(|max| product / max)];
        let solution = Solution {
            states: vec![SVector::zeros(); intervals + 1],
            inputs: vec![SVector::zeros(); intervals],
            multipliers: vec![multipliers; intervals],
        };
        let none = Feedback { factor: SMatrix::zeros(), gain: SMatrix::zeros(), offset: SVector::zeros() };
        Solver { program, motion: program.motion(), solution, feedback: vec![none; intervals] }
    }

    fn error(&self, k: usize) -> SVector<f64, 2> {
        self.program.error(k, &self.solution.states[k], &self.solution.inputs[k])
    }

    fn value(&self) -> f64 {
        0.5 * (0..self.feedback.len()).map(|k| self.error(k).norm_squared()).sum::<f64>()
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

    fn limits(&self) -> Vec<Limits<R>> {
        let Solution { states, inputs, multipliers } = &self.solution;
        let of = |k: usize| {
            let values = self.program.limited.of(&states[k], &inputs[k]);
            Limits { slacks: [values - self.program.min, self.program.max - values], multipliers: multipliers[k] }
        };
        (0..inputs.len()).map(of).collect()
    }

    /// The factors of the step's equations, from the last interval to the first.
    fn factorise(&mut self, limits: &[Limits<R>]) {
        // Added to the inputs' Hessian: without it, rounding may take an input's curvature below 0.
        // The solution is the same, because a step's gradient is exact.
        const HESSIAN_REGULARISATION: f64 = 1e-11;
        let Program { felt, limited, .. } = self.program;
        let Rows { of_state: a, of_input: b } = &self.motion;
        let mut hessian = SMatrix::<f64, N, N>::zeros();
        for (k, limits) in limits.iter().enumerate().rev() {
            let (mut of_state, mut of_input) = (limited.of_state, limited.of_input);
            for (row, weight) in limits.weights().iter().enumerate() {
                of_state.row_mut(row).scale_mut(*weight);
                of_input.row_mut(row).scale_mut(*weight);
            }
            let (ha, hb) = (hessian * a, hessian * b);
            let xx = a.tr_mul(&ha) + felt.of_state.tr_mul(&felt.of_state) + limited.of_state.tr_mul(&of_state);
            let ux = b.tr_mul(&ha) + felt.of_input.tr_mul(&felt.of_state) + limited.of_input.tr_mul(&of_state);
            let uu = b.tr_mul(&hb) + felt.of_input.tr_mul(&felt.of_input) + limited.of_input.tr_mul(&of_input);
            let uu = uu + SMatrix::identity() * HESSIAN_REGULARISATION;
            let factor = factor(uu);
            let gain = factor.solve_lower_triangular_unchecked(&ux);
            let xx = xx - gain.tr_mul(&gain);
            hessian = 0.5 * (xx + xx.transpose());
            self.feedback[k] = Feedback { factor, gain, offset: SVector::zeros() };
        }
    }

    /// The step that aims at these products, with the last factors.
    fn step(&mut self, limits: &[Limits<R>], aims: &[[SVector<f64, R>; 2]]) -> Change<N, U, R> {
        let Program { felt, limited, .. } = self.program;
        let mut gradient = SVector::<f64, N>::zeros();
        for k in (0..limits.len()).rev() {
            let error = self.error(k);
            let of_limits = limits[k].gradient(&aims[k]);
            let of = [self.motion.weighted(&gradient), felt.weighted(&error), limited.weighted(&of_limits)];
            let u = of.iter().map(|(_, of_input)| of_input).sum::<SVector<f64, U>>();
            let Feedback { factor, gain, offset } = &mut self.feedback[k];
            *offset = factor.solve_lower_triangular_unchecked(&u);
            gradient = of.iter().map(|(of_state, _)| of_state).sum::<SVector<f64, N>>() - gain.tr_mul(offset);
        }
        let mut change = Change { states: vec![SVector::zeros()], inputs: Vec::new(), limited: Vec::new() };
        let mut state = SVector::zeros();
        for Feedback { factor, gain, offset } in &self.feedback {
            let input = factor.tr_solve_lower_triangular_unchecked(&-(gain * state + offset));
            change.limited.push(limited.of(&state, &input));
            state = self.motion.of(&state, &input);
            change.states.push(state);
            change.inputs.push(input);
        }
        change
    }

    /// Goes a part of the step.
    fn advance(&mut self, part: f64, change: &Change<N, U, R>, limits: &[Limits<R>], aims: &[[SVector<f64, R>; 2]]) {
        let Solution { states, inputs, multipliers } = &mut self.solution;
        states.iter_mut().zip(&change.states).for_each(|(state, change)| *state += part * change);
        inputs.iter_mut().zip(&change.inputs).for_each(|(input, change)| *input += part * change);
        for (k, multipliers) in multipliers.iter_mut().enumerate() {
            let steps = limits[k].multiplier_steps(&change.limited[k], &aims[k]);
            multipliers.iter_mut().zip(steps).for_each(|(multipliers, step)| *multipliers += part * step);
        }
    }
}

/// The lower factor of a matrix that rounding alone can make indefinite.
fn factor<const U: usize>(matrix: SMatrix<f64, U, U>) -> SMatrix<f64, U, U> {
    // Least pivot, as a part of the largest element of the diagonal.
    const PIVOT_ROUNDING: f64 = 1e-14;
    let pivot = PIVOT_ROUNDING * matrix.diagonal().max();
    Cholesky::new_with_substitute(matrix, pivot).map_or(matrix, Cholesky::unpack_dirty)
}

#[cfg(test)]
mod tests;
