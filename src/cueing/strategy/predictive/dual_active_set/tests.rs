//! Against the interior-point solver clarabel, on random programs: plain, degenerate, infeasible.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};
use nalgebra::{DMatrix, DVector, SMatrix, SVector};

use super::{DualActiveSet, Rows, Status};

/// A random program.
struct Program<const N: usize, const M: usize> {
    hessian: SMatrix<f64, N, N>,
    gradient: SVector<f64, N>,
    rows: Rows<N, M>,
}

/// Numbers from -1 to 1: xorshift64*.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
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
        Program {
            hessian: a * a.transpose() + 0.1 * SMatrix::identity(),
            gradient: SVector::from_fn(|_, _| 10.0 * self.next()),
            rows: Rows { normals: normals.column_iter().map(|column| column.into_owned()).collect(), lower, upper },
        }
    }

    /// A feasible program with repeated rows and sums of rows: many bounds are reached at once.
    fn degenerate<const N: usize, const M: usize>(&mut self) -> Program<N, M> {
        let mut program = self.feasible::<N, M>();
        let Rows { normals, lower, upper } = &mut program.rows;
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
        let Rows { normals, lower, upper } = &mut program.rows;
        normals[1] = -normals[0];
        lower[1] = -lower[0] + 0.1 + 0.1 * self.next().abs();
        upper[1] = lower[1] + 1.0;
        program
    }
}

fn solved<const N: usize, const M: usize>(program: &Program<N, M>, at_once: u32) -> DualActiveSet<N, M> {
    let factor = program.hessian.cholesky().expect("positive definite").l();
    let inverse_transposed = factor.transpose().try_inverse().expect("regular");
    let mut solver = DualActiveSet::new();
    solver.start(&inverse_transposed, &program.gradient);
    for _ in 0..10_000 {
        if solver.advance(&program.rows, at_once) != Status::Running {
            break;
        }
    }
    solver
}

/// The oracle's solution, with the slacks and multipliers of its rows.
struct Oracle<const N: usize> {
    solution: SVector<f64, N>,
    slacks: Vec<f64>,
    multipliers: Vec<f64>,
}

impl<const N: usize> Oracle<N> {
    /// The solution with the rows that are active in the oracle's as equations: exact where the
    /// interior-point method ends early, on a program that is nearly degenerate.
    fn polished<const M: usize>(&self, program: &Program<N, M>) -> SVector<f64, N> {
        let Rows { normals, lower, upper } = &program.rows;
        let active: Vec<usize> = (0..2 * M).filter(|&i| self.multipliers[i] > self.slacks[i]).collect();
        let size = N + active.len();
        let mut matrix = DMatrix::zeros(size, size);
        let mut right = DVector::zeros(size);
        matrix.view_mut((0, 0), (N, N)).copy_from(&program.hessian);
        right.rows_mut(0, N).copy_from(&-program.gradient);
        for (k, &i) in active.iter().enumerate() {
            let row = i % M;
            matrix.view_mut((0, N + k), (N, 1)).copy_from(&normals[row]);
            matrix.view_mut((N + k, 0), (1, N)).copy_from(&normals[row].transpose());
            right[N + k] = if i < M { upper[row] } else { lower[row] };
        }
        let solution = matrix.svd(true, true).solve(&right, 1e-12).expect("both sides are computed");
        solution.fixed_rows::<N>(0).into()
    }
}

/// The oracle's solution, or none if it finds that there is none.
fn oracle<const N: usize, const M: usize>(program: &Program<N, M>) -> Option<Oracle<N>> {
    let upper_triangle = SMatrix::<f64, N, N>::from_fn(|i, j| if i <= j { program.hessian[(i, j)] } else { 0.0 });
    let dense = |rows: usize, columns: usize, value: &dyn Fn(usize, usize) -> f64| {
        let lines: Vec<Vec<f64>> = (0..rows).map(|i| (0..columns).map(|j| value(i, j)).collect()).collect();
        CscMatrix::from(&lines)
    };
    let Rows { normals, lower, upper } = &program.rows;
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
        _ => Some(Oracle {
            solution: SVector::from_column_slice(&solver.solution.x),
            slacks: solver.solution.s.clone(),
            multipliers: solver.solution.z.clone(),
        }),
    }
}

fn objective<const N: usize, const M: usize>(program: &Program<N, M>, u: &SVector<f64, N>) -> f64 {
    0.5 * u.dot(&(program.hessian * u)) + program.gradient.dot(u)
}

fn compare<const N: usize, const M: usize>(program: &Program<N, M>) {
    let solver = solved(program, 1 << 20);
    let expected = oracle(program);
    match expected {
        None => assert!(solver.given_up() > 0, "found a solution where there is none"),
        Some(expected) => {
            assert_eq!(solver.given_up(), 0, "gave up rows of a program that has a solution");
            assert_eq!(solver.status(), Status::Solved);
            let mut error = (solver.solution() - expected.solution).amax();
            if error > 1e-7 {
                error = (solver.solution() - expected.polished(program)).amax();
            }
            let (ours, theirs) = (objective(program, solver.solution()), objective(program, &expected.solution));
            assert!(error <= 1e-7, "off by {error:e}, objective {ours:e} beside {theirs:e}");
        }
    }
    let values = SVector::<f64, M>::from_fn(|row, _| program.rows.normals[row].dot(solver.solution()));
    if solver.given_up() == 0 {
        let Rows { lower, upper, .. } = &program.rows;
        let violation = (lower - values).max().max((values - upper).max());
        assert!(violation <= 1e-9, "violated by {violation:e}");
    }
}

#[test]
fn random_programs_have_the_solution_that_an_interior_point_method_finds() {
    compare_feasible(1, 300);
}

#[test]
fn degenerate_programs_are_solved() {
    compare_degenerate(2, 300);
}

#[test]
#[ignore = "takes minutes: 100,000 programs"]
fn a_hundred_thousand_programs_have_the_solution_that_an_interior_point_method_finds() {
    compare_feasible(11, 20_000);
    compare_degenerate(12, 15_000);
    let mut random = Random(13);
    for _ in 0..10_000 {
        compare(&random.infeasible::<16, 40>());
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
