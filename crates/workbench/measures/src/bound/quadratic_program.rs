//! The quadratic program: minimise x'Px/2 subject to Ax + s = b, s = 0 for equalities
//! and s >= 0 for the rest.
//!
//! Time is divided into intervals of length T. The variables at each end of an interval are the
//! position p, the velocity v, the tilt q and its rate q'. The tilt is expressed as the force that
//! it adds, q = g sin(tilt) (`tilt_force`).
//!
//! A signal's mean and slope over an interval are its projections on the orthogonal functions 1 and
//! w = sqrt(12) (t/T - 1/2), each with a mean square of 1. The variables of an interval are the
//! mean e and the slope d of the error, and the mean m and the slope n of the tilt. The mean square
//! of the error over an interval is at least e² + d². Of p'', both follow from the ends, for any
//! motion:
//!
//! - mean: (v_k+1 - v_k)/T;
//! - slope: sqrt(12)/T² (T (v_k + v_k+1)/2 - (p_k+1 - p_k)), by parts.
//!
//! The same holds for q''. With f and s the mean and the slope of the desired force,
//!
//! e = mean(p'') - (h/g) mean(q'') + m - f, d = slope(p'') - (h/g) slope(q'') + n - s.
//!
//! The relaxed program bounds four values over an interval, each the integral of an acceleration
//! times a known function. The bound is the acceleration's limit times the integral of the
//! function's magnitude:
//!
//! - p_k+1 - p_k less T (v_k + v_k+1)/2, by T²/4 times the limit of |p''|;
//! - q_k+1 - q_k less T (q'_k + q'_k+1)/2, by T²/4 times the limit of |q''|;
//! - m less (q_k + q_k+1)/2, by T²/12 times the limit of |q''|;
//! - n less (q_k+1 - q_k)/sqrt(12), by sqrt(12) T²/192 times the limit of |q''|.
//!
//! Both programs limit p_k+1 - p_k and q_k+1 - q_k to T times the limits of |p'| and |q'|.
//!
//! In the restricted program, accelerations are constant over an interval. The first two values and
//! the last are then zero, and the third is known. Positions and tilts are parabolas within an
//! interval. A parabola lies between the least and the greatest of its two ends and the point
//! where the tangents at its ends meet, p_k + v_k T/2. So the restricted program keeps this point
//! within the limits, too.

use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::{self, NonnegativeConeT, ZeroConeT};

use super::trajectory::{Knot, Trajectory};
use super::{AxisLimits, TiltLimits};

/// The motions that a program describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A superset of the motions that keep the limits.
    Relaxed,
    /// Some of those that keep the limits: accelerations are constant over each interval.
    Restricted,
}

/// The program in the solver's form.
pub struct QuadraticProgram {
    /// P: 1 on the diagonal for each error, 0 for the rest.
    pub quadratic: CscMatrix<f64>,
    /// All zero.
    pub linear: Vec<f64>,
    /// A: equalities first.
    pub matrix: CscMatrix<f64>,
    /// b.
    pub right: Vec<f64>,
    /// Numbers of equalities and inequalities.
    pub cones: [SupportedConeT<f64>; 2],
    /// Largest value of a variable in any motion within the limits; infinite for the errors.
    pub largest: Vec<f64>,
    intervals: usize,
    interval: f64,
    arm: f64,
}

/// Number of variables at an end of an interval.
const AT: usize = 4;
/// Number of variables at an end of an interval and of the interval that follows.
const STRIDE: usize = 8;

/// Indices of the variables.
fn position(k: usize) -> usize {
    STRIDE * k
}
fn velocity(k: usize) -> usize {
    STRIDE * k + 1
}
fn tilt(k: usize) -> usize {
    STRIDE * k + 2
}
fn tilt_rate(k: usize) -> usize {
    STRIDE * k + 3
}
fn error(k: usize) -> usize {
    STRIDE * k + AT
}
fn error_slope(k: usize) -> usize {
    STRIDE * k + AT + 1
}
fn mean_tilt(k: usize) -> usize {
    STRIDE * k + AT + 2
}
fn tilt_slope(k: usize) -> usize {
    STRIDE * k + AT + 3
}

/// Mean and slope of a signal over an interval: its projections on 1 and
/// sqrt(12) (t/T - 1/2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    pub mean: f64,
    pub slope: f64,
}

impl Projection {
    /// Those of a signal that is linear between samples with equal distances. Simpson's rule is
    /// exact for it.
    pub fn of_line(samples: &[f64]) -> Self {
        let steps = (samples.len() - 1) as f64;
        let (mut mean, mut slope) = (0.0, 0.0);
        for (k, pair) in samples.windows(2).enumerate() {
            let weight = |places: f64| (k as f64 + places) / steps - 0.5;
            let middle = 0.5 * (pair[0] + pair[1]);
            mean += middle / steps;
            slope += (weight(0.0) * pair[0] + 4.0 * weight(0.5) * middle + weight(1.0) * pair[1]) / (6.0 * steps);
        }
        Projection { mean, slope: slope * 12_f64.sqrt() }
    }
}

/// The limits in the program's terms: tilt_force = g sin(tilt) and its derivatives.
struct TiltBounds {
    tilt: f64,
    tilt_rate: f64,
    tilt_acceleration: f64,
    /// h/g \[s2\].
    arm: f64,
}

impl TiltBounds {
    /// With s = sin(tilt), |s'| <= |tilt'| and |s''| <= |tilt''| + sin(angle) tilt'^2.
    fn of(limits: &Option<TiltLimits>) -> Self {
        match limits {
            None => TiltBounds { tilt: 0.0, tilt_rate: 0.0, tilt_acceleration: 0.0, arm: 0.0 },
            Some(TiltLimits { angle, rate, acceleration, head_height, gravity }) => TiltBounds {
                tilt: gravity * angle.sin(),
                tilt_rate: gravity * rate,
                tilt_acceleration: gravity * (acceleration + angle.sin() * rate * rate),
                arm: head_height / gravity,
            },
        }
    }
}

impl QuadraticProgram {
    /// The program for these projections of the desired force over each interval.
    pub fn new(desired: &[Projection], interval: f64, limits: &AxisLimits, kind: Kind) -> Self {
        let intervals = desired.len();
        let bounds = TiltBounds::of(&limits.tilt);
        let mut rows = Rows::default();
        for variable in [position(0), velocity(0), tilt(0), tilt_rate(0)] {
            rows.equal(&[(variable, 1.0)], 0.0);
        }
        let (t, root) = (interval, 12_f64.sqrt());
        for (k, projection) in desired.iter().enumerate() {
            let (v0, v1, r0, r1) = (velocity(k), velocity(k + 1), tilt_rate(k), tilt_rate(k + 1));
            let (p0, p1, q0, q1) = (position(k), position(k + 1), tilt(k), tilt(k + 1));
            let (arm, m, n) = (bounds.arm, mean_tilt(k), tilt_slope(k));
            let mean = [(error(k), t), (v1, -1.0), (v0, 1.0), (r1, arm), (r0, -arm), (m, -t)];
            rows.equal(&mean, -t * projection.mean);
            let (ends, drift) = (0.5 * root, root / t);
            let motion = [(v0, -ends), (v1, -ends), (p1, drift), (p0, -drift)];
            let turning = [(r0, arm * ends), (r1, arm * ends), (q1, -arm * drift), (q0, arm * drift)];
            let slope = [&[(error_slope(k), t), (n, -t)][..], &motion, &turning].concat();
            rows.equal(&slope, -t * projection.slope);

            rows.within(&[(v1, 1.0), (v0, -1.0)], t * limits.acceleration);
            rows.within(&[(v1, 1.0)], limits.velocity);
            rows.within(&[(p1, 1.0), (p0, -1.0)], t * limits.velocity);
            rows.between(&[(p1, 1.0)], limits.min, limits.max);
            let way = [(p1, 1.0), (p0, -1.0), (v0, -0.5 * t), (v1, -0.5 * t)];
            let turn = [(p0, 1.0), (v0, 0.5 * t)];
            let tilting = [(q1, 1.0), (q0, -1.0), (r0, -0.5 * t), (r1, -0.5 * t)];
            let sag = [(m, 1.0), (q0, -0.5), (q1, -0.5)];
            let skew = [(n, 1.0), (q1, -1.0 / root), (q0, 1.0 / root)];
            let tilts = limits.tilt.is_some();
            if tilts {
                rows.within(&[(r1, 1.0), (r0, -1.0)], t * bounds.tilt_acceleration);
                rows.within(&[(r1, 1.0)], bounds.tilt_rate);
                rows.within(&[(q1, 1.0), (q0, -1.0)], t * bounds.tilt_rate);
                rows.within(&[(q1, 1.0)], bounds.tilt);
            }
            match kind {
                Kind::Relaxed if tilts => {
                    rows.within(&way, t.powi(2) / 4.0 * limits.acceleration);
                    rows.within(&tilting, t.powi(2) / 4.0 * bounds.tilt_acceleration);
                    rows.within(&sag, t.powi(2) / 12.0 * bounds.tilt_acceleration);
                    rows.within(&skew, root * t.powi(2) / 192.0 * bounds.tilt_acceleration);
                }
                Kind::Relaxed => rows.within(&way, t.powi(2) / 4.0 * limits.acceleration),
                Kind::Restricted if tilts => {
                    rows.between(&turn, limits.min, limits.max);
                    rows.within(&[(q0, 1.0), (r0, 0.5 * t)], bounds.tilt);
                    rows.equal(&way, 0.0);
                    rows.equal(&tilting, 0.0);
                    rows.equal(&skew, 0.0);
                    let [mean, before, after] = sag;
                    rows.equal(&[mean, before, after, (r1, t / 12.0), (r0, -t / 12.0)], 0.0);
                }
                Kind::Restricted => {
                    rows.between(&turn, limits.min, limits.max);
                    rows.equal(&way, 0.0);
                }
            }
            if !tilts {
                for variable in [q1, r1, m, n] {
                    rows.equal(&[(variable, 1.0)], 0.0);
                }
            }
        }
        let variables = STRIDE * intervals + AT;
        let farthest = limits.max.max(-limits.min);
        let errors = [f64::INFINITY; 2];
        // The slope of what is at most q in magnitude is at most sqrt(12)/4 q.
        let tilts = [bounds.tilt; 2];
        let ends = [farthest, limits.velocity, bounds.tilt, bounds.tilt_rate];
        let largest = [&ends[..], &errors, &tilts].concat();
        let (matrix, right, cones) = rows.assemble(variables);
        QuadraticProgram {
            quadratic: ones_at((0..intervals).flat_map(|k| [error(k), error_slope(k)]), variables),
            linear: vec![0.0; variables],
            matrix,
            right,
            cones,
            largest: largest.into_iter().cycle().take(variables).collect(),
            intervals,
            interval,
            arm: bounds.arm,
        }
    }

    /// The motion that a solution describes.
    pub fn trajectory(&self, x: &[f64]) -> Trajectory {
        let knot = |k| Knot {
            position: x[position(k)],
            velocity: x[velocity(k)],
            tilt_force: x[tilt(k)],
            tilt_force_rate: x[tilt_rate(k)],
        };
        Trajectory { interval: self.interval, arm: self.arm, knots: (0..=self.intervals).map(knot).collect() }
    }
}

/// A diagonal matrix with ones at these indices.
fn ones_at(places: impl Iterator<Item = usize>, size: usize) -> CscMatrix<f64> {
    let places: Vec<usize> = places.collect();
    let ones = vec![1.0; places.len()];
    CscMatrix::new_from_triplets(size, size, places.clone(), places, ones)
}

/// Rows of A and b, in the order in which they are added.
#[derive(Default)]
struct Rows {
    equalities: Entries,
    inequalities: Entries,
}

/// Rows of one cone: entries of A by row, column and value, and b.
#[derive(Default)]
struct Entries {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
    right: Vec<f64>,
}

impl Entries {
    fn push(&mut self, terms: &[(usize, f64)], sign: f64, right: f64) {
        for &(column, value) in terms {
            self.rows.push(self.right.len());
            self.columns.push(column);
            self.values.push(sign * value);
        }
        self.right.push(right);
    }
}

impl Rows {
    /// The sum of the terms is `value`.
    fn equal(&mut self, terms: &[(usize, f64)], value: f64) {
        self.equalities.push(terms, 1.0, value);
    }

    /// The sum of the terms is between `min` and `max`.
    fn between(&mut self, terms: &[(usize, f64)], min: f64, max: f64) {
        self.inequalities.push(terms, 1.0, max);
        self.inequalities.push(terms, -1.0, -min);
    }

    /// The sum of the terms is at most `limit`, of either sign.
    fn within(&mut self, terms: &[(usize, f64)], limit: f64) {
        self.between(terms, -limit, limit);
    }

    /// A, b and the cones, for so many variables.
    fn assemble(self, variables: usize) -> (CscMatrix<f64>, Vec<f64>, [SupportedConeT<f64>; 2]) {
        let Rows { equalities, inequalities } = self;
        let (equal, unequal) = (equalities.right.len(), inequalities.right.len());
        let rows = equalities.rows.into_iter().chain(inequalities.rows.into_iter().map(|row| row + equal)).collect();
        let columns = [equalities.columns, inequalities.columns].concat();
        let values = [equalities.values, inequalities.values].concat();
        let matrix = CscMatrix::new_from_triplets(equal + unequal, variables, rows, columns, values);
        let right = [equalities.right, inequalities.right].concat();
        (matrix, right, [ZeroConeT(equal), NonnegativeConeT(unequal)])
    }
}
