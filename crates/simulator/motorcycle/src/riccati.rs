//! The continuous algebraic Riccati equation, by the structure-preserving doubling algorithm.

use nalgebra::{SMatrix, SVector};

/// The gain row k of the control u = -k x that minimises the integral of x' Q x + u^2 / `ease` for
/// x' = A x + b u.
///
/// The method is that of Chu, Fan, Lin, "A structure-preserving doubling algorithm for
/// continuous-time algebraic Riccati equations", Linear Algebra Appl. 396 (2005). A Cayley
/// transformation maps the equation to a discrete one. A doubling recursion converges quadratically
/// to its solution. `shift` \[1/s\] is the transformation's parameter: any positive number, best of
/// the size of the system's poles. `None` where there is no stabilising solution.
pub fn lqr_gain<const N: usize>(
    a: &SMatrix<f64, N, N>,
    b: &SVector<f64, N>,
    q: &SMatrix<f64, N, N>,
    ease: f64,
    shift: f64,
) -> Option<SVector<f64, N>> {
    Some(cost_to_go(a, b, q, ease, shift)? * b * ease)
}

/// The symmetric matrix P for which x' P x is the cost of [`lqr_gain`]'s control from the state x.
/// Arguments and `None` are as for [`lqr_gain`].
pub fn cost_to_go<const N: usize>(
    a: &SMatrix<f64, N, N>,
    b: &SVector<f64, N>,
    q: &SMatrix<f64, N, N>,
    ease: f64,
    shift: f64,
) -> Option<SMatrix<f64, N, N>> {
    let identity = SMatrix::<f64, N, N>::identity();
    let control = b * b.transpose() * ease;
    let shifted = a - identity * shift;
    let inverse = shifted.try_inverse()?;
    let coupled = (shifted.transpose() + q * inverse * control).try_inverse()?;

    let mut e = identity + (shifted + control * inverse.transpose() * q).try_inverse()? * (2.0 * shift);
    let mut g = symmetric(inverse * control * coupled * (2.0 * shift));
    let mut h = symmetric(coupled * q * inverse * (2.0 * shift));
    for _ in 0..MOST_DOUBLINGS {
        let solve = (identity + g * h).try_inverse()?;
        let change = symmetric(e.transpose() * h * solve * e);
        g = symmetric(g + e * solve * g * e.transpose());
        h += change;
        e = e * solve * e;
        if !h.norm().is_finite() {
            return None;
        }
        if change.norm() <= 1e-14 * h.norm() {
            return Some(h);
        }
    }
    None
}

/// Largest number of doublings. Each squares the error: if there is a solution, a dozen reach it.
const MOST_DOUBLINGS: usize = 40;

/// The symmetric part: keeps rounding from adding up.
fn symmetric<const N: usize>(matrix: SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    (matrix + matrix.transpose()) * 0.5
}
