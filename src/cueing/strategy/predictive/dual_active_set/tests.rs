//! Comparison with the interior-point solver clarabel on random programs: plain, degenerate,
//! infeasible. `compare` also serves the programs of a ride.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};
use nalgebra::{SMatrix, SVector};

use super::{DualActiveSet, PendingRow, Rows, Search, Status};

/// Rows that are given one by one.
pub struct DenseRows<const N: usize, const M: usize> {
    pub normals: Vec<SVector<f64, N>>,
    pub lower: SVector<f64, M>,
    pub upper: SVector<f64, M>,
}

impl<const N: usize, const M: usize> DenseRows<N, M> {
    /// Copies of other rows.
    pub fn of(rows: &impl Rows<N, M>) -> Self {
        let [lower, upper] = rows.bounds().map(|bounds| *bounds);
        let normal = |row| {
            let mut normal = SVector::zeros();
            rows.set_normal(row, &mut normal);
            normal
        };
        DenseRows { normals: (0..M).map(normal).collect(), lower, upper }
    }
}

impl<const N: usize, const M: usize> Rows<N, M> for DenseRows<N, M> {
    fn evaluate(&self, point: &SVector<f64, N>, search: &mut Search<M>) {
        for (row, normal) in self.normals.iter().enumerate().take(M) {
            search.see(row, normal.dot(point));
        }
    }

    fn set_normal(&self, row: usize, normal: &mut SVector<f64, N>) {
        *normal = self.normals[row];
    }

    fn bounds(&self) -> [&SVector<f64, M>; 2] {
        [&self.lower, &self.upper]
    }
}

/// A program, random or of a ride.
pub struct Program<const N: usize, const M: usize> {
    /// J with J J' = H^-1, upper triangular.
    pub factor: SMatrix<f64, N, N>,
    pub gradient: SVector<f64, N>,
    pub rows: DenseRows<N, M>,
}

impl<const N: usize, const M: usize> Program<N, M> {
    fn new(hessian: SMatrix<f64, N, N>, gradient: SVector<f64, N>, rows: DenseRows<N, M>) -> Self {
        let lower = hessian.cholesky().expect("positive definite").l();
        Program { factor: lower.transpose().try_inverse().expect("regular"), gradient, rows }
    }

    fn hessian(&self) -> SMatrix<f64, N, N> {
        let inverse = self.factor.try_inverse().expect("regular");
        inverse.transpose() * inverse
    }
}

/// The row that is violated most at a point, if one is.
pub fn most_violated<const N: usize, const M: usize>(rows: &impl Rows<N, M>, point: &SVector<f64, N>) -> Option<usize> {
    let solver = DualActiveSet::<N, M> { solution: *point, ..DualActiveSet::new() };
    solver.most_violated(rows).map(|found| found.row as usize)
}

/// Numbers from -1 to 1: xorshift64*.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11;
        bits as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A program whose rows all hold at a random point, some of them only just.
    fn feasible<const N: usize, const M: usize>(&mut self) -> Program<N, M> {
        let a = SMatrix::<f64, N, N>::from_fn(|_, _| self.next());
        let inside = SVector::<f64, N>::from_fn(|_, _| self.next());
        let normals = SMatrix::<f64, N, M>::from_fn(|_, _| self.next());
        let at_inside = normals.tr_mul(&inside);
        let mut room = || {
            let room = self.next();
            if room < -0.5 { 0.0 } else { 0.5 * (room + 0.5) }
        };
        let lower = at_inside.map(|value| value - room());
        let upper = at_inside.map(|value| value + room());
        let rows =
            DenseRows { normals: normals.column_iter().map(|column| column.into_owned()).collect(), lower, upper };
        let gradient = SVector::from_fn(|_, _| 10.0 * self.next());
        Program::new(a * a.transpose() + 0.1 * SMatrix::identity(), gradient, rows)
    }

    /// A feasible program with repeated rows and sums of rows: many bounds are reached at once.
    fn degenerate<const N: usize, const M: usize>(&mut self) -> Program<N, M> {
        let mut program = self.feasible::<N, M>();
        let DenseRows { normals, lower, upper } = &mut program.rows;
        for k in (2..M).step_by(3) {
            let (a, b) = (k - 1, k - 2);
            if k % 2 == 0 {
                normals[k] = normals[a] + normals[b];
                (lower[k], upper[k]) = (lower[a] + lower[b], upper[a] + upper[b]);
            } else {
                normals[k] = normals[a];
                (lower[k], upper[k]) = (lower[a], upper[a]);
            }
        }
        program
    }

    /// A program two of whose rows contradict each other by a margin.
    fn infeasible<const N: usize, const M: usize>(&mut self) -> Program<N, M> {
        let mut program = self.feasible::<N, M>();
        let DenseRows { normals, lower, upper } = &mut program.rows;
        normals[1] = -normals[0];
        lower[1] = -lower[0] + 0.1 + 0.1 * self.next().abs();
        upper[1] = lower[1] + 1.0;
        program
    }
}

fn solved<const N: usize, const M: usize>(program: &Program<N, M>, at_once: u32) -> DualActiveSet<N, M> {
    let mut solver = DualActiveSet::new();
    solver.start(&program.factor, &program.gradient);
    for _ in 0..10_000 {
        if solver.advance(&program.rows, at_once) != Status::Running {
            break;
        }
    }
    solver
}

/// Bound on the distance of the solver's point from the solution, by the conditions of Karush, Kuhn
/// and Tucker. Infinite if they do not prove one.
///
/// The gradient at the point must be a sum of the inward normals of rows that are at their
/// bounds, with multipliers that are not negative. The solver's multipliers are tried. In the
/// variables J^-1 u, in which the Hessian is the identity, the solution is no farther than the
/// norm of the remainder.
fn proven_distance<const N: usize, const M: usize>(program: &Program<N, M>, solver: &DualActiveSet<N, M>) -> f64 {
    const ROUNDING: f64 = 1e-8;
    let DenseRows { normals, lower, upper } = &program.rows;
    let point = solver.solution();
    let inverse = program.factor.try_inverse().expect("regular");
    let mut left_over = inverse * point + program.factor.tr_mul(&program.gradient);
    for k in 0..solver.active {
        let is_column = |inward: &SVector<f64, N>| {
            (solver.factor.tr_mul(inward) - solver.triangle.column(k)).amax() <= ROUNDING * inward.norm()
        };
        let inward = normals.iter().enumerate().find_map(|(row, normal)| {
            let value = normal.dot(point);
            let low = value - lower[row] <= ROUNDING && is_column(normal);
            let high = upper[row] - value <= ROUNDING && is_column(&-normal);
            if low { Some(*normal) } else { high.then(|| -normal) }
        });
        match inward {
            Some(inward) if solver.multipliers[k] >= 0.0 => {
                left_over -= solver.multipliers[k] * program.factor.tr_mul(&inward);
            }
            _ => return f64::INFINITY,
        }
    }
    left_over.norm() * program.factor.norm()
}

/// The oracle's solution, or none if it finds that there is none.
fn oracle<const N: usize, const M: usize>(program: &Program<N, M>) -> Option<SVector<f64, N>> {
    let full = program.hessian();
    let upper_triangle = SMatrix::<f64, N, N>::from_fn(|i, j| if i <= j { full[(i, j)] } else { 0.0 });
    let dense = |rows: usize, columns: usize, value: &dyn Fn(usize, usize) -> f64| {
        let lines: Vec<Vec<f64>> = (0..rows).map(|i| (0..columns).map(|j| value(i, j)).collect()).collect();
        CscMatrix::from(&lines)
    };
    let DenseRows { normals, lower, upper } = &program.rows;
    let both = dense(2 * M, N, &|i, j| if i < M { normals[i][j] } else { -normals[i - M][j] });
    let bounds: Vec<f64> = upper.iter().copied().chain(lower.iter().map(|bound| -bound)).collect();
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_gap_abs(1e-13)
        .tol_gap_rel(1e-13)
        .tol_feas(1e-13)
        .max_iter(100)
        .build()
        .expect("valid settings");
    let hessian = dense(N, N, &|i, j| upper_triangle[(i, j)]);
    let mut solver =
        DefaultSolver::new(&hessian, program.gradient.as_slice(), &both, &bounds, &[NonnegativeConeT(2 * M)], settings)
            .expect("a well-formed program");
    solver.solve();
    match solver.solution.status {
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => None,
        _ => Some(SVector::from_column_slice(&solver.solution.x)),
    }
}

fn objective<const N: usize, const M: usize>(program: &Program<N, M>, u: &SVector<f64, N>) -> f64 {
    0.5 * u.dot(&(program.hessian() * u)) + program.gradient.dot(u)
}

/// Fails unless the solver's solution is the oracle's, or proven to be nearer to the true one.
pub fn compare<const N: usize, const M: usize>(program: &Program<N, M>) {
    let solver = solved(program, 1 << 20);
    let expected = oracle(program);
    match expected {
        None => assert!(solver.given_up() > 0, "found a solution where there is none"),
        Some(expected) => {
            assert_eq!(solver.given_up(), 0, "gave up rows of a program that has a solution");
            assert_eq!(solver.status(), Status::Solved);
            let mut error = (solver.solution() - expected).amax();
            if error > 1e-7 {
                // The interior-point method may end early on a program that is nearly degenerate.
                error = proven_distance(program, &solver);
            }
            let (ours, theirs) = (objective(program, solver.solution()), objective(program, &expected));
            assert!(error <= 1e-7, "off by {error:e}, objective {ours:e} beside {theirs:e}");
        }
    }
    let values = SVector::<f64, M>::from_fn(|row, _| program.rows.normals[row].dot(solver.solution()));
    if solver.given_up() == 0 {
        let DenseRows { lower, upper, .. } = &program.rows;
        let violation = (lower - values).max().max((values - upper).max());
        assert!(violation <= 1e-9, "violated by {violation:e}");
    }
}

#[test]
fn random_programs_have_the_solution_that_an_interior_point_method_finds() {
    compare_feasible(1, crate::cases::cases(300, 100));
}

#[test]
fn degenerate_programs_are_solved() {
    compare_degenerate(2, 300);
}

/// Thousands of programs have the solution that an interior point method finds: the tests of this
/// module run side by side.
mod many {
    use super::*;
    use crate::cases::searches;

    #[test]
    #[ignore = "takes a minute"]
    fn feasible() {
        compare_feasible(11, searches(6_000, 600));
    }

    #[test]
    #[ignore = "takes a minute"]
    fn degenerate() {
        compare_degenerate(12, searches(5_000, 500));
    }

    #[test]
    #[ignore = "takes a minute"]
    fn infeasible() {
        let mut random = Random(13);
        for _ in 0..searches(3_000, 300) {
            compare(&random.infeasible::<16, 40>());
        }
    }
}

#[test]
fn the_distance_from_the_solution_is_proven_by_the_multipliers() {
    let mut random = Random(6);
    for _ in 0..50 {
        let program = random.feasible::<16, 40>();
        let mut solver = solved(&program, 1 << 20);
        assert!(proven_distance(&program, &solver) < 1e-9);
        solver.multipliers[0] *= 1.001;
        assert!(solver.active == 0 || proven_distance(&program, &solver) > 1e-6);
    }
}

/// So many programs of each of three sizes.
fn compare_feasible(seed: u64, count: usize) {
    let mut random = Random(seed);
    for _ in 0..count {
        compare(&random.feasible::<6, 20>());
        compare(&random.feasible::<16, 40>());
        compare(&random.feasible::<32, 146>());
    }
}

/// So many programs of each of two sizes.
fn compare_degenerate(seed: u64, count: usize) {
    let mut random = Random(seed);
    for _ in 0..count {
        compare(&random.degenerate::<6, 20>());
        compare(&random.degenerate::<16, 40>());
    }
}

#[test]
fn contradicting_rows_are_given_up_and_the_others_hold() {
    let mut random = Random(3);
    for _ in 0..300 {
        let program = random.infeasible::<16, 40>();
        compare(&program);
        let solver = solved(&program, 7);
        assert_eq!(solver.status(), Status::Solved);
        assert!(solver.given_up() >= 1);
    }
}

#[test]
fn an_interrupted_solve_ends_at_the_same_bits() {
    let mut random = Random(4);
    for _ in 0..50 {
        let program = random.feasible::<16, 40>();
        assert_eq!(solved(&program, 1), solved(&program, 1 << 20));
    }
}

#[test]
fn numbers_that_are_not_finite_end_the_solve() {
    let mut program = Random(5).feasible::<6, 20>();
    program.gradient[2] = f64::NAN;
    assert_eq!(solved(&program, 100).status(), Status::Failed);
}

/// A program of two variables that are to be zero: its rows are normals with their lower bounds.
fn at_least<const M: usize>(rows: [([f64; 2], f64); M]) -> Program<2, M> {
    let normals = rows.iter().map(|(normal, _)| SVector::from(*normal)).collect();
    let lower = SVector::from(rows.map(|(_, lower)| lower));
    Program::new(SMatrix::identity(), SVector::zeros(), DenseRows { normals, lower, upper: SVector::repeat(1e9) })
}

#[test]
fn each_row_that_is_added_is_an_iteration() {
    for (second, iterations) in [(-1.0, 1), (0.5, 2)] {
        let solver = solved(&at_least([([1.0, 0.0], 1.0), ([0.0, 1.0], second)]), 100);
        assert_eq!((solver.status(), solver.iterations()), (Status::Solved, iterations));
    }
}

#[test]
fn nearly_dependent_rows_and_small_ones_are_rows() {
    let nearly_opposite = at_least([([1.0, 0.0], 1.0), ([-1.0, 1e-8], -1.0 + 1e-8)]);
    let small = at_least([([1e-6, 0.0], 1e-6), ([0.0, 1e-6], 1e-6)]);
    for program in [nearly_opposite, small] {
        let solver = solved(&program, 100);
        assert_eq!((solver.status(), solver.given_up()), (Status::Solved, 0));
        assert!((solver.solution() - SVector::from([1.0, 1.0])).amax() < 1e-6, "{}", solver.solution());
    }
}

#[test]
fn an_abandoned_solve_has_failed_and_the_next_one_is_new() {
    let program = Random(7).feasible::<6, 20>();
    let mut solver = DualActiveSet::<6, 20>::new();
    solver.start(&program.factor, &program.gradient);
    solver.advance(&program.rows, 2);
    solver.abandon();
    let left = *solver.solution();
    assert_eq!(solver.advance(&program.rows, 100), Status::Failed);
    assert_eq!(*solver.solution(), left, "nothing goes on");
    solver.start(&program.factor, &program.gradient);
    solver.advance(&program.rows, 100);
    assert_eq!(solver.solution(), solved(&program, 100).solution());
}

#[test]
fn a_state_that_no_solve_leads_to_fails() {
    let mut program = at_least([([1.0, 0.0], 1.0)]);
    // A row more than there are bounds.
    program.rows.normals.push(SVector::from([0.0, 1.0]));
    let started = || {
        let mut solver = DualActiveSet::<2, 1>::new();
        solver.start(&program.factor, &program.gradient);
        solver
    };
    for row in [1, 2, u32::MAX] {
        let mut solver = started();
        solver.pending = Some(PendingRow { row, side: 1.0, multiplier: 0.0 });
        assert_eq!(solver.advance(&program.rows, 1), Status::Failed, "row {row}");
    }
    let mut solver = started();
    solver.active = 3;
    assert_eq!(solver.advance(&program.rows, 1), Status::Failed);
}
