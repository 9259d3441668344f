//! The accelerations nearest to demanded ones within ranges of linear combinations of them.

use nalgebra::{Cholesky, SMatrix, SVector};
use serde::{Deserialize, Serialize};

/// Accelerations of surge, sway, heave \[m/s2\], roll, pitch and yaw \[rad/s2\].
pub type Accelerations = SVector<f64, 6>;
/// Surge, sway, heave and the six legs.
pub const ROWS: usize = 9;
/// A value for each row.
pub type RowValues = SVector<f64, ROWS>;

/// Ranges of linear combinations of the accelerations: lower <= normals c <= upper.
#[derive(Clone, Copy, Debug)]
pub struct Rows {
    pub normals: SMatrix<f64, ROWS, 6>,
    pub lower: RowValues,
    pub upper: RowValues,
}

/// The side on which each row acts: 1 at its upper end, -1 at its lower end, 0 inside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sides([i8; ROWS]);

impl Sides {
    /// True if any row acts.
    pub fn any(&self) -> bool {
        self.0 != [0; ROWS]
    }
}

/// Weight of a violated row's square, beside weights of about 1 of the accelerations. Rows that
/// contradict each other are violated a little instead of not being solved.
pub const PENALTY: f64 = 1e4;
/// Trials in which all rows that are wrong change at once; then one a trial, which ends for certain
/// in exact arithmetic (Murty's method for a positive definite matrix).
const TRIALS_AT_ONCE: usize = 8;
const MOST_TRIALS: usize = 40;
/// Violation that counts as rounding \[m/s2\].
const RESOLVED: f64 = 1e-9;

/// The accelerations c with the least (c - demand)' W (c - demand) + penalty of the violations.
/// `inverse_weights` is the diagonal of W^-1; `sides` holds the rows that acted in the last step, and
/// then those that act now.
///
/// The dual is solved by principal pivoting: with the acting rows S, their multipliers solve
/// (A W^-1 A' + I/penalty)_SS lambda = (A demand - bound)_S. A row of S whose multiplier has the wrong
/// sign leaves, another that is violated enters.
pub fn nearest(
    demand: &Accelerations,
    inverse_weights: &Accelerations,
    rows: &Rows,
    sides: &mut Sides,
) -> Accelerations {
    let moved = SMatrix::<f64, 6, ROWS>::from_fn(|k, row| inverse_weights[k] * rows.normals[(row, k)]);
    let gram = rows.normals * moved;
    let demanded = rows.normals * demand;
    let mut multipliers = RowValues::zeros();
    for trial in 0..MOST_TRIALS {
        let Some(found) = multipliers_of(&gram, &demanded, rows, sides) else { break };
        multipliers = found;
        let values = demanded - gram * multipliers;
        let mut wrong = 0;
        for row in 0..ROWS {
            let side = match sides.0[row] {
                0 if values[row] > rows.upper[row] + RESOLVED => 1,
                0 if values[row] < rows.lower[row] - RESOLVED => -1,
                side if f64::from(side) * multipliers[row] < 0.0 => 0,
                _ => continue,
            };
            wrong += 1;
            sides.0[row] = side;
            if trial >= TRIALS_AT_ONCE {
                break;
            }
        }
        if wrong == 0 {
            break;
        }
    }
    demand - moved * multipliers
}

/// The multipliers if exactly the rows of `sides` act; zero for the others.
fn multipliers_of(
    gram: &SMatrix<f64, ROWS, ROWS>,
    demanded: &RowValues,
    rows: &Rows,
    sides: &Sides,
) -> Option<RowValues> {
    let acts = sides.0.map(|side| side != 0);
    let matrix = SMatrix::<f64, ROWS, ROWS>::from_fn(|i, j| match (i == j, acts[i] && acts[j]) {
        (true, true) => gram[(i, i)] + 1.0 / PENALTY,
        (false, true) => gram[(i, j)],
        (true, false) => 1.0,
        (false, false) => 0.0,
    });
    let beyond = RowValues::from_fn(|row, _| match sides.0[row] {
        0 => 0.0,
        1 => demanded[row] - rows.upper[row],
        _ => demanded[row] - rows.lower[row],
    });
    Some(Cholesky::new(matrix)?.solve(&beyond))
}
