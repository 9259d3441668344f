//! The linear-quadratic regulator of one axis: weights of dropped force, stroke and tilting, and
//! the gains with the least cost.

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use super::law::Unsolvable;
use super::smooth_tilt::TiltLimits;
use crate::riccati;

/// Position \[m\], velocity \[m/s\], tilt \[rad\], tilt rate \[rad/s\], and the slow and the fast
/// part of the reference \[m/s2\].
pub type State = SVector<f64, 6>;
/// Gains from the state to dropped force \[m/s2\] and tilt acceleration \[rad/s2\].
pub type Gains = SMatrix<f64, 2, 6>;

/// One axis as the strategies see it: travel x and a tilt q whose gravity acts along +x.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AxisModel {
    /// Height of the washout location above the platform \[m\].
    pub head_height: f64,
    /// Felt force of a radian of tilt \[m/s2\].
    pub gravity: f64,
    /// Farthest travel \[m\] and largest velocity \[m/s\].
    pub position_limit: f64,
    pub velocity_limit: f64,
    /// Largest tilt \[rad\], tilt rate \[rad/s\] and tilt acceleration \[rad/s2\].
    pub angle_limit: f64,
    pub rate_limit: f64,
    pub acceleration_limit: f64,
}

impl AxisModel {
    /// The limits of the tilt.
    pub fn tilt_limits(&self) -> TiltLimits {
        TiltLimits::new(self.angle_limit, self.rate_limit, self.acceleration_limit)
    }
}

/// Weights of the quantities that `predictive`, `optimal`, `robust` and the automatic scale use,
/// relative to 1 for a dropped force of 1 m/s2. Each quantity is divided by its limit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Weights {
    pub position: f64,
    pub velocity: f64,
    pub tilt_rate: f64,
    pub tilt_acceleration: f64,
    /// Expected decay rates of the slow and the fast part of the reference \[rad/s\].
    pub slow_pole: f64,
    pub fast_pole: f64,
}

/// A regulator: (dropped force, tilt acceleration) = -gains * state, at a cost to come
/// of state' cost state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Regulator {
    pub gains: Gains,
    pub cost: SMatrix<f64, 6, 6>,
}

/// Without a weight on the tilt itself the equation would have no solution; this one changes
/// nothing that can be seen.
const TILT_WEIGHT: f64 = 1e-9;
/// Weight added to every scaled state, so that the equation has a solution.
const STATE_WEIGHT: f64 = 1e-10;

/// The regulator's problem in states and inputs relative to their scales.
#[derive(Clone, Debug)]
pub struct Problem {
    a: SMatrix<f64, 6, 6>,
    b: SMatrix<f64, 6, 2>,
    q: SMatrix<f64, 6, 6>,
    /// R^-1 B': from the costate to the input.
    to_input: SMatrix<f64, 2, 6>,
    scale: State,
    input_scale: SVector<f64, 2>,
}

impl Problem {
    /// The problem of an axis with these weights.
    pub fn new(model: &AxisModel, weights: &Weights) -> Self {
        let (a, b) = dynamics(model, weights);
        let Weights { position, velocity, tilt_rate, tilt_acceleration, slow_pole: _, fast_pole: _ } = *weights;
        let AxisModel { position_limit, velocity_limit, angle_limit, rate_limit, acceleration_limit, .. } = *model;
        let scale = State::new(position_limit, velocity_limit, angle_limit, rate_limit, 1.0, 1.0);
        let input_scale = SVector::<f64, 2>::new(1.0, acceleration_limit);
        let a = SMatrix::from_fn(|i, j| a[(i, j)] * scale[j] / scale[i]);
        let b: SMatrix<f64, 6, 2> = SMatrix::from_fn(|i, j| b[(i, j)] * input_scale[j] / scale[i]);
        let tilt = TILT_WEIGHT * angle_limit * angle_limit;
        let state_weights = State::new(position, velocity, tilt, tilt_rate, 0.0, 0.0);
        let q = SMatrix::from_diagonal(&state_weights.add_scalar(STATE_WEIGHT));
        let to_input = SMatrix::from_fn(|i, j| b[(j, i)] / if i == 0 { 1.0 } else { tilt_acceleration });
        Problem { a, b, q, to_input, scale, input_scale }
    }

    /// The cost to come of the regulator against a disturbance D D'/gamma^2, in scaled states.
    ///
    /// # Errors
    /// The Riccati equation has no solution in numbers, or none without a disturbance that pays.
    pub fn cost(&self, disturbance: &SMatrix<f64, 6, 6>) -> Result<SMatrix<f64, 6, 6>, Unsolvable> {
        riccati::solve::<6, 12>(&self.a, &(self.b * self.to_input - disturbance), &self.q)
            // Rounding alone makes the least eigenvalue of a semidefinite matrix negative.
            .filter(|cost| (cost + SMatrix::from_diagonal_element(1e-9 * cost.amax())).cholesky().is_some())
            .ok_or(Unsolvable::RiccatiEquation)
    }

    /// The regulator against a disturbance D D'/gamma^2.
    ///
    /// # Errors
    /// As [`Problem::cost`].
    pub fn regulator(&self, disturbance: &SMatrix<f64, 6, 6>) -> Result<Regulator, Unsolvable> {
        let Problem { scale, input_scale, .. } = self;
        let cost = self.cost(disturbance)?;
        let gains = self.to_input * cost;
        Ok(Regulator {
            gains: SMatrix::from_fn(|i, j| gains[(i, j)] * input_scale[i] / scale[j]),
            cost: SMatrix::from_fn(|i, j| cost[(i, j)] / (scale[i] * scale[j])),
        })
    }
}

impl Regulator {
    /// The regulator that is least in the mean for these weights.
    ///
    /// # Errors
    /// The Riccati equation has no solution in numbers.
    pub fn new(model: &AxisModel, weights: &Weights) -> Result<Self, Unsolvable> {
        Problem::new(model, weights).regulator(&SMatrix::zeros())
    }
}

/// Dropped force \[m/s2\] and tilt acceleration \[rad/s2\] in a state.
pub fn control(gains: &Gains, state: &State) -> [f64; 2] {
    (-(gains * state)).into()
}

/// x' = A x + B u: a = slow + fast - g q + e + H alpha, where the parts of the reference fade.
pub fn dynamics(model: &AxisModel, weights: &Weights) -> (SMatrix<f64, 6, 6>, SMatrix<f64, 6, 2>) {
    let mut a = SMatrix::zeros();
    let mut b = SMatrix::zeros();
    a[(0, 1)] = 1.0;
    a[(1, 2)] = -model.gravity;
    a[(1, 4)] = 1.0;
    a[(1, 5)] = 1.0;
    a[(2, 3)] = 1.0;
    a[(4, 4)] = -weights.slow_pole;
    a[(5, 5)] = -weights.fast_pole;
    b[(1, 0)] = 1.0;
    b[(1, 1)] = model.head_height;
    b[(3, 1)] = 1.0;
    (a, b)
}

#[cfg(test)]
pub(in crate::cueing) mod tests {
    use super::*;
    use crate::interface::STANDARD_GRAVITY;

    pub const MODEL: AxisModel = AxisModel {
        head_height: 1.2,
        gravity: STANDARD_GRAVITY,
        position_limit: 0.45,
        velocity_limit: 1.0,
        angle_limit: 0.38,
        rate_limit: 0.052_359_877_559_829_88,
        acceleration_limit: 0.2,
    };
    const WEIGHTS: Weights = Weights {
        position: 0.209,
        velocity: 0.0105,
        tilt_rate: 0.0033,
        tilt_acceleration: 0.0242,
        slow_pole: 0.345,
        fast_pole: 4.71,
    };

    #[test]
    fn the_gains_are_those_of_another_solver() {
        // By scipy.linalg.solve_continuous_are, to the digits printed.
        let expected = [[0.881, 0.891, -4.91, -1.838, 0.442, 0.151], [-0.653, -1.272, 10.924, 6.141, -0.925, -0.239]];
        let regulator = Regulator::new(&MODEL, &WEIGHTS).unwrap();
        for (i, row) in expected.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                let found = regulator.gains[(i, j)];
                assert!((found - value).abs() < 6e-3, "gain {i} {j}: {found} beside {value}");
            }
        }
    }

    #[test]
    fn the_cost_solves_the_riccati_equation_and_the_loop_is_stable() {
        for weights in [
            WEIGHTS,
            Weights {
                position: 5e-4,
                velocity: 1e-2,
                tilt_rate: 1.2e-3,
                tilt_acceleration: 7e-4,
                slow_pole: 0.0368,
                fast_pole: 2.9,
            },
            Weights { position: 10.0, slow_pole: 1e-4, fast_pole: 1e2, ..WEIGHTS },
        ] {
            let Regulator { gains, cost } = Regulator::new(&MODEL, &weights).unwrap();
            let (a, b) = dynamics(&MODEL, &weights);
            let weight_of_tilt_acceleration = weights.tilt_acceleration / MODEL.acceleration_limit.powi(2);
            let state_weights = State::new(
                (weights.position + STATE_WEIGHT) / MODEL.position_limit.powi(2),
                weights.velocity + STATE_WEIGHT,
                TILT_WEIGHT + STATE_WEIGHT / MODEL.angle_limit.powi(2),
                (weights.tilt_rate + STATE_WEIGHT) / MODEL.rate_limit.powi(2),
                STATE_WEIGHT,
                STATE_WEIGHT,
            );
            let s = b.column(0) * b.column(0).transpose()
                + b.column(1) * b.column(1).transpose() / weight_of_tilt_acceleration;
            let q = SMatrix::from_diagonal(&state_weights);
            let residual = riccati::residual(&a, &s, &q, &cost);
            let size = (cost * s * cost).amax();
            assert!(residual.amax() < 1e-8 * size, "residual {:e} beside terms of {size:e}", residual.amax());
            let poles = (a - b * gains).complex_eigenvalues();
            assert!(poles.iter().all(|pole| pole.re < 0.0), "unstable: {poles}");
            assert!(cost.symmetric_eigenvalues().min() > -1e-9 * cost.amax());
        }
    }

    #[test]
    fn an_equation_that_rounding_leaves_unsolved_has_no_regulator() {
        let model = AxisModel {
            position_limit: 3.9e5,
            velocity_limit: 6.3e-9,
            angle_limit: 2e-4,
            rate_limit: 1.9e-7,
            acceleration_limit: 560.0,
            ..MODEL
        };
        let weights = Weights {
            position: 33.0,
            velocity: 5.7e5,
            tilt_rate: 1.5e-4,
            tilt_acceleration: 3.9e-5,
            slow_pole: 0.016,
            fast_pole: 4.4,
        };
        assert_eq!(Regulator::new(&model, &weights), Err(Unsolvable::RiccatiEquation));
    }
}
