//! The regulator that is least for the worst reference.
//!
//! The regulator has the states, inputs and cost of the linear-quadratic
//! [`regulator`](super::regulator), which is least in the mean for a reference whose slow and fast
//! part decay. Here a disturbance w of bounded energy drives both parts, and the regulator is
//! least for the worst one:
//!
//! ```text
//!     x' = A x + B u + D w,    integral of the cost <= gamma^2 integral of w'w
//!     0 = A'P + P A + Q - P (B R^-1 B' - gamma^-2 D D') P,    u = -R^-1 B' P x
//! ```
//!
//! (T. Basar and P. Bernhard, *H-infinity Optimal Control*, 1995, section 4.4). D drives the slow
//! part by 1 and the fast part by `robust.fastDisturbance`. gamma is `robust.attenuation` times the
//! least one for which P >= 0 exists, found by bisection.

use nalgebra::SMatrix;
use serde::{Deserialize, Serialize};

use super::law::Unsolvable;
use super::regulator::{AxisModel, Problem, Regulator, Weights};
use crate::motion::min_max::max;
use crate::motion::square_root::square_root;

/// The disturbance that a regulator withstands.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Disturbance {
    /// gamma relative to the least one.
    pub attenuation: f64,
    /// Disturbance of the reference's fast part relative to that of the slow part.
    pub fast: f64,
}

/// Least travel that the weights refer to \[m\]. A shorter one would drop many times the force's
/// slow part, 7.6 times it at 30 mm, and a force that changes would be felt as a jolt.
const MIN_WEIGHED_TRAVEL: f64 = 0.06;
/// Factor by which gamma^-2 changes until it is bracketed, and how often it may.
const BRACKET_FACTOR: f64 = 16.0;
const MOST_BRACKETS: usize = 40;
/// Bisections of the bracket: gamma is then known to 1e-6 of itself.
const BISECTION_STEPS: usize = 21;

impl Disturbance {
    /// The regulator of an axis that is least for the worst disturbance.
    ///
    /// # Errors
    /// There is none in numbers.
    pub fn regulator(&self, model: &AxisModel, weights: &Weights) -> Result<Regulator, Unsolvable> {
        let position_limit = max(model.position_limit, MIN_WEIGHED_TRAVEL);
        let problem = Problem::new(&AxisModel { position_limit, ..*model }, weights);
        let least = self.least_gamma(&problem).ok_or(Unsolvable::RiccatiEquation)?;
        let gamma = self.attenuation * least;
        problem.regulator(&(self.square() / (gamma * gamma)))
    }

    /// The least gamma at which the worst disturbance costs a bounded amount.
    fn least_gamma(&self, problem: &Problem) -> Option<f64> {
        let bounded = |inverse_square: f64| problem.cost(&(inverse_square * self.square())).is_ok();
        let mut most = 1.0;
        if bounded(most) {
            most = bracketing_trials(most, BRACKET_FACTOR).find(|&trial| !bounded(trial))?;
        }
        let mut least = bracketing_trials(most, BRACKET_FACTOR.recip()).find(|&trial| bounded(trial))?;
        most = BRACKET_FACTOR * least;
        for _ in 0..BISECTION_STEPS {
            let middle = square_root(least * most);
            *if bounded(middle) { &mut least } else { &mut most } = middle;
        }
        Some(square_root(least).recip())
    }

    /// The product D D' of the disturbance's directions.
    fn square(&self) -> SMatrix<f64, 6, 6> {
        let mut square = SMatrix::zeros();
        square[(4, 4)] = 1.0;
        square[(5, 5)] = self.fast * self.fast;
        square
    }
}

/// Trials on the way from a value, each `factor` times the one before.
fn bracketing_trials(from: f64, factor: f64) -> impl Iterator<Item = f64> {
    core::iter::successors(Some(factor * from), move |trial| Some(factor * trial)).take(MOST_BRACKETS)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, SVector};

    use super::*;
    use crate::cueing::strategy::optimal::Tuning;
    use crate::cueing::strategy::regulator::dynamics;
    use crate::cueing::strategy::regulator::tests::MODEL;
    use crate::interface::Parameters;

    fn weights() -> Weights {
        Tuning::from(&Parameters::default().robust).weights
    }

    const DISTURBANCE: Disturbance = Disturbance { attenuation: 1.08, fast: 121.0 };

    fn least_gamma() -> f64 {
        DISTURBANCE.least_gamma(&Problem::new(&MODEL, &weights())).unwrap()
    }

    /// The values are those of scipy 1.14: `schur(hamiltonian, sort="lhp")` with a bisection of
    /// gamma, and `solve_continuous_are` with [B D] as input and diag(R, -gamma^2 I) as its weight.
    #[test]
    fn the_least_gamma_and_the_gains_are_those_of_the_hamiltonians_schur_form() {
        let expected = [
            [8.6550780428e-01, 1.1633447236, -7.7196645618, -3.0867748454, 7.5188255015e-01, 4.4278983565e-02],
            [-6.6190904968, -9.3931176501, 6.5656251473e+01, 2.8121271987e+01, -6.3744999270, -3.5818588098e-01],
        ];
        assert!((least_gamma() - 1.272451723997605).abs() < 1e-5, "{}", least_gamma());
        let gains = DISTURBANCE.regulator(&MODEL, &weights()).unwrap().gains;
        for (i, row) in expected.iter().enumerate() {
            for (j, expected) in row.iter().enumerate() {
                // They move by some 1e-4 of themselves with the bisection's 1e-6.
                let found = gains[(i, j)];
                assert!((found - expected).abs() < 3e-4 * expected.abs(), "gain {i}, {j}: {found} beside {expected}");
            }
        }
    }

    #[test]
    fn a_short_travel_does_not_drop_many_times_the_force() {
        let slow = |position_limit: f64| {
            let model = AxisModel { position_limit, ..MODEL };
            DISTURBANCE.regulator(&model, &weights()).unwrap().gains[(0, 4)]
        };
        assert!(slow(0.03) < 5.0 && slow(0.03) == slow(0.06) && slow(0.06) > 1.1 * slow(0.08), "{}", slow(0.03));
    }

    /// The largest cost of a disturbance of unit energy, by power iteration: the disturbance's
    /// response in the weighted outputs, and its adjoint, over a minute in steps of 2 ms.
    fn worst_cost(regulator: &Regulator) -> f64 {
        const STEP: f64 = 0.002;
        const COUNT: usize = 30_000;
        let weights = weights();
        let (a, b) = dynamics(&MODEL, &weights);
        let closed = a - b * regulator.gains;
        // The trapezoidal rule.
        let half = 0.5 * STEP * closed;
        let implicit = (SMatrix::<f64, 6, 6>::identity() - half).try_inverse().unwrap();
        let transition = implicit * (SMatrix::<f64, 6, 6>::identity() + half);
        let mut drive = SMatrix::<f64, 6, 2>::zeros();
        (drive[(4, 0)], drive[(5, 1)]) = (1.0, DISTURBANCE.fast);
        let into_state = STEP * implicit * drive;
        let mut outputs = SMatrix::<f64, 6, 6>::zeros();
        let limits = [MODEL.position_limit, MODEL.velocity_limit, MODEL.rate_limit];
        let state_weights = [weights.position, weights.velocity, weights.tilt_rate];
        for (row, (state, (weight, limit))) in
            [0, 1, 3].into_iter().zip(state_weights.into_iter().zip(limits)).enumerate()
        {
            outputs[(row, state)] = weight.sqrt() / limit;
        }
        let input_weights = Matrix2::from_diagonal(&nalgebra::Vector2::new(
            1.0,
            weights.tilt_acceleration.sqrt() / MODEL.acceleration_limit,
        ));
        outputs.fixed_rows_mut::<2>(3).copy_from(&(input_weights * regulator.gains));
        let mut disturbances = vec![SVector::<f64, 2>::new(1.0, 0.3); COUNT];
        let mut cost = 0.0;
        for _ in 0..30 {
            let energy = disturbances.iter().map(|w| w.norm_squared()).sum::<f64>().sqrt();
            let mut state = SVector::<f64, 6>::zeros();
            let responses: Vec<_> = disturbances
                .iter()
                .map(|disturbance| {
                    state = transition * state + into_state * disturbance / energy;
                    outputs * state
                })
                .collect();
            cost = responses.iter().map(|response| response.norm_squared()).sum::<f64>();
            let mut adjoint = SVector::<f64, 6>::zeros();
            for (disturbance, response) in disturbances.iter_mut().zip(&responses).rev() {
                adjoint = transition.tr_mul(&adjoint) + outputs.tr_mul(response);
                *disturbance = into_state.tr_mul(&adjoint);
            }
        }
        cost.sqrt()
    }

    #[test]
    fn no_disturbance_of_unit_energy_costs_more_than_gamma_squared() {
        let gamma = DISTURBANCE.attenuation * least_gamma();
        let robust = worst_cost(&DISTURBANCE.regulator(&MODEL, &weights()).unwrap());
        let optimal = worst_cost(&Regulator::new(&MODEL, &weights()).unwrap());
        assert!(robust < gamma, "{robust} beside {gamma}");
        assert!(robust > 0.8 * least_gamma(), "the search finds bad disturbances: {robust}");
        assert!(optimal > 1.05 * robust, "the regulator of the mean is worse at the worst: {optimal}");
    }

    #[test]
    fn far_from_the_least_gamma_the_regulator_is_the_optimal_one() {
        let optimal = Regulator::new(&MODEL, &weights()).unwrap().gains;
        let apart = |attenuation: f64| {
            let robust = Disturbance { attenuation, ..DISTURBANCE }.regulator(&MODEL, &weights()).unwrap().gains;
            (robust - optimal).amax() / optimal.amax()
        };
        assert!(apart(1e3) < 1e-5 && apart(1.08) > 0.01, "{} and {}", apart(1e3), apart(1.08));
    }

    #[test]
    fn without_a_solution_there_is_no_regulator() {
        let weights = Weights { position: f64::NAN, ..weights() };
        assert_eq!(DISTURBANCE.regulator(&MODEL, &weights), Err(Unsolvable::RiccatiEquation));
    }
}
