//! The accelerations nearest to demanded ones within ranges of linear combinations of them.

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::motion::min_max::{max, min};
use crate::motion::square_root::square_root;

/// Accelerations of surge, sway, heave \[m/s2\], roll, pitch and yaw \[rad/s2\].
pub type Accelerations = SVector<f64, 6>;
/// Surge, sway, heave and the six legs.
pub const ROW_COUNT: usize = 9;
/// A value for each row.
pub type RowValues = SVector<f64, ROW_COUNT>;

/// The dual of a program with these rows.
struct Dual<'a> {
    rows: &'a Rows,
    /// A demand, with the rows' normals A.
    demanded: RowValues,
    /// W^-1 A'.
    moved: SMatrix<f64, 6, ROW_COUNT>,
    /// A W^-1 A', as far as it is known: the columns of rows that have acted.
    gram: SMatrix<f64, ROW_COUNT, ROW_COUNT>,
    known: [bool; ROW_COUNT],
}

/// Ranges of linear combinations of the accelerations: lower <= normals c <= upper.
#[derive(Clone, Copy, Debug)]
pub struct Rows {
    pub normals: SMatrix<f64, ROW_COUNT, 6>,
    pub lower: RowValues,
    pub upper: RowValues,
}

/// The side on which each row acts: 1 at its upper end, -1 at its lower end, 0 inside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ActingRows([i8; ROW_COUNT]);

impl ActingRows {
    /// True if any row acts.
    pub fn any(&self) -> bool {
        self.0 != [0; ROW_COUNT]
    }

    /// The numbers of the rows that act.
    #[inline(always)]
    fn numbers(&self) -> impl Iterator<Item = usize> {
        self.0.iter().enumerate().filter(|(_, side)| **side != 0).map(|(row, _)| row)
    }
}

/// Weight of a violated row's square, beside weights of about 1 of the accelerations. Rows that
/// contradict each other are violated a little instead of not being solved.
pub const VIOLATION_PENALTY: f64 = 1e4;
/// Trials in which all rows that are wrong change at once, before they change one by one.
const TRIALS_AT_ONCE: usize = 6;
/// Changes one by one; random programs take 20 at most.
const MOST_CHANGES: usize = 60;
/// Multiplier that counts as zero.
const MULTIPLIER_TOLERANCE: f64 = 1e-12;
/// Violation that counts as rounding \[m/s2\].
const VIOLATION_TOLERANCE: f64 = 1e-9;

/// The accelerations c with the least (c - demand)' W (c - demand) + penalty of the violations.
/// `inverse_weights` is the diagonal of W^-1; `acting_rows` holds the rows that acted in the last
/// step, and then those that act now.
///
/// The dual is solved by principal pivoting: with the acting rows S, their multipliers solve (A
/// W^-1 A' + I/penalty)_SS lambda = (A demand - bound)_S. A row of S whose multiplier has the wrong
/// sign leaves, another that is violated enters. From one step to the next few rows change, so a
/// trial or two are enough; where this goes round in circles, rows change one by one.
pub fn nearest_accelerations(
    demand: &Accelerations,
    inverse_weights: &Accelerations,
    rows: &Rows,
    acting_rows: &mut ActingRows,
) -> Accelerations {
    let moved = SMatrix::<f64, 6, ROW_COUNT>::from_fn(|k, row| inverse_weights[k] * rows.normals[(row, k)]);
    let (demanded, gram, known) = (rows.normals * demand, SMatrix::zeros(), [false; ROW_COUNT]);
    let mut dual = Dual { rows, demanded, moved, gram, known };
    let multipliers = match dual.all_at_once(acting_rows) {
        None => dual.one_by_one(acting_rows),
        found => found,
    };
    demand - dual.moved * multipliers.unwrap_or_default()
}

/// A row's side if it is beyond its range.
fn violated_side(value: f64, rows: &Rows, row: usize) -> i8 {
    i8::from(value > rows.upper[row] + VIOLATION_TOLERANCE) - i8::from(value < rows.lower[row] - VIOLATION_TOLERANCE)
}

impl Dual<'_> {
    /// The rows' values with these multipliers of the rows that act.
    fn values(&self, multipliers: &RowValues, acting_rows: &ActingRows) -> RowValues {
        let mut moved = RowValues::zeros();
        for row in acting_rows.numbers() {
            moved += self.gram.column(row) * multipliers[row];
        }
        self.demanded - moved
    }

    /// Principal pivoting from these acting rows on. None if it does not end soon.
    fn all_at_once(&mut self, acting_rows: &mut ActingRows) -> Option<RowValues> {
        for _ in 0..TRIALS_AT_ONCE {
            let multipliers = self.multipliers_of(acting_rows)?;
            let values = self.values(&multipliers, acting_rows);
            let before = *acting_rows;
            for row in 0..ROW_COUNT {
                acting_rows.0[row] = match acting_rows.0[row] {
                    0 => violated_side(values[row], self.rows, row),
                    side if f64::from(side) * multipliers[row] < 0.0 => 0,
                    side => side,
                };
            }
            if *acting_rows == before {
                return Some(multipliers);
            }
        }
        None
    }

    /// Lawson and Hanson's method: the row that is violated most enters, and rows leave
    /// whose multipliers reach zero on the way to the next ones. The dual cost falls with
    /// each change, so it ends.
    fn one_by_one(&mut self, acting_rows: &mut ActingRows) -> Option<RowValues> {
        let rows = self.rows;
        *acting_rows = ActingRows::default();
        let mut multipliers = RowValues::zeros();
        for _ in 0..MOST_CHANGES {
            let values = self.values(&multipliers, acting_rows);
            let beyond = |row: usize| max(values[row] - rows.upper[row], rows.lower[row] - values[row]);
            let inside = (0..ROW_COUNT).filter(|row| acting_rows.0[*row] == 0);
            let worst = inside.max_by(|a, b| beyond(*a).total_cmp(&beyond(*b)));
            let Some(worst) = worst.filter(|row| violated_side(values[*row], rows, *row) != 0) else { break };
            acting_rows.0[worst] = violated_side(values[worst], rows, worst);
            // Each round but the last takes out a row.
            for _ in 0..ROW_COUNT {
                let next = self.multipliers_of(acting_rows)?;
                let mut fraction = 1.0;
                for row in 0..ROW_COUNT {
                    if f64::from(acting_rows.0[row]) * next[row] < 0.0 {
                        fraction = min(multipliers[row] / (multipliers[row] - next[row]), fraction);
                    }
                }
                multipliers += fraction * (next - multipliers);
                if fraction == 1.0 {
                    break;
                }
                for row in 0..ROW_COUNT {
                    if f64::from(acting_rows.0[row]) * multipliers[row] <= MULTIPLIER_TOLERANCE {
                        (acting_rows.0[row], multipliers[row]) = (0, 0.0);
                    }
                }
            }
        }
        Some(multipliers)
    }

    /// The multipliers if exactly the rows of `acting_rows` act; zero for the others.
    fn multipliers_of(&mut self, acting_rows: &ActingRows) -> Option<RowValues> {
        let Dual { rows, demanded, .. } = &*self;
        let beyond = RowValues::from_fn(|row, _| match acting_rows.0[row] {
            0 => 0.0,
            1 => demanded[row] - rows.upper[row],
            _ => demanded[row] - rows.lower[row],
        });
        let (mut numbers, mut count) = ([0; ROW_COUNT], 0);
        for row in acting_rows.numbers() {
            (numbers[count], count) = (row, count + 1);
            if !self.known[row] {
                self.gram.set_column(row, &(self.rows.normals * self.moved.column(row)));
                self.known[row] = true;
            }
        }
        // The Cholesky factor of the acting rows' part: the others' rows and columns stay zero.
        let (acting, mut factor, mut solution) =
            (&numbers[..count], SMatrix::<f64, ROW_COUNT, ROW_COUNT>::zeros(), beyond);
        for (k, &column) in acting.iter().enumerate() {
            let (before, from_here) = acting.split_at(k);
            for &row in from_here {
                let value = self.gram[(row, column)] + if row == column { 1.0 / VIOLATION_PENALTY } else { 0.0 };
                let rest =
                    before.iter().fold(value, |value, &other| value - factor[(column, other)] * factor[(row, other)]);
                factor[(row, column)] = if row != column {
                    rest / factor[(column, column)]
                } else if rest > 0.0 {
                    square_root(rest)
                } else {
                    return None;
                };
            }
            solution[column] /= factor[(column, column)];
            for &row in &from_here[1..] {
                solution[row] -= solution[column] * factor[(row, column)];
            }
        }
        for &column in acting.iter().rev() {
            let known = column + 1..;
            let others = factor.column(column).rows_range(known.clone()).dot(&solution.rows_range(known));
            solution[column] = (solution[column] - others) / factor[(column, column)];
        }
        Some(solution)
    }
}
