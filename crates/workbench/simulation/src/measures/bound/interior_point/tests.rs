//! The solver against another one, clarabel, and on machines far from any real one.

use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::{NonnegativeConeT, ZeroConeT};
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus};
use nalgebra::RowSVector;

use super::super::program::{Program, relaxed, relaxed_with_tilt, restricted, restricted_with_tilt};
use super::super::projection::Projection;
use super::super::{AxisLimits, TiltLimits, certificate};
use super::{NotSolved, solve, solve_within};

const TILT: TiltLimits = TiltLimits { angle: 0.38, rate: 0.05, acceleration: 0.2, head_height: 1.2, gravity: 9.80665 };
const SURGE: AxisLimits = AxisLimits { min: -0.45, max: 0.4, velocity: 1.0, acceleration: 10.0, tilt: Some(TILT) };

/// Numbers between 0 and 1 that look random and are always the same.
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / f64::from(1u32 << 31)
    }
}

fn waves(count: usize, interval: f64, size: f64) -> Vec<Projection> {
    let force =
        |k: usize| size * ((0.9 * k as f64 * interval).sin() + 0.4 * (7.0 * k as f64 * interval).sin().signum());
    (0..count).map(|k| Projection::of_line(&[force(k), force(k + 1)])).collect()
}

/// Rows of a sparse matrix and the right side.
#[derive(Default)]
struct Table {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
    right: Vec<f64>,
}

impl Table {
    fn push(&mut self, terms: &[(usize, f64)], right: f64) {
        for &(column, value) in terms {
            self.rows.push(self.right.len());
            self.columns.push(column);
            self.values.push(value);
        }
        self.right.push(right);
    }

    fn between(&mut self, terms: &[(usize, f64)], min: f64, max: f64) {
        let opposite: Vec<_> = terms.iter().map(|&(column, value)| (column, -value)).collect();
        self.push(terms, max);
        self.push(&opposite, -min);
    }
}

/// Clarabel's least value. The variables are all states, inputs and errors of each interval.
fn least_value<const N: usize, const U: usize, const R: usize>(program: &Program<N, U, R>) -> f64 {
    let Program { felt, desired, limited, min, max } = program;
    let motion = program.motion();
    let intervals = desired.len();
    let stride = N + U + 2;
    let terms = |k: usize, of_state: RowSVector<f64, N>, of_input: RowSVector<f64, U>, end: &[(usize, f64)]| {
        let coefficients = of_state.iter().chain(&of_input).copied().enumerate().collect::<Vec<_>>();
        let here = coefficients.into_iter().map(|(index, value)| (stride * k + index, value));
        here.chain(end.iter().copied()).collect::<Vec<_>>()
    };
    let (mut table, mut limits) = (Table::default(), Table::default());
    for n in 0..N {
        table.push(&[(n, 1.0)], 0.0);
    }
    for (k, desired) in desired.iter().enumerate() {
        for n in 0..N {
            let end = [(stride * (k + 1) + n, -1.0)];
            table.push(&terms(k, motion.of_state.row(n).into(), motion.of_input.row(n).into(), &end), 0.0);
        }
        for (row, desired) in desired.iter().enumerate() {
            let end = [(stride * k + N + U + row, -1.0)];
            table.push(&terms(k, felt.of_state.row(row).into(), felt.of_input.row(row).into(), &end), *desired);
        }
        for row in 0..R {
            let terms = terms(k, limited.of_state.row(row).into(), limited.of_input.row(row).into(), &[]);
            limits.between(&terms, min[row], max[row]);
        }
    }
    let variables = stride * intervals + N;
    let errors: Vec<usize> = (0..intervals).flat_map(|k| [stride * k + N + U, stride * k + N + U + 1]).collect();
    let quadratic =
        CscMatrix::new_from_triplets(variables, variables, errors.clone(), errors.clone(), vec![1.0; errors.len()]);
    let (equal, unequal) = (table.right.len(), limits.right.len());
    let matrix = CscMatrix::new_from_triplets(
        equal + unequal,
        variables,
        table.rows.into_iter().chain(limits.rows.into_iter().map(|row| row + equal)).collect(),
        [table.columns, limits.columns].concat(),
        [table.values, limits.values].concat(),
    );
    let right = [table.right, limits.right].concat();
    let cones = [ZeroConeT(equal), NonnegativeConeT(unequal)];
    let settings = DefaultSettings { verbose: false, ..DefaultSettings::default() };
    let mut solver = DefaultSolver::new(&quadratic, &vec![0.0; variables], &matrix, &right, &cones, settings).unwrap();
    solver.solve();
    assert_eq!(solver.solution.status, SolverStatus::Solved);
    solver.solution.obj_val
}

fn assert_least<const N: usize, const U: usize, const R: usize>(program: &Program<N, U, R>) {
    let solution = solve(program).unwrap();
    let errors = (0..program.desired.len()).map(|k| program.error(k, &solution.states[k], &solution.inputs[k]));
    let value = 0.5 * errors.map(|error| error.norm_squared()).sum::<f64>();
    let bound = certificate::lower_bound(program, &solution);
    let expected = least_value(program);
    assert!(expected > 0.1, "{expected}");
    assert!(bound <= expected * (1.0 + 1e-6) && expected <= value * (1.0 + 1e-6), "{bound} {expected} {value}");
    assert!(value - bound < 1e-5 * expected, "{bound} {expected} {value}");
}

#[test]
fn all_programs_have_the_value_that_another_solver_finds() {
    for (interval, size) in [(0.02, 6.0), (0.1, 3.0)] {
        let desired = waves(400, interval, size);
        assert_least(&relaxed(&desired, interval, &SURGE));
        assert_least(&restricted(&desired, interval, &SURGE));
        assert_least(&relaxed_with_tilt(&desired, interval, &SURGE, &TILT));
        assert_least(&restricted_with_tilt(&desired, interval, &SURGE, &TILT));
    }
}

/// The best value so far and its bound, wherever the solver gives up.
#[test]
fn the_least_value_lies_between_the_best_and_its_bound() {
    let program = relaxed(&waves(400, 0.02, 6.0), 0.02, &SURGE);
    let expected = least_value(&program);
    let mut gaps = Vec::new();
    for iterations in [0, 1, 2, 3, 5] {
        let Err(NotSolved { value, least }) = solve_within(&program, iterations) else { panic!("{iterations}") };
        assert!(least <= expected && expected <= value, "{iterations}: {least} {expected} {value}");
        gaps.push(value - least);
    }
    assert!(gaps.is_sorted_by(|before, after| before > after), "{gaps:?}");
}

#[test]
fn machines_and_forces_over_five_decades_are_solved() {
    let mut random = random(11);
    let mut between = |low: f64, high: f64| low * (high / low).powf(random());
    for _ in 0..60 {
        let tilt = TiltLimits {
            angle: between(1e-3, 1.5),
            rate: between(1e-3, 3.0),
            acceleration: between(1e-3, 30.0),
            head_height: between(0.01, 3.0),
            gravity: 9.80665,
        };
        let limits = AxisLimits {
            min: -between(1e-4, 10.0),
            max: between(1e-4, 10.0),
            velocity: between(0.01, 10.0),
            acceleration: between(0.01, 100.0),
            tilt: Some(tilt),
        };
        let interval = between(1e-3, 0.3);
        let desired = waves(between(2.0, 1000.0) as usize, interval, between(1e-6, 300.0));
        solve(&relaxed_with_tilt(&desired, interval, &limits, &tilt)).unwrap();
        solve(&restricted_with_tilt(&desired, interval, &limits, &tilt)).unwrap();
    }
}
