//! The nearest accelerations against an interior-point solver. The ranges along approaches.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};

use super::nearest::VIOLATION_PENALTY;
use super::*;
use crate::cueing::strategy::predictive::dual_active_set::tests::Random;

/// The least of 1/2 (c - d)' W (c - d) + penalty/2 |s|^2 with lower - s <= normals c <= upper + s,
/// over the accelerations c and the violations s.
fn by_interior_point(demand: &Accelerations, inverse_weights: &Accelerations, rows: &Rows) -> Accelerations {
    const SIZE: usize = 6 + ROW_COUNT;
    let mut hessian = vec![vec![0.0; SIZE]; SIZE];
    let mut gradient = vec![0.0; SIZE];
    for k in 0..6 {
        hessian[k][k] = 1.0 / inverse_weights[k];
        gradient[k] = -demand[k] / inverse_weights[k];
    }
    for (k, row) in hessian.iter_mut().enumerate().skip(6) {
        row[k] = VIOLATION_PENALTY;
    }
    let (mut constraints, mut bounds) = (Vec::new(), Vec::new());
    for row in 0..ROW_COUNT {
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

/// Cost that the nearest accelerations minimise.
fn cost(accelerations: &Accelerations, demand: &Accelerations, rows: &Rows) -> f64 {
    let changed = accelerations - demand;
    let values = rows.normals * accelerations;
    let violations =
        values.zip_zip_map(&rows.lower, &rows.upper, |value, lower, upper| value - value.clamp(lower, upper));
    0.5 * changed.component_mul(&Accelerations::from(CHANGE_WEIGHTS)).dot(&changed)
        + 0.5 * VIOLATION_PENALTY * violations.norm_squared()
}

#[test]
fn the_nearest_accelerations_are_those_of_an_interior_point_method() {
    let mut random = Random(5);
    let inverse_weights = Accelerations::from(CHANGE_WEIGHTS.map(|weight| 1.0 / weight));
    let mut acted = 0;
    for trial in 0..2000 {
        let mut normals = SMatrix::<f64, ROW_COUNT, 6>::from_fn(|_, _| random.next());
        normals.fixed_view_mut::<3, 6>(0, 0).fill(0.0);
        normals.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        // Every tenth program has rows that contradict each other.
        let apart = if trial % 10 == 0 { -0.5 } else { 1.0 };
        let middle = RowValues::from_fn(|_, _| 3.0 * random.next());
        let half = RowValues::from_fn(|_, _| 1.0 + apart * random.next().abs());
        let rows = Rows { normals, lower: middle - half, upper: middle + half };
        let demand = Accelerations::from_fn(|_, _| 10.0 * random.next());
        let mut acting_rows = ActingRows::default();
        let found = nearest_accelerations(&demand, &inverse_weights, &rows, &mut acting_rows);
        let expected = by_interior_point(&demand, &inverse_weights, &rows);
        // The cost is strictly convex: none is less but by the solver's tolerance.
        let [least, found_by_solver] = [&found, &expected].map(|accelerations| cost(accelerations, &demand, &rows));
        assert!(least < found_by_solver * (1.0 + 1e-8), "trial {trial}: {least} beside {found_by_solver}");
        assert!((found - expected).amax() < 3e-4, "trial {trial}: {found} beside {expected}");
        // From the acting_rows that act, the solution is found again, to the rounding of the largest multipliers.
        let again = (nearest_accelerations(&demand, &inverse_weights, &rows, &mut acting_rows) - found).amax();
        assert!(again < 3e-16 * VIOLATION_PENALTY, "trial {trial}: {again}");
        acted += usize::from(acting_rows.any());
    }
    assert!(acted > 1900, "{acted}");
}

#[test]
fn a_demand_within_its_ranges_is_the_nearest() {
    let normals = SMatrix::<f64, ROW_COUNT, 6>::from_fn(|row, k| f64::from(u8::from(row % 6 == k)));
    let rows = Rows { normals, lower: RowValues::repeat(-2.0), upper: RowValues::repeat(2.0) };
    let demand = Accelerations::new(1.0, -1.9, 0.3, 2.0, -2.0, 0.0);
    let mut acting_rows = ActingRows::default();
    assert_eq!(nearest_accelerations(&demand, &Accelerations::repeat(1.0), &rows, &mut acting_rows), demand);
    assert!(!acting_rows.any());
}

/// At the upper bound of its acceleration a quantity approaches the end of its range as a
/// critically damped system from there on, and never passes it.
#[test]
fn an_end_is_approached_critically_damped_and_never_passed() {
    const STEP: f64 = 1e-4;
    let (pace, margin) = (5.0, 0.01);
    let ends = ApproachLimits::new([-0.45, 0.45], [0.0; 2], 1.0, 10.0, margin, pace);
    assert!((ends.max - 0.44).abs() < 1e-15 && (ends.min + 0.44).abs() < 1e-15);
    let narrow = ApproachLimits::new([-0.01, 0.01], [0.0; 2], 1.0, 10.0, margin, pace);
    assert!((narrow.max - 0.005).abs() < 1e-15, "at most half the clearance at neutral");
    let low = ApproachLimits::new([0.7, 1.0], [0.704, 0.706], 1.0, 10.0, margin, pace);
    assert!((low.min - 0.702).abs() < 1e-15 && (low.max - 0.99).abs() < 1e-15);
    assert!((low.neutral_clearance[0] - 0.002).abs() < 1e-15 && (low.neutral_clearance[1] - 0.284).abs() < 1e-15);
    // From here on psi is in its linear part.
    let (mut x, mut v) = (0.3, 0.3);
    for k in 0..100_000 {
        let (lower, upper) = ends.range(x, v, pace);
        assert!(lower <= upper && upper <= 9.5 && lower >= -9.5);
        let time = f64::from(k) * STEP;
        let (start, slope) = (0.3 - ends.max, 0.3);
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
    let ends = ApproachLimits::new([-1e3, 1e3], [0.0; 2], 1.0, 10.0, 0.0, 5.0);
    // 25/s times the distance up to 1 m/s2, then sqrt(2 (25 m/s3) distance - (1 m/s2)^2).
    for (distance, expected) in [(0.02, 0.5), (0.04, 1.0), (0.1, 2.0), (0.34, 4.0)] {
        assert!((ends.range(0.0, 1.0 - distance, 0.1).1 - expected).abs() < 1e-12);
        assert!((ends.range(0.0, distance - 1.0, 0.1).0 + expected).abs() < 1e-12);
    }
}

/// Accelerations of a quantity that is demanded to accelerate at 4 m/s2 towards its end, from rest.
fn accelerated(ends: &ApproachLimits, pace: f64, step: f64) -> Vec<f64> {
    let (mut x, mut v) = (0.0, 0.0);
    let one = |_| {
        let acceleration = min(4.0, ends.range(x, v, pace).1);
        x += step * (v + 0.5 * step * acceleration);
        v += step * acceleration;
        acceleration
    };
    (0..20_000).map(one).collect()
}

#[test]
fn the_acceleration_towards_a_limit_ends_gently() {
    const STEP: f64 = 1e-3;
    let by_velocity = accelerated(&ApproachLimits::new([-1e3, 1e3], [0.0; 2], 1.0, 10.0, 0.0, 5.0), 5.0, STEP);
    let by_position = accelerated(&ApproachLimits::new([-0.4, 0.4], [0.0; 2], 10.0, 100.0, 0.0, 5.0), 5.0, STEP);
    let slopes = |course: &[f64]| course.windows(2).map(|pair| (pair[0] - pair[1]) / STEP).collect::<Vec<f64>>();
    let steepest = slopes(&by_velocity).into_iter().fold(0.0, f64::max);
    assert!((24.0..25.5).contains(&steepest), "{steepest} m/s3");
    for (slope, acceleration) in slopes(&by_position).into_iter().zip(by_position) {
        assert!(slope < 1.05 * (15.0 + 5.0 * max(acceleration, 0.0)), "{slope} m/s3 at {acceleration} m/s2");
    }
}

#[test]
fn weak_actuators_are_never_faster_than_they_can_brake() {
    for (acceleration, fastest) in [(0.8, 0.16), (2.0, 0.4), (10.0, 1.0)] {
        let ends = ApproachLimits::new([-1.0, 1.0], [0.0; 2], 1.0, acceleration, 0.0, 5.0);
        assert!((ends.velocity - fastest).abs() < 1e-15);
        let hardest = accelerated(&ends, 5.0, 1e-3).into_iter().fold(0.0, min);
        assert!(hardest > -0.95 * acceleration, "{hardest} of {acceleration} m/s2");
    }
    assert_eq!(ApproachLimits::new([-1.0, 1.0], [0.0; 2], 1.0, 0.8, 0.0, 0.0).velocity, 1.0, "switched off");
}

/// Where the quick check says that an acceleration is within its range, it is.
#[test]
fn what_a_pair_accepts_is_within_the_ranges() {
    let (ends, pace) = (ApproachLimits::new([0.9, 1.6], [1.2, 1.3], 1.0, 10.0, 0.01, 5.0), 5.0);
    let both = ApproachLimitPair::of([ends; 2], pace);
    let mut random = Random(3);
    let (mut accepted, mut within) = (0, 0);
    for _ in 0..100_000 {
        let [position, velocity, acceleration] = [1.25 + 0.35 * random.next(), random.next(), 8.0 * random.next()];
        let (lower, upper) = ends.range(position, velocity, pace);
        let inside = (lower..=upper).contains(&acceleration);
        let two = |value: f64| f64x2::splat(value);
        let is_within = both.is_within(two(position), two(velocity), two(acceleration), pace).move_mask() == 0b11;
        assert!(inside || !is_within, "{position} m, {velocity} m/s, {acceleration} m/s2");
        accepted += usize::from(is_within);
        within += usize::from(inside);
    }
    assert!(accepted > within * 8 / 10 && within > 10_000, "{accepted} of {within}");
}

#[test]
fn a_relaxation_leaves_neutral_within_the_limits() {
    let ends = ApproachLimits::new([-0.1, 0.4], [0.0; 2], 1.0, 10.0, 0.0, 5.0);
    let direction = Vector3::x();
    // A tilt that would make limits relax by far more than the clearance permits.
    for side in [1.0, -1.0] {
        let mut relaxation = Relaxation::default();
        for _ in 0..3000 {
            relaxation = relaxation.accelerated(&(side * direction)).after(1e-3);
            // At rest at neutral neither limit pushes.
            let (lower, upper) = relaxation.accelerated(&Vector3::zeros()).range(&ends, [0.0; 2], &direction, 5.0);
            assert!(lower < 0.0 && upper > 0.0, "{lower}, {upper}");
        }
    }
    assert_eq!([0.025, 0.1, 0.3].map(Relaxation::fraction_within), [0.25, 1.0, 1.0]);
}
