//! The algebraic Riccati equation of a linear-quadratic regulator.

use nalgebra::{Const, DimMin, SMatrix, ToTypenum};

use crate::motion::square_root::square_root;

type Square<const N: usize> = SMatrix<f64, N, N>;

/// The matrix sign iteration converges quadratically; a solvable equation needs 10 to 20.
const MAX_ITERATIONS: usize = 60;

/// Largest residual of a solution, relative to the terms of the equation. Rounding makes larger
/// ones where the terms differ by many orders of magnitude; what results is then no regulator.
const RELATIVE_RESIDUAL_TOLERANCE: f64 = 1e-6;

/// Solves A'P + PA + Q - PSP = 0 for the stabilizing P, with S = B R^-1 B'. None
/// if there is no such P. M is 2 N.
///
/// By the matrix sign function (Roberts, *International Journal of Control* 32 (1980) 677-687): the
/// sign W of the Hamiltonian [A -S; -Q -A'] satisfies (W + I) [I; P] = 0. Newton's iteration W <-
/// (c W + (c W)^-1) / 2 is scaled by norms. The states and inputs should be scaled to about 1.
pub fn solve<const N: usize, const M: usize>(a: &Square<N>, s: &Square<N>, q: &Square<N>) -> Option<Square<N>>
where
    Const<N>: ToTypenum,
    Const<M>: ToTypenum + DimMin<Const<N>, Output = Const<N>>,
{
    const { assert!(M == 2 * N) };
    let mut w = SMatrix::<f64, M, M>::zeros();
    w.fixed_view_mut::<N, N>(0, 0).copy_from(a);
    w.fixed_view_mut::<N, N>(0, N).copy_from(&-s);
    w.fixed_view_mut::<N, N>(N, 0).copy_from(&-q);
    w.fixed_view_mut::<N, N>(N, N).copy_from(&-a.transpose());
    for _ in 0..MAX_ITERATIONS {
        let inverse = w.try_inverse()?;
        let scale = square_root(inverse.norm() / w.norm());
        let next = 0.5 * (scale * w + inverse / scale);
        let change = (next - w).norm() / next.norm();
        w = next;
        if change < 1e-14 {
            break;
        }
    }
    w += SMatrix::<f64, M, M>::identity();
    // The last N columns times P are minus the first N.
    let (left, right) = (w.fixed_columns::<N>(0).into_owned(), w.fixed_columns::<N>(N).into_owned());
    let qr = right.qr();
    let mut p = -(qr.q().transpose() * left);
    if !qr.r().solve_upper_triangular_mut(&mut p) {
        return None;
    }
    let p = 0.5 * (p + p.transpose());
    let size = q.amax() + (p * s * p).amax();
    let finite = p.iter().all(|entry| entry.is_finite());
    (finite && residual(a, s, q, &p).amax() <= RELATIVE_RESIDUAL_TOLERANCE * size).then_some(p)
}

/// The left side of the equation, which a solution makes zero.
pub fn residual<const N: usize>(a: &Square<N>, s: &Square<N>, q: &Square<N>, p: &Square<N>) -> Square<N> {
    a.transpose() * p + p * a + q - p * s * p
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, Matrix6};

    use super::*;

    #[test]
    fn uncoupled_scalar_equations_have_their_closed_form() {
        let a = Matrix6::from_fn(|i, j| if i == j { [-2.0, -1.0, 0.0, 0.5, 1.0, -0.01][i] } else { 0.0 });
        let s = Matrix6::from_fn(|i, j| if i == j { [1.0, 0.1, 2.0, 3.0, 0.5, 1.0][i] } else { 0.0 });
        let q = Matrix6::from_fn(|i, j| if i == j { [1.0, 5.0, 0.3, 1.0, 2.0, 0.04][i] } else { 0.0 });
        let p = solve::<6, 12>(&a, &s, &q).unwrap();
        for k in 0..6 {
            let (a, s, q) = (a[(k, k)], s[(k, k)], q[(k, k)]);
            let expected = (a + (a * a + s * q).sqrt()) / s;
            assert!((p[(k, k)] - expected).abs() < 1e-12 * expected, "{k}: {} beside {expected}", p[(k, k)]);
        }
    }

    #[test]
    fn the_double_integrators_gains_are_the_closed_forms() {
        let p = solve::<2, 4>(
            &Matrix2::new(0.0, 1.0, 0.0, 0.0),
            &Matrix2::new(0.0, 0.0, 0.0, 1.0),
            &Matrix2::new(16.0, 0.0, 0.0, 0.0),
        );
        let gains = p.unwrap().row(1).into_owned();
        assert!((gains[0] - 4.0).abs() < 1e-12, "of the position: {}", gains[0]);
        assert!((gains[1] - f64::sqrt(8.0)).abs() < 1e-12, "of the velocity: {}", gains[1]);
    }

    #[test]
    fn an_equation_without_a_stabilizing_solution_has_none() {
        // Unstable, and without an input.
        let a = Matrix6::identity();
        assert_eq!(solve::<6, 12>(&a, &Matrix6::zeros(), &Matrix6::identity()), None);
        assert_eq!(solve::<6, 12>(&(f64::NAN * a), &a, &a), None);
        // The state that grows is not the one that the input reaches.
        let reached = Matrix2::new(0.0, 0.0, 0.0, 1.0);
        assert_eq!(solve::<2, 4>(&Matrix2::new(1.0, 0.0, 0.0, -1.0), &reached, &Matrix2::identity()), None);
    }
}
