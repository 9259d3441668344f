//! A dual active-set solver for small dense strictly convex quadratic programs.
//!
//! Minimizes u'Hu/2 + g'u subject to lower <= C u <= upper. The method is that of Goldfarb and
//! Idnani, *A numerically stable dual method for solving strictly convex quadratic programs*,
//! Mathematical Programming 27 (1983) 1-33, for two-sided rows. The method starts at the
//! unconstrained minimum, so that no feasible start is needed, and adds one violated row after the
//! other. Each iterate is the minimum under its active rows.
//!
//! With N the normals of the active rows, the method keeps J and the upper triangular R of
//!
//! ```text
//!     H = L L',   L^-1 N = Q [R; 0],   J = L^-T Q
//! ```
//!
//! A row is added by one Householder reflection of J's last columns and dropped by Givens
//! rotations.
//!
//! The solver's state is plain data of a fixed size: a solve can be interrupted after any
//! iteration, stored, and continued.

use core::ops::Range;

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::motion::square_root::square_root;

#[cfg(test)]
pub(crate) mod tests;

/// The rows lower <= C u <= upper of a quadratic program.
pub trait Rows<const N: usize, const M: usize> {
    /// Shows each row's value at a point to a search.
    fn evaluate(&self, point: &SVector<f64, N>, search: &mut Search<M>);

    /// Sets `normal`, which is zero before, to a row of C.
    fn set_normal(&self, row: usize, normal: &mut SVector<f64, N>);

    /// The lower and the upper bounds.
    fn bounds(&self) -> [&SVector<f64, M>; 2];
}

/// A search for the row that is violated most.
#[derive(Clone, Debug)]
pub struct Search<'a, const M: usize> {
    lower: &'a SVector<f64, M>,
    upper: &'a SVector<f64, M>,
    given_up: &'a SVector<bool, M>,
    worst: f64,
    found: Option<PendingRow>,
}

impl<const M: usize> Search<'_, M> {
    /// Sees a row's value.
    #[inline(always)]
    pub fn see(&mut self, row: usize, value: f64) {
        let (below, above) = (self.lower[row] - value, value - self.upper[row]);
        let violation = if below > above { below } else { above };
        if violation > self.worst && !self.given_up[row] {
            let side = if below > above { 1.0 } else { -1.0 };
            self.worst = violation;
            self.found = Some(PendingRow { row: row as u32, side, multiplier: 0.0 });
        }
    }
}

/// The state of a solve with N variables and M rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DualActiveSet<const N: usize, const M: usize> {
    solution: SVector<f64, N>,
    /// J: its first `active` columns belong to the active rows.
    factor: SMatrix<f64, N, N>,
    /// R, in its first `active` columns.
    triangle: SMatrix<f64, N, N>,
    /// Multiplier of each active row, in the order of R's columns.
    multipliers: SVector<f64, N>,
    active: usize,
    /// The violated row that is being added.
    pending: Option<PendingRow>,
    /// True for each row that no point satisfies together with the active rows; it is dropped.
    given_up: SVector<bool, M>,
    status: Status,
    iterations: u32,
}

/// A row beyond one of its bounds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct PendingRow {
    row: u32,
    /// 1 at the lower bound, -1 at the upper one: the row's normal times this points inwards.
    side: f64,
    multiplier: f64,
}

/// The state of a solve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// More iterations are needed.
    #[default]
    Running,
    /// All rows hold but those given up, of which there are [`DualActiveSet::given_up`].
    Solved,
    /// The solution is not a number.
    Failed,
}

/// A row is violated beyond this; rows are to be scaled to bounds of about 1.
const FEASIBILITY_TOLERANCE: f64 = 1e-10;
/// A row whose normal lies in the active rows' span to this fraction depends on them.
const DEPENDENCE_TOLERANCE: f64 = 1e-11;

impl<const N: usize, const M: usize> Default for DualActiveSet<N, M> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize, const M: usize> DualActiveSet<N, M> {
    /// An empty solve, solved at zero.
    pub fn new() -> Self {
        DualActiveSet {
            solution: SVector::zeros(),
            factor: SMatrix::zeros(),
            triangle: SMatrix::zeros(),
            multipliers: SVector::zeros(),
            active: 0,
            pending: None,
            given_up: SVector::repeat(false),
            status: Status::Solved,
            iterations: 0,
        }
    }

    /// Begins a solve at the unconstrained minimum; `factor` is L^-T of H = L L'.
    pub fn start(&mut self, factor: &SMatrix<f64, N, N>, gradient: &SVector<f64, N>) {
        self.factor.copy_from(factor);
        self.solution.fill(0.0);
        for column in columns(factor) {
            let used = span(column);
            let part = -dot(&column[used.clone()], &gradient.as_slice()[used.clone()]);
            add_scaled(&mut self.solution.as_mut_slice()[used.clone()], part, &column[used]);
        }
        self.active = 0;
        self.pending = None;
        self.given_up.fill(false);
        self.status = Status::Running;
        self.iterations = 0;
    }

    /// Abandons the solve.
    pub fn abandon(&mut self) {
        self.status = Status::Failed;
        self.pending = None;
        self.active = 0;
    }

    /// Continues with at most so many iterations. The rows must be those of the iterations before.
    pub fn advance(&mut self, rows: &impl Rows<N, M>, iterations: u32) -> Status {
        for _ in 0..iterations {
            if self.status != Status::Running {
                break;
            }
            self.iterate(rows);
        }
        self.status
    }

    /// The point reached: the solution once the solve is done.
    pub fn solution(&self) -> &SVector<f64, N> {
        &self.solution
    }

    /// The state of the solve.
    pub fn status(&self) -> Status {
        self.status
    }

    /// Number of iterations of this solve so far.
    pub fn iterations(&self) -> u32 {
        self.iterations
    }

    /// Number of rows given up: zero if and only if the rows can be satisfied together.
    pub fn given_up(&self) -> usize {
        self.given_up.iter().filter(|&&given_up| given_up).count()
    }

    /// One step of the method: to the point where the pending row holds, or where an active
    /// row's multiplier vanishes.
    fn iterate(&mut self, rows: &impl Rows<N, M>) {
        let Some(mut pending) = self.pending.take().or_else(|| self.most_violated(rows)) else {
            let finite = self.solution.iter().all(|value| value.is_finite());
            self.status = if finite { Status::Solved } else { Status::Failed };
            return;
        };
        self.iterations += 1;
        let row = pending.row as usize;
        if row >= M || self.active > N {
            // No solve leads here, but a deserialized state may.
            self.status = Status::Failed;
            return;
        }
        let mut normal = SVector::<f64, N>::zeros();
        rows.set_normal(row, &mut normal);
        let mut projection = SVector::<f64, N>::zeros();
        self.project(normal.as_slice(), pending.side, projection.as_mut_slice());
        let mut change = SVector::<f64, N>::zeros();
        self.set_multiplier_change(projection.as_slice(), change.as_mut_slice());
        let (blocking, longest) = self.blocking(change.as_slice());

        let free_squared = sum_of_squares(&projection.as_slice()[self.active..]);
        let independent =
            free_squared > DEPENDENCE_TOLERANCE * DEPENDENCE_TOLERANCE * sum_of_squares(projection.as_slice());
        let (value, [lower, upper]) = (dot(normal.as_slice(), self.solution.as_slice()), rows.bounds());
        let violation = if pending.side > 0.0 { lower[row] - value } else { value - upper[row] };
        let full = if independent { violation / free_squared } else { f64::INFINITY };
        let step = if longest < full { longest } else { full };
        if step == f64::INFINITY {
            self.given_up[row] = true;
            return;
        }
        let mut direction = SVector::<f64, N>::zeros();
        if independent {
            for (column, &part) in columns(&self.factor).zip(projection.as_slice()).skip(self.active) {
                add_scaled(direction.as_mut_slice(), part, column);
            }
            add_scaled(self.solution.as_mut_slice(), step, direction.as_slice());
        }
        for k in 0..self.active {
            self.multipliers[k] = (self.multipliers[k] - step * change[k]).max(0.0);
        }
        pending.multiplier += step;
        if step == full {
            self.add(pending, projection.as_slice(), free_squared, direction.as_mut_slice());
        } else {
            self.drop_row(blocking);
            self.pending = Some(pending);
        }
    }

    /// The row violated most, if any is.
    fn most_violated(&self, rows: &impl Rows<N, M>) -> Option<PendingRow> {
        let [lower, upper] = rows.bounds();
        let mut search = Search { lower, upper, given_up: &self.given_up, worst: FEASIBILITY_TOLERANCE, found: None };
        rows.evaluate(&self.solution, &mut search);
        search.found
    }

    /// Sets `projection` to J' times a row's normal, which points inwards on this side.
    fn project(&self, normal: &[f64], side: f64, projection: &mut [f64]) {
        let used = span(normal);
        let normal = &normal[used.clone()];
        for (value, column) in projection.iter_mut().zip(columns(&self.factor)) {
            *value = side * dot(&column[used.clone()], normal);
        }
    }

    /// Sets `change` to R^-1 of the projection's first part: how the active rows' multipliers fall
    /// as the pending one's grows.
    fn set_multiplier_change(&self, projection: &[f64], change: &mut [f64]) {
        let change = &mut change[..self.active];
        change.copy_from_slice(&projection[..self.active]);
        let columns = self.triangle.as_slice().as_chunks::<N>().0;
        for (k, column) in columns[..self.active].iter().enumerate().rev() {
            change[k] /= column[k];
            let (before, value) = change[..k + 1].split_at_mut(k);
            add_scaled(before, -value[0], &column[..k]);
        }
    }

    /// The active row whose multiplier vanishes first, and the step at which it does.
    fn blocking(&self, change: &[f64]) -> (usize, f64) {
        let (mut first, mut shortest) = (0, f64::INFINITY);
        for (k, (&change, &multiplier)) in change.iter().zip(self.multipliers.iter()).enumerate().take(self.active) {
            if change > 0.0 && multiplier / change < shortest {
                (first, shortest) = (k, multiplier / change);
            }
        }
        (first, shortest)
    }

    /// Makes the pending row active. A Householder reflection turns the projection's free part into
    /// one component; `direction` is J times that part, of which the reflection of J needs no more.
    fn add(&mut self, row: PendingRow, projection: &[f64], free_squared: f64, direction: &mut [f64]) {
        let first = self.active;
        let length = -square_root(free_squared).copysign(projection[first]);
        // The reflection is I - w w' / (w' w / 2) with w = free part - length e1.
        let half_squared = free_squared - length * projection[first];
        let reflected = direction;
        for (value, column) in reflected.iter_mut().zip(&self.factor.as_slice()[first * N..]) {
            *value = (*value - length * column) / half_squared;
        }
        let columns = self.factor.as_mut_slice().as_chunks_mut::<N>().0;
        for (k, (column, &projected)) in columns.iter_mut().zip(projection).enumerate().skip(first) {
            let part = if k == first { projected - length } else { projected };
            add_scaled(column, -part, reflected);
        }
        let column = &mut self.triangle.as_mut_slice()[first * N..];
        column[..first].copy_from_slice(&projection[..first]);
        column[first] = length;
        self.multipliers[first] = row.multiplier;
        self.active += 1;
    }

    /// Makes an active row inactive. Rotations restore the triangle.
    fn drop_row(&mut self, dropped: usize) {
        self.active -= 1;
        for k in dropped..self.active {
            self.multipliers[k] = self.multipliers[k + 1];
            self.triangle.as_mut_slice().copy_within((k + 1) * N..(k + 2) * N, k * N);
        }
        for k in dropped..self.active {
            let (a, b) = (self.triangle[(k, k)], self.triangle[(k + 1, k)]);
            let length = square_root(a * a + b * b);
            if length == 0.0 {
                continue;
            }
            let (cos, sin) = (a / length, b / length);
            for column in self.triangle.as_mut_slice().chunks_exact_mut(N).take(self.active).skip(k) {
                let (above, below) = (column[k], column[k + 1]);
                (column[k], column[k + 1]) = (cos * above + sin * below, cos * below - sin * above);
            }
            let (left, right) = self.factor.as_mut_slice()[k * N..(k + 2) * N].split_at_mut(N);
            let rotate = |left: &mut f64, right: &mut f64| {
                (*left, *right) = (cos * *left + sin * *right, cos * *right - sin * *left);
            };
            // Fours of values stay in registers.
            let ((fours, rest), (others, others_rest)) = (left.as_chunks_mut::<4>(), right.as_chunks_mut::<4>());
            for ([a, b, c, d], [e, f, g, h]) in fours.iter_mut().zip(others) {
                rotate(a, e);
                rotate(b, f);
                rotate(c, g);
                rotate(d, h);
            }
            for (left, right) in rest.iter_mut().zip(others_rest) {
                rotate(left, right);
            }
        }
    }
}

fn columns<const N: usize>(
    matrix: &SMatrix<f64, N, N>,
) -> impl DoubleEndedIterator<Item = &[f64; N]> + ExactSizeIterator {
    matrix.as_slice().as_chunks::<N>().0.iter()
}

/// From the first to the last value that is not zero.
fn span(values: &[f64]) -> Range<usize> {
    let first = values.iter().position(|&value| value != 0.0).unwrap_or(0);
    let last = values.iter().rposition(|&value| value != 0.0).unwrap_or(first);
    first..last + 1
}

/// Adds `factor` times `other`. A factor of zero is frequent: the axes of a plan hardly meet.
fn add_scaled(values: &mut [f64], factor: f64, other: &[f64]) {
    if factor != 0.0 {
        // Fours of values stay in registers.
        let ((fours, rest), (others, others_rest)) = (values.as_chunks_mut::<4>(), other.as_chunks::<4>());
        for (four, other) in fours.iter_mut().zip(others) {
            let [a, b, c, d] = *four;
            *four = [a + factor * other[0], b + factor * other[1], c + factor * other[2], d + factor * other[3]];
        }
        for (value, other) in rest.iter_mut().zip(others_rest) {
            *value += factor * other;
        }
    }
}

/// Scalar product, in four sums side by side.
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (a, b) in a.iter().zip(b) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

fn sum_of_squares(values: &[f64]) -> f64 {
    dot(values, values)
}
