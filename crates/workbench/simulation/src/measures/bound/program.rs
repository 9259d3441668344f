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

use super::projection::Projection;
use super::{AxisLimits, TiltLimits};

/// Rows that are linear in the state at an interval's beginning and in the inputs within it.
pub struct Rows<const N: usize, const U: usize, const R: usize> {
    pub of_state: [[f64; N]; R],
    pub of_input: [[f64; U]; R],
}

impl<const N: usize, const U: usize, const R: usize> Rows<N, U, R> {
    const ZERO: Self = Rows { of_state: [[0.0; N]; R], of_input: [[0.0; U]; R] };

    /// The rows' values.
    pub fn of(&self, state: &[f64; N], input: &[f64; U]) -> [f64; R] {
        std::array::from_fn(|row| dot_product(&self.of_state[row], state) + dot_product(&self.of_input[row], input))
    }

    /// Adds the rows' sum, each times its weight, to the coefficients of state and input.
    pub fn add_transposed(&self, weights: &[f64; R], of_state: &mut [f64; N], of_input: &mut [f64; U]) {
        for (row, weight) in weights.iter().enumerate() {
            of_state.iter_mut().zip(&self.of_state[row]).for_each(|(sum, value)| *sum += weight * value);
            of_input.iter_mut().zip(&self.of_input[row]).for_each(|(sum, value)| *sum += weight * value);
        }
    }
}

fn dot_product<const M: usize>(left: &[f64; M], right: &[f64; M]) -> f64 {
    left.iter().zip(right).map(|(left, right)| left * right).sum()
}

/// Least values, below 0, and greatest values, above 0. At rest at neutral, all values are 0.
#[derive(Clone, Copy)]
pub struct Range<const M: usize> {
    pub min: [f64; M],
    pub max: [f64; M],
}

impl<const M: usize> Range<M> {
    const ZERO: Self = Range { min: [0.0; M], max: [0.0; M] };

    fn set(&mut self, index: usize, min: f64, max: f64) {
        (self.min[index], self.max[index]) = (min, max);
    }

    fn within(&mut self, index: usize, limit: f64) {
        self.set(index, -limit, limit);
    }
}

/// The program with N states, U inputs and E rows that have limits.
pub struct Program<const N: usize, const U: usize, const E: usize> {
    /// The state at an interval's end.
    pub motion: Rows<N, U, N>,
    /// Mean and slope of the felt force over an interval.
    pub felt: Rows<N, U, 2>,
    /// Mean and slope of the desired force over each interval.
    pub desired: Vec<[f64; 2]>,
    /// Further values that have limits.
    pub limited: Rows<N, U, E>,
    pub states: Range<N>,
    pub inputs: Range<U>,
    pub limits: Range<E>,
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
pub fn relaxed(desired: &[Projection], interval: f64, limits: &AxisLimits) -> Program<2, 2, 1> {
    let mut program = Program::new(desired);
    program.relaxed_integrator(0, interval, &Integrator::position(limits));
    program.felt.of_input = [[1.0, 0.0], [0.0, 1.0]];
    program
}

/// Heave with an acceleration that is constant over each interval.
pub fn restricted(desired: &[Projection], interval: f64, limits: &AxisLimits) -> Program<2, 1, 1> {
    let mut program = Program::new(desired);
    program.restricted_integrator(0, interval, &Integrator::position(limits));
    program.felt.of_input = [[1.0], [0.0]];
    program
}

/// Surge or sway with its tilt in any motion. The inputs are the mean and the slope of p'', those
/// of q'', offset and skew.
pub fn relaxed_with_tilt(
    desired: &[Projection],
    interval: f64,
    limits: &AxisLimits,
    tilt: &TiltLimits,
) -> Program<4, 6, 2> {
    let (t, root, arm) = (interval, 12_f64.sqrt(), tilt.head_height / tilt.gravity);
    let mut program = Program::new(desired);
    let tilting = Integrator::tilt(tilt);
    program.relaxed_integrator(0, t, &Integrator::position(limits));
    program.relaxed_integrator(1, t, &tilting);
    program.inputs.within(4, t.powi(2) / 12.0 * tilting.acceleration);
    program.inputs.within(5, root * t.powi(2) / 192.0 * tilting.acceleration);
    program.felt = Rows {
        of_state: [[0.0, 0.0, 1.0, t / 2.0], [0.0, 0.0, 0.0, t / root]],
        of_input: [
            [1.0, 0.0, t.powi(2) / 4.0 - arm, -t.powi(2) / (2.0 * root), 1.0, 0.0],
            [0.0, 1.0, t.powi(2) / (2.0 * root), -arm - t.powi(2) / 12.0, 0.0, 1.0],
        ],
    };
    program
}

/// Surge or sway with its tilt, with accelerations that are constant over each interval.
pub fn restricted_with_tilt(
    desired: &[Projection],
    interval: f64,
    limits: &AxisLimits,
    tilt: &TiltLimits,
) -> Program<4, 2, 2> {
    let (t, root, arm) = (interval, 12_f64.sqrt(), tilt.head_height / tilt.gravity);
    let mut program = Program::new(desired);
    program.restricted_integrator(0, t, &Integrator::position(limits));
    program.restricted_integrator(1, t, &Integrator::tilt(tilt));
    program.felt = Rows {
        of_state: [[0.0, 0.0, 1.0, t / 2.0], [0.0, 0.0, 0.0, t / root]],
        of_input: [[1.0, t.powi(2) / 6.0 - arm], [0.0, t.powi(2) / (2.0 * root)]],
    };
    program
}

impl<const N: usize, const U: usize, const E: usize> Program<N, U, E> {
    fn new(desired: &[Projection]) -> Self {
        Program {
            motion: Rows::ZERO,
            felt: Rows::ZERO,
            desired: desired.iter().map(|projection| [projection.mean, projection.slope]).collect(),
            limited: Rows::ZERO,
            states: Range::ZERO,
            inputs: Range::ZERO,
            limits: Range::ZERO,
        }
    }

    /// The integrator `number`, whose inputs are the mean and the slope of its acceleration.
    fn relaxed_integrator(&mut self, number: usize, t: f64, limits: &Integrator) {
        let (rate, mean, slope) = (2 * number + 1, 2 * number, 2 * number + 1);
        let root = 12_f64.sqrt();
        self.integrator(number, mean, t, limits);
        self.motion.of_input[rate - 1][slope] = -t.powi(2) / root;
        self.inputs.within(slope, root / 4.0 * limits.acceleration);
        self.limited.of_state[number][rate] = 1.0;
        self.limited.of_input[number][mean] = t / 2.0;
        self.limited.of_input[number][slope] = -t / root;
        self.limits.within(number, limits.rate);
    }

    /// The integrator `number`, whose input is its constant acceleration.
    fn restricted_integrator(&mut self, number: usize, t: f64, limits: &Integrator) {
        let position = 2 * number;
        self.integrator(number, number, t, limits);
        self.limited.of_state[number][position] = 1.0;
        self.limited.of_state[number][position + 1] = t / 2.0;
        self.limits.set(number, limits.min, limits.max);
    }

    fn integrator(&mut self, number: usize, acceleration: usize, t: f64, limits: &Integrator) {
        let (position, rate) = (2 * number, 2 * number + 1);
        self.motion.of_state[position][position] = 1.0;
        self.motion.of_state[position][rate] = t;
        self.motion.of_state[rate][rate] = 1.0;
        self.motion.of_input[position][acceleration] = t.powi(2) / 2.0;
        self.motion.of_input[rate][acceleration] = t;
        self.inputs.within(acceleration, limits.acceleration);
        self.states.set(position, limits.min, limits.max);
        self.states.within(rate, limits.rate);
    }

    /// Error of the felt force over an interval: mean and slope.
    pub fn error(&self, interval: usize, state: &[f64; N], input: &[f64; U]) -> [f64; 2] {
        let felt = self.felt.of(state, input);
        std::array::from_fn(|row| felt[row] - self.desired[interval][row])
    }
}
