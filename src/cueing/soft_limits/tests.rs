//! The nearest accelerations against an interior-point solver. The ranges along approaches.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};

use super::nearest::PENALTY;
use super::*;
use crate::cueing::strategy::predictive::dual_active_set::tests::Random;

/// The least of 1/2 (c - d)' W (c - d) + penalty/2 |s|^2 with lower - s <= normals c <= upper + s,
/// over the accelerations c and the violations s.
fn by_interior_point(demand: &Accelerations, inverse_weights: &Accelerations, rows: &Rows) -> Accelerations {
    const SIZE: usize = 6 + ROWS;
    let mut hessian = vec![vec![0.0; SIZE]; SIZE];
    let mut gradient = vec![0.0; SIZE];
    for k in 0..6 {
        hessian[k][k] = 1.0 / inverse_weights[k];
        gradient[k] = -demand[k] / inverse_weights[k];
    }
    for (k, row) in hessian.iter_mut().enumerate().skip(6) {
        row[k] = PENALTY;
    }
    let (mut constraints, mut bounds) = (Vec::new(), Vec::new());
    for row in 0..ROWS {
        for (sign, bound) in [(1.0, rows.upper[row]), (-1.0, -rows.lower[row])] {
            let mut normal: Vec<f64> = rows.normals.row(row).iter().map(|value| sign * value).collect();
            normal.resize(SIZE, 0.0);
            normal[6 + row] = -1.0;
            constraints.push(normal);
            bounds.push(bound);
        }
    }
    let cones = [NonnegativeConeT(bounds.len())];
    let settings = DefaultSettingsBuilder::default().verbose(false).build().unwrap();
    let (hessian, constraints) = (CscMatrix::from(&hessian), CscMatrix::from(&constraints));
    let mut solver = DefaultSolver::new(&hessian, &gradient, &constraints, &bounds, &cones, settings).unwrap();
    solver.solve();
    assert_eq!(solver.solution.status, SolverStatus::Solved);
    Accelerations::from_column_slice(&solver.solution.x[..6])
}

/// What the nearest accelerations minimise.
fn cost(accelerations: &Accelerations, demand: &Accelerations, rows: &Rows) -> f64 {
    let changed = accelerations - demand;
    let values = rows.normals * accelerations;
    let violations =
        values.zip_zip_map(&rows.lower, &rows.upper, |value, lower, upper| value - value.clamp(lower, upper));
    0.5 * changed.component_mul(&Accelerations::from(WEIGHTS)).dot(&changed) + 0.5 * PENALTY * violations.norm_squared()
}

#[test]
fn the_nearest_accelerations_are_those_of_an_interior_point_method() {
    let mut random = Random(5);
    let inverse_weights = Accelerations::from(WEIGHTS.map(|weight| 1.0 / weight));
    let mut acted = 0;
    for trial in 0..2000 {
        let mut normals = SMatrix::<f64, ROWS, 6>::from_fn(|_, _| random.next());
        normals.fixed_view_mut::<3, 6>(0, 0).fill(0.0);
        normals.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        // Every tenth program has rows that contradict each other.
        let apart = if trial % 10 == 0 { -0.5 } else { 1.0 };
        let middle = RowValues::from_fn(|_, _| 3.0 * random.next());
        let half = RowValues::from_fn(|_, _| 1.0 + apart * random.next().abs());
        let rows = Rows { normals, lower: middle - half, upper: middle + half };
        let demand = Accelerations::from_fn(|_, _| 10.0 * random.next());
        let mut sides = Sides::default();
        let found = nearest(&demand, &inverse_weights, &rows, &mut sides);
        let expected = by_interior_point(&demand, &inverse_weights, &rows);
        // The cost is strictly convex: none is less but by the solver's tolerance.
        let [least, found_by_solver] = [&found, &expected].map(|accelerations| cost(accelerations, &demand, &rows));
        assert!(least < found_by_solver * (1.0 + 1e-8), "trial {trial}: {least} beside {found_by_solver}");
        assert!((found - expected).amax() < 3e-4, "trial {trial}: {found} beside {expected}");
        // From the sides that act, the solution is found again, to the rounding of the largest multipliers.
        let again = (nearest(&demand, &inverse_weights, &rows, &mut sides) - found).amax();
        assert!(again < 3e-16 * PENALTY, "trial {trial}: {again}");
        acted += usize::from(sides.any());
    }
    assert!(acted > 1900, "{acted}");
}

#[test]
fn a_demand_within_its_ranges_is_the_nearest() {
    let normals = SMatrix::<f64, ROWS, 6>::from_fn(|row, k| f64::from(u8::from(row % 6 == k)));
    let rows = Rows { normals, lower: RowValues::repeat(-2.0), upper: RowValues::repeat(2.0) };
    let demand = Accelerations::new(1.0, -1.9, 0.3, 2.0, -2.0, 0.0);
    let mut sides = Sides::default();
    assert_eq!(nearest(&demand, &Accelerations::repeat(1.0), &rows, &mut sides), demand);
    assert!(!sides.any());
}

/// At the upper bound of its acceleration a quantity approaches the end of its range as a
/// critically damped system from there on, and never passes it.
#[test]
fn an_end_is_approached_critically_damped_and_never_passed() {
    const STEP: f64 = 1e-4;
    let (pace, margin) = (5.0, 0.01);
    let ends = Ends::new([-0.45, 0.45], 1.0, 10.0, margin);
    assert!((ends.max - 0.44).abs() < 1e-15 && (ends.min + 0.44).abs() < 1e-15);
    let narrow = Ends::new([-0.01, 0.01], 1.0, 10.0, margin);
    assert!((narrow.max - 0.005).abs() < 1e-15, "at most a quarter of the range");
    let (mut x, mut v) = (0.0, 0.3);
    for k in 0..100_000 {
        let (lower, upper) = ends.range(x, v, pace);
        assert!(lower <= upper && upper <= 9.5 && lower >= -9.5);
        let time = f64::from(k) * STEP;
        let (start, slope) = (-ends.max, 0.3);
        let exact = ends.max + (start + (slope + pace * start) * time) * (-pace * time).exp();
        assert!((x - exact).abs() < 1e-3, "{x} beside {exact} after {time} s");
        assert!(x < ends.max);
        v += upper * STEP;
        x += v * STEP;
    }
    assert!(ends.max - x < 1e-6);
}

#[test]
fn a_velocity_limit_is_approached_as_well() {
    let ends = Ends::new([-1e3, 1e3], 1.0, 10.0, 0.0);
    assert!((ends.range(0.0, 0.9, 0.1).1 - 2.5).abs() < 1e-12);
    assert!((ends.range(0.0, -0.9, 0.1).0 + 2.5).abs() < 1e-12);
}
