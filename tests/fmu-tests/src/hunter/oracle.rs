//! Judgement of a simulation by its outputs alone.
//!
//! # Promise
//! No actuator is ever commanded beyond its stroke, speed or acceleration. Surge, sway and heave
//! keep the safety limits on position, velocity and acceleration at every instant. The oracle knows
//! the outputs at the communication points, the step lengths h and the parameters. Symbols:
//!
//! - q: a leg's length or a coordinate; v: the velocity reported with it.
//! - m = (q - q') / h: the mean velocity over a step. A prime marks the value of the previous step.
//! - V and A: the limits of velocity and acceleration.
//!
//! A motion that keeps its limits at every instant has
//!
//! | quantity | bound | because |
//! |---|---|---|
//! | q | the position limits | |
//! | v, m | the velocity limit V | m is a mean of velocities |
//! | (v - v') / h | A | a mean of accelerations |
//! | 2 (m - v') / h and 2 (v - m) / h | A | weighted means of accelerations, the weights linear in time |
//! | 2 (m - m') / (h + h') | A | the same, with a trapezoid as weight, whatever h and h' |
//! | the reported acceleration | A | |
//! | the derivatives of q and v that the washout gives | V and A | |
//!
//! A communication step may span several internal steps. The left sides are then means, and the
//! bounds still hold. Before the first step the platform rests, so v' = 0.
//!
//! # Tolerances
//! Positions: [`POSITION_TOLERANCE`]. Velocities and accelerations: [`RELATIVE_TOLERANCE`] of the
//! limit, and the rounding error of the difference.
//!
//! A leg's length is computed from p + R a - b with a few roundings of numbers no larger than the
//! three vectors. Its error is at most [`ROUNDINGS`] units in the last place of the sum of their
//! lengths. The same holds for a coordinate, because it follows from lengths where legs limit the
//! motion. The error of a velocity is at most as many units of the corresponding speed. The error
//! of a difference over h is twice that, over h.
//!
//! # Limits changed in flight
//! The legs' limits never change. A safety limit that is tightened cannot always be kept at once.
//! From outputs alone, what remains of the promise is, for each axis, until it has settled:
//!
//! - velocity and acceleration keep the larger of the old limits and the new ones;
//! - a speed above the new limit never grows;
//! - a position beyond the new limit keeps the old one, and once the axis has come to rest
//!   it only comes nearer.
//!
//! The settling time is what remains of the longest stop within the old limits that may have begun
//! before the change. After it, velocity and acceleration keep the new limits. A position beyond
//! its limit may stay there, but never moves away from it: a platform at rest need not move. After
//! several changes in quick succession, the largest limits count until the last change has settled.
//!
//! The guard's stop takes max(s/(0.6 A), |u_k|/A_k). Here s = |v| + W r bounds the speed of the
//! joints, and W is the sum of the magnitudes of the angles' rates. A and A_k limit the
//! accelerations of the legs and of surge, sway and heave. In a stop the speeds fall in proportion.
//! So the time that remains follows from the speeds at a communication point, wherever in the step
//! the stop began. Only an axis that stopped sooner, within the step, may have set the time for the
//! others unseen. Its speed was at most its limit, and at most what its acceleration stops in the
//! step.

use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// Tolerance of a position beyond its limit \[m\].
pub const POSITION_TOLERANCE: f64 = 1e-9;
/// Tolerance of a velocity or an acceleration beyond its limit, relative to the limit.
pub const RELATIVE_TOLERANCE: f64 = 1e-6;
/// Distance of surge, sway, heave and the legs from neutral within which the platform is at home
/// \[m\].
pub const NEUTRAL_TOLERANCE: f64 = 1e-4;
/// Largest rounding error of a length, a coordinate or a velocity, in units in the
/// last place of its parts.
pub const ROUNDINGS: f64 = 8.0;
/// The fraction of the legs' acceleration limit with which the guard stops.
const STOP_FRACTION: f64 = 0.6;

/// The outputs that the oracle knows. Positions in m from neutral; lengths in m; the
/// rest in their SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    pub position: [f64; 3],
    pub velocity: [f64; 3],
    pub acceleration: [f64; 3],
    pub angular_velocity: [f64; 3],
    pub length: [f64; 6],
    pub leg_velocity: [f64; 6],
    /// Derivatives of the outputs, as the washout gives them.
    pub derivative: Derivative,
    /// The sum of all outputs, which is a number if every one of them is.
    pub sum: f64,
}

/// The output derivatives that the oracle knows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Derivative {
    pub position: [f64; 3],
    pub velocity: [f64; 3],
    /// Rates of roll, pitch and yaw.
    pub orientation: [f64; 3],
    pub length: [f64; 6],
    pub leg_velocity: [f64; 6],
}

/// Limits of the actuators, and size of the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MachineLimits {
    /// Shortest and longest length of a leg \[m\].
    pub stroke: [f64; 2],
    /// Speed of a leg \[m/s\].
    pub velocity: f64,
    /// Acceleration of a leg \[m/s2\].
    pub acceleration: f64,
    /// The farthest platform joint from the platform's origin \[m\].
    pub radius: f64,
    /// |p| + |a| + |b| at neutral, for the farthest joints \[m\].
    pub size: f64,
    /// Longest internal step \[s\].
    pub max_step: f64,
}

impl MachineLimits {
    /// The largest speed that a platform joint may have in this sample \[m/s\].
    #[inline(always)]
    fn joint_speed(&self, Sample { velocity, angular_velocity, .. }: &Sample) -> f64 {
        norm(velocity) + norm(angular_velocity) * self.radius
    }

    /// The time that the legs need for a stop from this velocity of the platform, turning as in
    /// this sample \[s\].
    fn stop_of_legs(&self, velocity: &[f64; 3], sample: &Sample) -> f64 {
        let turning: f64 = sample.derivative.orientation.iter().map(|rate| rate.abs()).sum();
        (norm(velocity) + turning * self.radius) / (STOP_FRACTION * self.acceleration)
    }
}

/// Limits of surge, sway and heave \[m, m/s, m/s2\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Safety {
    pub position: [f64; 3],
    pub velocity: [f64; 3],
    pub acceleration: [f64; 3],
}

/// A quantity that has a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// A value that is not a number.
    NotFinite,
    /// A leg's length, beyond its stroke.
    LegLength,
    /// A leg's velocity.
    LegVelocity,
    /// A leg's mean velocity, from its lengths.
    LegMeanVelocity,
    /// A leg's change of velocity over the step.
    LegAcceleration,
    /// A leg's mean velocity against the velocity at either end of the step.
    LegPositionAgainstVelocity,
    /// A leg's change of mean velocity.
    LegSecondDifference,
    /// The derivative of a leg's length.
    LegLengthDerivative,
    /// The derivative of a leg's velocity.
    LegVelocityDerivative,
    /// Surge, sway or heave.
    Position,
    /// A position beyond a tightened limit that moves away from it.
    PositionMovesAway,
    /// Velocity of surge, sway or heave.
    Velocity,
    /// Mean velocity, from positions.
    MeanVelocity,
    /// The reported acceleration.
    Acceleration,
    /// Change of velocity over the step.
    VelocityDifference,
    /// Mean velocity against the velocity at either end of the step.
    PositionAgainstVelocity,
    /// Change of mean velocity.
    SecondDifference,
    /// The derivative of a position.
    PositionDerivative,
    /// The derivative of a velocity.
    VelocityDerivative,
    /// Distance from neutral after a rest. Its ratio is the part of the rest that the way took.
    NotNeutral,
}

/// Number of quantities.
const QUANTITIES: usize = Quantity::NotNeutral as usize + 1;

/// A limit that was broken.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Breach {
    /// Number of the step at whose end it shows, from 0.
    pub step: usize,
    /// The quantity.
    pub quantity: Quantity,
    /// The leg or the axis, from 1.
    pub index: usize,
    /// The value, less the largest rounding error.
    pub value: f64,
    /// The largest permitted value.
    pub limit: f64,
}

impl std::fmt::Display for Breach {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let Breach { step, quantity, index, value, limit } = self;
        write!(f, "after step {step}: {quantity:?} {index} is {value}, limit {limit} ({:.9} times)", value / limit)
    }
}

/// Largest ratio so far of each quantity to its limit. For positions, the largest excess in
/// units of the tolerance.
pub type Worst = [f64; QUANTITIES];

/// One axis with the limits that it must keep.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axis {
    /// Position limit set last.
    position_limit: f64,
    /// Velocity limit set last.
    velocity_limit: f64,
    /// Acceleration limit set last.
    acceleration_limit: f64,
    /// Position limit in force.
    position: f64,
    /// Velocity limit in force.
    velocity: f64,
    /// Acceleration limits in force now and during the last step.
    acceleration: [f64; 2],
    /// The smallest acceleration limit under which the platform may still be coming to rest.
    slowest: f64,
    /// True if the axis has come to rest since its limits changed.
    stopped: bool,
}

impl Axis {
    /// Updates the position limit in force for an axis that has come to rest, and is here now: the
    /// limit set last. While the axis is beyond it, its own position.
    #[inline(always)]
    fn limit_position(&mut self, position: f64) {
        self.position = self.position_limit.max(self.position.min(position.abs()));
    }

    /// Updates the velocity limit in force for an axis with this velocity: the limit set last.
    /// While the speed is above it, the speed itself, but at most the previous limit in force.
    #[inline(always)]
    fn limit_speed(&mut self, velocity: f64) {
        self.velocity = self.velocity_limit.max(self.velocity.min(velocity.abs()));
    }
}

/// Watches a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oracle {
    machine: MachineLimits,
    axes: [Axis; 3],
    /// True if the limits in force on some axis differ from those set last, and the
    /// remaining settling time \[s\].
    settling: bool,
    remaining: f64,
    /// Remaining time of the longest stop that may have begun by now \[s\].
    stopping: f64,
    before: Sample,
    /// Mean velocities over the last step, legs first, and its length. Zero before the first step.
    mean: [f64; 9],
    last_step: f64,
}

impl Oracle {
    /// An oracle for a platform at rest, with the outputs before the first step.
    pub fn new(machine: MachineLimits, safety: &Safety, at_rest: &Sample) -> Self {
        let axes = std::array::from_fn(|k| Axis {
            position_limit: safety.position[k],
            velocity_limit: safety.velocity[k],
            acceleration_limit: safety.acceleration[k],
            position: safety.position[k],
            velocity: safety.velocity[k],
            acceleration: [safety.acceleration[k]; 2],
            slowest: safety.acceleration[k],
            stopped: true,
        });
        let (mean, last_step) = ([0.0; 9], 0.0);
        Oracle { machine, axes, settling: false, remaining: 0.0, stopping: 0.0, before: *at_rest, mean, last_step }
    }

    /// Changes the safety limits.
    pub fn change(&mut self, safety: &Safety) {
        self.remaining = self.remaining.max(self.stopping);
        self.settling = true;
        for (k, axis) in self.axes.iter_mut().enumerate() {
            axis.position_limit = safety.position[k];
            axis.velocity_limit = safety.velocity[k];
            axis.acceleration_limit = safety.acceleration[k];
            axis.position = axis.position.max(safety.position[k]);
            // A speed above the limit must not grow from now on, not only from the next step on.
            axis.limit_speed(self.before.velocity[k]);
            axis.acceleration[0] = axis.acceleration[0].max(safety.acceleration[k]);
            axis.slowest = axis.slowest.min(safety.acceleration[k]);
            axis.stopped = self.before.velocity[k] == 0.0;
        }
    }

    /// The longest time that a stop from this state may take, within the limits in force since
    /// the axes settled last.
    ///
    /// A step of several internal ones may contain the stop of an axis from a speed that no sample
    /// shows.
    fn longest_stop(&self, sample: &Sample, step: f64) -> f64 {
        const ROUNDING: f64 = 1e-9;
        let divided = step > self.machine.max_step * (1.0 + ROUNDING);
        let velocity = std::array::from_fn(|k| {
            let (axis, velocity) = (&self.axes[k], sample.velocity[k]);
            let unseen = divided && velocity == 0.0;
            if unseen { axis.velocity.min(axis.acceleration[0] * step) } else { velocity }
        });
        let axes = (0..3).map(|k| sample.velocity[k].abs() / self.axes[k].slowest);
        axes.fold(self.machine.stop_of_legs(&velocity, sample), f64::max)
    }

    /// Judges the outputs after a step of `step` seconds, and updates the worst ratios.
    ///
    /// # Errors
    /// The worst breach of this step, with the step number 0.
    #[inline]
    pub fn check(&mut self, now: &Sample, step: f64, worst: &mut Worst) -> Result<(), Breach> {
        if self.settling {
            self.tighten(step);
        }
        let mut ratios = [0.0; QUANTITIES];
        let mut finite = now.sum.is_finite();
        self.measure(now, step, |quantity, _, value, limit| {
            let ratio = value / limit;
            finite &= !ratio.is_nan();
            let largest = &mut ratios[quantity as usize];
            *largest = if ratio > *largest { ratio } else { *largest };
        });
        for (worst, ratio) in worst.iter_mut().zip(&ratios) {
            *worst = worst.max(*ratio);
        }
        let within = ratios.iter().all(|&ratio| ratio <= 1.0 + RELATIVE_TOLERANCE);
        if !(finite && within) {
            return Err(self.worst_breach(now, step));
        }
        self.advance(now, step);
        Ok(())
    }

    /// Every quantity of this step with its leg or axis, its value less the rounding
    /// error, and its limit. For a position, the value is the excess over its limit, and
    /// the limit is the tolerance.
    #[inline(always)]
    fn measure(&self, now: &Sample, step: f64, mut each: impl FnMut(Quantity, usize, f64, f64)) {
        let MachineLimits { stroke, velocity: fastest, acceleration: most, size, .. } = self.machine;
        let before = &self.before;
        let joint_speed = self.machine.joint_speed(now).max(self.machine.joint_speed(before));
        let last = self.last_step;
        let length_rounding = ROUNDINGS * f64::EPSILON * size;
        let speed_rounding = ROUNDINGS * f64::EPSILON * joint_speed * (1.0 + size / stroke[0]);
        let rounding = Rounding::new(length_rounding, speed_rounding, step, last);
        for i in 0..6 {
            let (length, velocity) = (now.length[i], now.leg_velocity[i]);
            let beyond = (stroke[0] - length).max(length - stroke[1]);
            each(Quantity::LegLength, i, beyond, POSITION_TOLERANCE);
            each(Quantity::LegVelocity, i, velocity.abs() - speed_rounding, fastest);
            let mean = (length - before.length[i]) / step;
            each(Quantity::LegMeanVelocity, i, mean.abs() - rounding.mean, fastest);
            let change = (velocity - before.leg_velocity[i]).abs() / step;
            each(Quantity::LegAcceleration, i, change - rounding.change, most);
            let against = 2.0 * (mean - before.leg_velocity[i]).abs().max((mean - velocity).abs()) / step;
            each(Quantity::LegPositionAgainstVelocity, i, against - rounding.against, most);
            let second = if last > 0.0 { 2.0 * (mean - self.mean[i]).abs() / (step + last) } else { 0.0 };
            each(Quantity::LegSecondDifference, i, second - rounding.second, most);
            let Derivative { length, leg_velocity, .. } = &now.derivative;
            each(Quantity::LegLengthDerivative, i, length[i].abs() - speed_rounding, fastest);
            each(Quantity::LegVelocityDerivative, i, leg_velocity[i].abs(), most);
        }
        for (k, axis) in self.axes.iter().enumerate() {
            let (position, velocity) = (now.position[k], now.velocity[k]);
            let speed_rounding = ROUNDINGS * f64::EPSILON * velocity.abs().max(before.velocity[k].abs());
            let rounding = Rounding::new(length_rounding, speed_rounding, step, last);
            let (fastest, [most, most_before]) = (axis.velocity, axis.acceleration);
            let most_of_both = most.max(most_before);
            let kept =
                if axis.position > axis.position_limit { Quantity::PositionMovesAway } else { Quantity::Position };
            each(kept, k, position.abs() - axis.position, POSITION_TOLERANCE);
            each(Quantity::Velocity, k, velocity.abs() - speed_rounding, fastest);
            let mean = (position - before.position[k]) / step;
            each(Quantity::MeanVelocity, k, mean.abs() - rounding.mean, fastest);
            each(Quantity::Acceleration, k, now.acceleration[k].abs() - rounding.change, most);
            let change = (velocity - before.velocity[k]).abs() / step;
            each(Quantity::VelocityDifference, k, change - rounding.change, most);
            let against = 2.0 * (mean - before.velocity[k]).abs().max((mean - velocity).abs()) / step;
            each(Quantity::PositionAgainstVelocity, k, against - rounding.against, most);
            let second = if last > 0.0 { 2.0 * (mean - self.mean[6 + k]).abs() / (step + last) } else { 0.0 };
            each(Quantity::SecondDifference, k, second - rounding.second, most_of_both);
            let Derivative { position, velocity, .. } = &now.derivative;
            each(Quantity::PositionDerivative, k, position[k].abs() - speed_rounding, fastest);
            each(Quantity::VelocityDerivative, k, velocity[k].abs() - rounding.change, most);
        }
    }

    #[cold]
    fn worst_breach(&self, now: &Sample, step: f64) -> Breach {
        let not_finite = Breach { step: 0, quantity: Quantity::NotFinite, index: 0, value: now.sum, limit: 0.0 };
        let (mut found, mut largest, mut finite) = (not_finite, 0.0, now.sum.is_finite());
        self.measure(now, step, |quantity, index, value, limit| {
            let ratio = value / limit;
            finite &= !ratio.is_nan();
            if ratio > largest {
                largest = ratio;
                let (value, limit) = match quantity {
                    Quantity::LegLength => (
                        now.length[index],
                        self.machine.stroke[usize::from(now.length[index] > self.machine.stroke[1])],
                    ),
                    Quantity::Position | Quantity::PositionMovesAway => {
                        (now.position[index].abs(), self.axes[index].position)
                    }
                    _ => (value, limit),
                };
                found = Breach { step: 0, quantity, index: index + 1, value, limit };
            }
        });
        if finite { found } else { not_finite }
    }

    fn advance(&mut self, now: &Sample, step: f64) {
        for i in 0..6 {
            self.mean[i] = (now.length[i] - self.before.length[i]) / step;
        }
        for (k, axis) in self.axes.iter_mut().enumerate() {
            self.mean[6 + k] = (now.position[k] - self.before.position[k]) / step;
            axis.acceleration[1] = axis.acceleration[0];
            // The two updates have no effect unless a limit was tightened.
            axis.stopped |= now.velocity[k] * self.before.velocity[k] <= 0.0 || !self.settling;
            if axis.stopped {
                axis.limit_position(now.position[k]);
            }
            axis.limit_speed(now.velocity[k]);
        }
        // A stop that began earlier, from a faster state, may still be in progress.
        self.stopping = self.longest_stop(now, step).max(self.stopping - step);
        self.last_step = step;
        self.before = *now;
    }

    /// Counts the settling time down, and puts the limits set last in force at its end.
    #[cold]
    fn tighten(&mut self, step: f64) {
        // A step that begins within the settling time may still contain the end of a stop.
        if self.remaining <= 0.0 {
            self.settling = false;
            for (k, axis) in self.axes.iter_mut().enumerate() {
                axis.stopped = true;
                axis.limit_position(self.before.position[k]);
                axis.velocity = axis.velocity_limit;
                axis.acceleration[0] = axis.acceleration_limit;
                axis.slowest = axis.acceleration_limit;
            }
        }
        self.remaining -= step;
    }
}

/// Largest rounding errors of a step's differences.
struct Rounding {
    mean: f64,
    change: f64,
    against: f64,
    second: f64,
}

impl Rounding {
    /// From the rounding errors of positions and velocities, over a step and the previous one.
    #[inline(always)]
    fn new(position: f64, velocity: f64, step: f64, last: f64) -> Self {
        let mean = 2.0 * position / step;
        let mean_before = if last > 0.0 { 2.0 * position / last } else { 0.0 };
        Rounding {
            mean,
            change: 2.0 * velocity / step,
            against: 2.0 * (mean + velocity) / step,
            second: 2.0 * (mean + mean_before) / (step + last),
        }
    }
}

fn norm([x, y, z]: &[f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}
