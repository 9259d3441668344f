//! The quadratic program: the least sum of squared errors over intervals of time, with a state at
//! each interval's ends and inputs within it, all of them within limits.
//!
//! The state is the position p, the velocity v, the tilt q and its rate q'. The tilt is
//! expressed as the force that it adds, q = g sin(tilt). Over an interval of length T, the
//! inputs are the means and slopes of p'' and q'' ([`Projection`]). Two more are what the tilt's
//! mean and slope have beyond those of a straight line between its ends, `offset` and `skew`. By
//! parts, for any motion:
//!
//! - v1 = v0 + T mean(p'');
//! - p1 = p0 + T v0 + T²/2 mean(p'') - T²/sqrt(12) slope(p'').
//!
//! The same holds for q. The mean square of the error over an interval is at least e² + d². With f
//! and s the mean and the slope of the desired force,
//!
//! e = mean(p'') - (h/g) mean(q'') + (q0 + q1)/2 + offset - f,
//! d = slope(p'') - (h/g) slope(q'') + (q1 - q0)/sqrt(12) + skew - s.
//!
//! In the relaxed program, an input is the integral of an acceleration times a known function, and
//! is limited by the acceleration's limit times the integral of the function's magnitude:
//!
//! - means by the limit itself, slopes by sqrt(12)/4 of it;
//! - offset by T²/12, skew by sqrt(12) T²/192 times the limit of |q''|.
//!
//! The relaxed program limits p1 - p0 and q1 - q0 to T times the limits of |p'| and |q'|.
//!
//! In the restricted program, accelerations are constant over an interval. Their slopes and
//! the skew are then zero, and offset = -T²/12 q''. Positions and tilts are parabolas within an
//! interval. A parabola lies between the least and the greatest of its two ends and the point
//! where the tangents at its ends meet, p0 + v0 T/2. So the restricted program keeps this
//! point within the limits.

use nalgebra::{Matrix2, Matrix2x4, Matrix2x6, SMatrix, SVector, Vector2};

use super::projection::Projection;
use super::{AxisLimits, TiltLimits};

/// Rows that are linear in the state at an interval's beginning and in the inputs within it.
pub struct Rows<const N: usize, const U: usize, const R: usize> {
    pub of_state: SMatrix<f64, R, N>,
    pub of_input: SMatrix<f64, R, U>,
}

impl<const N: usize, const U: usize, const R: usize> Rows<N, U, R> {
    fn zeros() -> Self {
        Rows { of_state: SMatrix::zeros(), of_input: SMatrix::zeros() }
    }

    /// The rows' values.
    pub fn of(&self, state: &SVector<f64, N>, input: &SVector<f64, U>) -> SVector<f64, R> {
        self.of_state * state + self.of_input * input
    }

    /// Coefficients of state and input in the rows' sum, each times its weight.
    pub fn weighted(&self, weights: &SVector<f64, R>) -> (SVector<f64, N>, SVector<f64, U>) {
        (self.of_state.tr_mul(weights), self.of_input.tr_mul(weights))
    }
}

/// The program with N states, U inputs and R values that have limits.
pub struct Program<const N: usize, const U: usize, const R: usize> {
    /// Mean and slope of the felt force over an interval.
    pub felt: Rows<N, U, 2>,
    /// Mean and slope of the desired force over each interval.
    pub desired: Vec<Vector2<f64>>,
    /// The values that have limits: the state at the interval's end, the inputs, further ones.
    pub limited: Rows<N, U, R>,
    /// Least values, below 0. At rest at neutral, all values are 0.
    pub min: SVector<f64, R>,
    /// Greatest values, above 0.
    pub max: SVector<f64, R>,
}

/// Limits of one double integrator: of its position, its rate and its acceleration.
struct Integrator {
    min: f64,
    max: f64,
    rate: f64,
    acceleration: f64,
}

impl Integrator {
    fn position(limits: &AxisLimits) -> Self {
        let AxisLimits { min, max, velocity, acceleration, .. } = *limits;
        Integrator { min, max, rate: velocity, acceleration }
    }

    /// The tilt q = g s with s = sin(tilt): |s'| <= |tilt'| and |s''| <=
    /// |tilt''| + sin(angle) tilt'^2.
    fn tilt(limits: &TiltLimits) -> Self {
        let TiltLimits { angle, rate, acceleration, gravity, .. } = *limits;
        Integrator {
            min: -gravity * angle.sin(),
            max: gravity * angle.sin(),
            rate: gravity * rate,
            acceleration: gravity * (acceleration + angle.sin() * rate * rate),
        }
    }
}

/// Heave in any motion.
pub fn relaxed(desired: &[Projection], interval: f64, limits: &AxisLimits) -> Program<2, 2, 5> {
    let mut program = Program::new(desired);
    program.relaxed_integrator(0, interval, &Integrator::position(limits));
    program.felt.of_input = Matrix2::identity();
    program
}

/// Heave with an acceleration that is constant over each interval.
pub fn restricted(desired: &[Projection], interval: f64, limits: &AxisLimits) -> Program<2, 1, 4> {
    let mut program = Program::new(desired);
    program.restricted_integrator(0, interval, &Integrator::position(limits));
    program.felt.of_input = Vector2::x();
    program
}

/// Surge or sway with its tilt in any motion. The inputs are the mean and the slope of p'', those
/// of q'', offset and skew.
pub fn relaxed_with_tilt(
    desired: &[Projection],
    interval: f64,
    limits: &AxisLimits,
    tilt: &TiltLimits,
) -> Program<4, 6, 12> {
    let (t, root, arm) = (interval, 12_f64.sqrt(), tilt.head_height / tilt.gravity);
    let mut program = Program::new(desired);
    let tilting = Integrator::tilt(tilt);
    program.relaxed_integrator(0, t, &Integrator::position(limits));
    program.relaxed_integrator(1, t, &tilting);
    program.limit_input(4, t.powi(2) / 12.0 * tilting.acceleration);
    program.limit_input(5, root * t.powi(2) / 192.0 * tilting.acceleration);
    let (mean, slope) = (t.powi(2) / 4.0 - arm, -arm - t.powi(2) / 12.0);
    let cross = t.powi(2) / (2.0 * root);
    program.felt = Rows {
        of_state: Matrix2x4::new(0.0, 0.0, 1.0, t / 2.0, 0.0, 0.0, 0.0, t / root),
        of_input: Matrix2x6::new(1.0, 0.0, mean, -cross, 1.0, 0.0, 0.0, 1.0, cross, slope, 0.0, 1.0),
    };
    program
}

/// Surge or sway with its tilt, with accelerations that are constant over each interval.
pub fn restricted_with_tilt(
    desired: &[Projection],
    interval: f64,
    limits: &AxisLimits,
    tilt: &TiltLimits,
) -> Program<4, 2, 8> {
    let (t, root, arm) = (interval, 12_f64.sqrt(), tilt.head_height / tilt.gravity);
    let mut program = Program::new(desired);
    program.restricted_integrator(0, t, &Integrator::position(limits));
    program.restricted_integrator(1, t, &Integrator::tilt(tilt));
    program.felt = Rows {
        of_state: Matrix2x4::new(0.0, 0.0, 1.0, t / 2.0, 0.0, 0.0, 0.0, t / root),
        of_input: Matrix2::new(1.0, t.powi(2) / 6.0 - arm, 0.0, t.powi(2) / (2.0 * root)),
    };
    program
}

impl<const N: usize, const U: usize, const R: usize> Program<N, U, R> {
    fn new(desired: &[Projection]) -> Self {
        let mut limited: Rows<N, U, R> = Rows::zeros();
        limited.of_input.fixed_rows_mut::<U>(N).fill_with_identity();
        Program {
            felt: Rows::zeros(),
            desired: desired.iter().map(|projection| Vector2::new(projection.mean, projection.slope)).collect(),
            limited,
            min: SVector::zeros(),
            max: SVector::zeros(),
        }
    }

    /// The state at an interval's end.
    pub fn motion(&self) -> Rows<N, U, N> {
        let Rows { of_state, of_input } = &self.limited;
        Rows { of_state: of_state.fixed_rows::<N>(0).into(), of_input: of_input.fixed_rows::<N>(0).into() }
    }

    fn limit(&mut self, row: usize, min: f64, max: f64) {
        (self.min[row], self.max[row]) = (min, max);
    }

    fn limit_input(&mut self, input: usize, limit: f64) {
        self.limit(N + input, -limit, limit);
    }

    /// The integrator `number`, whose inputs are the mean and the slope of its acceleration.
    fn relaxed_integrator(&mut self, number: usize, t: f64, limits: &Integrator) {
        let (position, rate, mean, slope) = (2 * number, 2 * number + 1, 2 * number, 2 * number + 1);
        let (root, row) = (12_f64.sqrt(), N + U + number);
        self.integrator(number, mean, t, limits);
        self.limited.of_input[(position, slope)] = -t.powi(2) / root;
        self.limit_input(slope, root / 4.0 * limits.acceleration);
        self.limited.of_state[(row, rate)] = 1.0;
        self.limited.of_input[(row, mean)] = t / 2.0;
        self.limited.of_input[(row, slope)] = -t / root;
        self.limit(row, -limits.rate, limits.rate);
    }

    /// The integrator `number`, whose input is its constant acceleration.
    fn restricted_integrator(&mut self, number: usize, t: f64, limits: &Integrator) {
        let (position, row) = (2 * number, N + U + number);
        self.integrator(number, number, t, limits);
        self.limited.of_state[(row, position)] = 1.0;
        self.limited.of_state[(row, position + 1)] = t / 2.0;
        self.limit(row, limits.min, limits.max);
    }

    fn integrator(&mut self, number: usize, acceleration: usize, t: f64, limits: &Integrator) {
        let (position, rate) = (2 * number, 2 * number + 1);
        self.limited.of_state[(position, position)] = 1.0;
        self.limited.of_state[(position, rate)] = t;
        self.limited.of_state[(rate, rate)] = 1.0;
        self.limited.of_input[(position, acceleration)] = t.powi(2) / 2.0;
        self.limited.of_input[(rate, acceleration)] = t;
        self.limit_input(acceleration, limits.acceleration);
        self.limit(position, limits.min, limits.max);
        self.limit(rate, -limits.rate, limits.rate);
    }

    /// Error of the felt force over an interval: mean and slope.
    pub fn error(&self, interval: usize, state: &SVector<f64, N>, input: &SVector<f64, U>) -> Vector2<f64> {
        self.felt.of(state, input) - self.desired[interval]
    }
}
