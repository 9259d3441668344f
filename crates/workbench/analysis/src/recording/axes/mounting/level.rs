//! Directions in the horizontal plane, each from one source.

use moris_washout::nalgebra::Vector3;

use super::blocks::{BLOCK_TIME, Blocks, mean};

/// Lateral force of bends by their yaw rate: the speed. Below it a vehicle leans, or bends are
/// those of parking; above it there are no vehicles \[m/s\].
const BEND_SPEED: [f64; 2] = [3.0, 100.0];
/// Least yaw rate of bends, as a root mean square \[rad/s\].
const BEND_RATE: f64 = 0.002;
/// Blocks over which forces and rates are averaged before straight accelerations are searched: 0.5
/// s.
const SMOOTHED_BLOCKS: usize = 5;
/// Least and most blocks whose errors count as one, those of a bend: 2 s to 20 s.
const CLUSTER_SIZES: [usize; 2] = [20, 200];
/// Standard error of any source, from the vehicle's own motion \[rad\].
const LEAST_ERROR: f64 = 2f64.to_radians();

/// A direction from one source.
pub struct Estimate {
    pub direction: Vector3<f64>,
    pub error: f64,
    pub evidence: &'static str,
}

/// A recording's blocks by the level.
pub struct Level {
    up: Vector3<f64>,
    /// Horizontal specific force.
    forces: Vec<Vector3<f64>>,
    /// Horizontal angular velocity.
    rates: Vec<Vector3<f64>>,
    /// Angular velocity about the vertical.
    yaw_rates: Vec<f64>,
    /// Lengths of the parts between changes of the yaw rate's sign.
    bends: Vec<usize>,
}

impl Level {
    pub fn new(blocks: &Blocks, up: &Vector3<f64>) -> Self {
        let horizontal = |vector: Vector3<f64>| vector - up * vector.dot(up);
        let bias = blocks.rest_rate();
        let rates = || blocks.rates.iter().map(|rate| rate - bias);
        let yaw_rates: Vec<f64> = rates().map(|rate| rate.dot(up)).collect();
        Level {
            bends: bend_lengths(&yaw_rates),
            up: *up,
            forces: blocks.forces.iter().map(|force| horizontal(*force)).collect(),
            rates: rates().map(horizontal).collect(),
            yaw_rates,
        }
    }

    pub fn along_speed(&self, speeds: &[f64]) -> Option<Estimate> {
        // Least change of speed that determines the forward direction, as a standard deviation of
        // its rate [m/s2].
        const SPEED_CHANGE: f64 = 0.2;
        let changes: Vec<f64> = speeds.windows(3).map(|s| (s[2] - s[0]) / (2.0 * BLOCK_TIME)).collect();
        let Regression { direction, error, .. } =
            self.regression(&changes, self.forces.get(1..)?, SPEED_CHANGE, lasting_error)?;
        Some(Estimate { direction, error, evidence: "the change of speed" })
    }

    pub fn in_bends(&self) -> Option<Estimate> {
        let left = self.regression(&self.yaw_rates, &self.forces, BEND_RATE, lasting_error)?;
        let is_vehicle = (BEND_SPEED[0]..BEND_SPEED[1]).contains(&left.slope);
        let direction = left.direction.cross(&self.up);
        is_vehicle.then_some(Estimate { direction, error: left.error, evidence: "the lateral force of bends" })
    }

    pub fn in_leaning_bends(&self) -> Option<Estimate> {
        // Least change of the rate about the lateral axis with the yaw rate: the sine of 6 degrees
        // of lean.
        const LEAN: f64 = 0.1;
        let mean = self.yaw_rates.iter().map(|rate| rate.abs()).sum::<f64>() / self.yaw_rates.len() as f64;
        let sizes: Vec<f64> = self.yaw_rates.iter().map(|rate| rate.abs() - mean).collect();
        let right = self.regression(&sizes, &self.rates, BEND_RATE, returning_error)?;
        let direction = self.up.cross(&right.direction);
        (right.slope > LEAN).then_some(Estimate { direction, error: right.error, evidence: "the lean in bends" })
    }

    /// Mean forces of [`SMOOTHED_BLOCKS`] blocks around each, zero where they are not those of a
    /// straight acceleration.
    ///
    /// A bend at up to 100 m/s has a larger yaw rate for its force.
    fn straight(&self) -> Vec<Vector3<f64>> {
        // Horizontal specific force of an acceleration [m/s2].
        const ACCELERATION: f64 = 0.5;
        // Shortest acceleration, in blocks: 0.5 s.
        const SHORTEST: usize = 5;
        let count = self.forces.len();
        let around = |k: usize| k.saturating_sub(SMOOTHED_BLOCKS / 2)..(k + SMOOTHED_BLOCKS / 2 + 1).min(count);
        let smooth = |k: usize| {
            let blocks = around(k);
            let force = mean(&self.forces[blocks.clone()]);
            let yaw_rate = self.yaw_rates[blocks.clone()].iter().sum::<f64>() / blocks.len() as f64;
            let is_straight = force.norm() > ACCELERATION && yaw_rate.abs() * BEND_SPEED[1] < force.norm();
            if is_straight { force } else { Vector3::zeros() }
        };
        let mut forces: Vec<Vector3<f64>> = (0..count).map(smooth).collect();
        for part in forces.chunk_by_mut(|a, b| (a.norm() > 0.0) == (b.norm() > 0.0)) {
            if part.len() < SHORTEST {
                part.fill(Vector3::zeros());
            }
        }
        forces
    }

    /// The line along which straight accelerations are, in one of its two directions.
    pub fn straight_accelerations(&self) -> Option<Estimate> {
        let forces = self.straight();
        // Twice the angle is the same for both directions.
        let x = forces.iter().max_by(|a, b| a.norm().total_cmp(&b.norm()))?.try_normalize(0.0)?;
        let y = self.up.cross(&x);
        let doubled = |force: &Vector3<f64>| {
            let (along, across) = (force.dot(&x), force.dot(&y));
            x * (along * along - across * across) + y * (2.0 * along * across)
        };
        let doubled: Vec<Vector3<f64>> = forces.iter().map(doubled).collect();
        let line = self.regression(&vec![1.0; doubled.len()], &doubled, 0.0, lasting_error)?;
        let angle = 0.5 * line.direction.dot(&y).atan2(line.direction.dot(&x));
        let direction = x * angle.cos() + y * angle.sin();
        Some(Estimate { direction, error: (0.5 * line.error).max(LEAST_ERROR), evidence: "straight accelerations" })
    }

    /// The block of the first straight acceleration after the first rest, and its sign along a
    /// line. Without one, that of the braking before that rest.
    pub fn first_acceleration(&self, rest: Option<[usize; 2]>, line: &Vector3<f64>) -> (usize, f64) {
        let along: Vec<f64> = self.straight().iter().map(|force| force.dot(line)).collect();
        let [start, end] = rest.unwrap_or([0, 0]);
        let after = (end.saturating_sub(SMOOTHED_BLOCKS)..along.len()).find(|&k| along[k] != 0.0);
        let before = || (0..start).rev().find(|&k| along[k] != 0.0);
        match after {
            Some(block) => (block, sign(along[block])),
            None => before().map_or((0, 1.0), |block| (block, -sign(along[block]))),
        }
    }

    /// The vectors' regression on a signal; none where the signal's root mean square is below
    /// `least`, or nothing goes with it.
    ///
    /// `disturbance` is the error of a bend, of its products of signal and vector
    /// across the direction.
    fn regression(
        &self,
        signal: &[f64],
        vectors: &[Vector3<f64>],
        least: f64,
        disturbance: fn(&[f64]) -> f64,
    ) -> Option<Regression> {
        let products: Vec<Vector3<f64>> = signal.iter().zip(vectors).map(|(value, vector)| *value * vector).collect();
        let total: Vector3<f64> = products.iter().sum();
        let square = signal.iter().map(|value| value * value).sum::<f64>();
        let direction = total.try_normalize(f64::MIN_POSITIVE)?;
        let across = self.up.cross(&direction);
        let products: Vec<f64> = products.iter().map(|product| product.dot(&across)).collect();
        let mut rest = products.as_slice();
        let mut off = 0.0;
        for &length in &self.bends {
            let (bend, after) = rest.split_at(length.min(rest.len()));
            off += disturbance(bend).powi(2);
            rest = after;
        }
        let is_moving = (square / signal.len() as f64).sqrt() > least;
        let error = (off.sqrt() / total.norm()).atan().max(LEAST_ERROR);
        is_moving.then_some(Regression { direction, slope: total.norm() / square, error })
    }
}

/// Lengths of the parts between changes of the yaw rate's sign, within the limits
/// of [`CLUSTER_SIZES`].
fn bend_lengths(yaw_rates: &[f64]) -> Vec<usize> {
    let mut lengths = Vec::new();
    let mut start = 0;
    for k in 1..yaw_rates.len() {
        let length = k - start;
        let ends = yaw_rates[k - 1].signum() != yaw_rates[k].signum();
        if length >= CLUSTER_SIZES[1] || ends && length >= CLUSTER_SIZES[0] {
            lengths.push(length);
            start = k;
        }
    }
    lengths.push(yaw_rates.len() - start);
    lengths
}

/// Linear regression of horizontal vectors on a signal.
struct Regression {
    /// Unit vector along which the vectors go with the signal.
    direction: Vector3<f64>,
    /// Change of the vectors along it with the signal.
    slope: f64,
    /// Standard error of the direction \[rad\].
    error: f64,
}

/// A disturbance that lasts for a bend: brakings and accelerations.
fn lasting_error(products: &[f64]) -> f64 {
    (products.len() as f64 * products.iter().map(|product| product * product).sum::<f64>()).sqrt()
}

/// A disturbance that returns at the end of a bend: a vehicle that rolls into it rolls back.
fn returning_error(products: &[f64]) -> f64 {
    products.iter().sum()
}

/// -1 for a negative value, otherwise 1.
pub fn sign(value: f64) -> f64 {
    if value < 0.0 { -1.0 } else { 1.0 }
}
