//! A dual active-set solver for small dense strictly convex quadratic programs.
//!
//! Minimizes u'Hu/2 + g'u subject to lower <= C u <= upper. The method is that of Goldfarb and
//! Idnani, *A numerically stable dual method for solving strictly convex quadratic programs*,
//! Mathematical Programming 27 (1983) 1-33, for two-sided rows. It starts at the unconstrained
//! minimum, so that no feasible start is needed, and adds one violated row after the other. Each
//! iterate is the minimum under its active rows.
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

use alloc::vec::Vec;

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::motion::square_root::square_root;

#[cfg(test)]
pub(crate) mod tests;

/// The rows lower <= C u <= upper of a quadratic program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rows<const N: usize, const M: usize> {
    /// The M rows of C. On the heap, because they are too much for a small stack.
    pub normals: Vec<SVector<f64, N>>,
    pub lower: SVector<f64, M>,
    pub upper: SVector<f64, M>,
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
const FEASIBLE: f64 = 1e-10;
/// A row whose normal lies in the active rows' span to this fraction depends on them.
const DEPENDENT: f64 = 1e-11;

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
        for column in factor.column_iter() {
            self.solution.axpy(-column.dot(gradient), &column, 1.0);
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
    pub fn advance(&mut self, rows: &Rows<N, M>, iterations: u32) -> Status {
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
    fn iterate(&mut self, rows: &Rows<N, M>) {
        let Some(mut pending) = self.pending.take().or_else(|| self.most_violated(rows)) else {
            let finite = self.solution.iter().all(|value| value.is_finite());
            self.status = if finite { Status::Solved } else { Status::Failed };
            return;
        };
        self.iterations += 1;
        let row = pending.row as usize;
        let (Some(normal), true) = (rows.normals.get(row), row < M && self.active <= N) else {
            // No solve leads here, but a deserialized state may.
            self.status = Status::Failed;
            return;
        };
        let projection: SVector<f64, N> = self.factor.tr_mul(normal) * pending.side;
        let change = self.multiplier_change(&projection);
        let (blocking, longest) = self.blocking(&change);

        let free_squared = sum_of_squares(&projection.as_slice()[self.active..]);
        let independent = free_squared > DEPENDENT * DEPENDENT * projection.norm_squared();
        let violation = if pending.side > 0.0 {
            rows.lower[row] - normal.dot(&self.solution)
        } else {
            normal.dot(&self.solution) - rows.upper[row]
        };
        let full = if independent { violation / free_squared } else { f64::INFINITY };
        let step = if longest < full { longest } else { full };
        if step == f64::INFINITY {
            self.given_up[row] = true;
            return;
        }
        let mut direction = SVector::<f64, N>::zeros();
        if independent {
            for k in self.active..N {
                direction.axpy(projection[k], &self.factor.column(k), 1.0);
            }
            self.solution.axpy(step, &direction, 1.0);
        }
        for k in 0..self.active {
            self.multipliers[k] = (self.multipliers[k] - step * change[k]).max(0.0);
        }
        pending.multiplier += step;
        if step == full {
            self.add(pending, &projection, free_squared, &direction);
        } else {
            self.drop_row(blocking);
            self.pending = Some(pending);
        }
    }

    /// The row violated most, if any is.
    fn most_violated(&self, rows: &Rows<N, M>) -> Option<PendingRow> {
        let (mut worst, mut found) = (FEASIBLE, None);
        for (row, normal) in rows.normals.iter().enumerate().take(M) {
            let value = normal.dot(&self.solution);
            let (below, above) = (rows.lower[row] - value, value - rows.upper[row]);
            let (violation, side) = if below > above { (below, 1.0) } else { (above, -1.0) };
            if violation > worst && !self.given_up[row] {
                (worst, found) = (violation, Some(PendingRow { row: row as u32, side, multiplier: 0.0 }));
            }
        }
        found
    }

    /// R^-1 of the projection's first part: how the active rows' multipliers fall as
    /// the pending one's grows.
    fn multiplier_change(&self, projection: &SVector<f64, N>) -> SVector<f64, N> {
        let mut change = *projection;
        for k in (0..self.active).rev() {
            change[k] /= self.triangle[(k, k)];
            let (value, column) = (change[k], self.triangle.column(k));
            for i in 0..k {
                change[i] -= value * column[i];
            }
        }
        change
    }

    /// The active row whose multiplier vanishes first, and the step at which it does.
    fn blocking(&self, change: &SVector<f64, N>) -> (usize, f64) {
        let (mut first, mut shortest) = (0, f64::INFINITY);
        for k in 0..self.active {
            let step = self.multipliers[k] / change[k];
            if change[k] > 0.0 && step < shortest {
                (first, shortest) = (k, step);
            }
        }
        (first, shortest)
    }

    /// Makes the pending row active. A Householder reflection turns the projection's free part into
    /// one component; `direction` is J times that part, of which the reflection of J needs no more.
    fn add(&mut self, row: PendingRow, projection: &SVector<f64, N>, free_squared: f64, direction: &SVector<f64, N>) {
        let first = self.active;
        let length = -square_root(free_squared).copysign(projection[first]);
        // The reflection is I - w w' / (w' w / 2) with w = free part - length e1.
        let mut mirror = *projection;
        mirror[first] -= length;
        let half_squared = free_squared - length * projection[first];
        let mut reflected = *direction;
        reflected.axpy(-length, &self.factor.column(first), 1.0);
        reflected /= half_squared;
        for k in first..N {
            self.factor.column_mut(k).axpy(-mirror[k], &reflected, 1.0);
        }
        let mut column = self.triangle.column_mut(first);
        for k in 0..first {
            column[k] = projection[k];
        }
        column[first] = length;
        self.multipliers[first] = row.multiplier;
        self.active += 1;
    }

    /// Makes an active row inactive. Rotations restore the triangle.
    fn drop_row(&mut self, dropped: usize) {
        self.active -= 1;
        for k in dropped..self.active {
            self.multipliers[k] = self.multipliers[k + 1];
            let next = self.triangle.column(k + 1).into_owned();
            self.triangle.set_column(k, &next);
        }
        for k in dropped..self.active {
            let (a, b) = (self.triangle[(k, k)], self.triangle[(k + 1, k)]);
            let length = square_root(a * a + b * b);
            if length == 0.0 {
                continue;
            }
            let (cos, sin) = (a / length, b / length);
            for column in k..self.active {
                let (above, below) = (self.triangle[(k, column)], self.triangle[(k + 1, column)]);
                self.triangle[(k, column)] = cos * above + sin * below;
                self.triangle[(k + 1, column)] = cos * below - sin * above;
            }
            for i in 0..N {
                let (left, right) = (self.factor[(i, k)], self.factor[(i, k + 1)]);
                self.factor[(i, k)] = cos * left + sin * right;
                self.factor[(i, k + 1)] = cos * right - sin * left;
            }
        }
    }
}

fn sum_of_squares(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}
