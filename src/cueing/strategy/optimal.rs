//! The optimal strategy: a linear-quadratic regulator for each axis. The [`robust`](super::robust)
//! one is the same with other gains.
//!
//! After Sivan, Ish-Shalom and Huang (1982), Reid and Nahon (1985), and Telban and Cardullo
//! (NASA/CR-2005-213747), with the dropped force in place of the vestibular error. As feedback of
//! the motion that the limits leave, it needs no measure against wind-up.

use serde::{Deserialize, Serialize};

use super::at_rest_if_tiny;
use super::law::{AxisState, Decision, Jump, Law, LawInput, Unsolvable};
use super::minimax::Disturbance;
use super::regulator::{AxisModel, Regulator, State, Weights};
use crate::interface::{OptimalParameters, Parameters};

/// The strategy with its state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Optimal {
    models: [AxisModel; 2],
    regulators: [Regulator; 2],
    tuning: Tuning,
    /// Low-pass of each axis's reference, and the rest of it \[m/s2\].
    slow: [f64; 2],
    fast: [f64; 2],
}

/// The tunable parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tuning {
    pub weights: Weights,
    /// Time constant that splits the reference into its slow and its fast part \[s\].
    pub split_time: f64,
    /// Disturbance that the robust strategy withstands; none for the optimal one.
    pub disturbance: Option<Disturbance>,
}

impl From<&OptimalParameters> for Tuning {
    #[rustfmt::skip]
    fn from(parameters: &OptimalParameters) -> Self {
        let OptimalParameters {
            weight_position: position, weight_velocity: velocity, weight_tilt_rate: tilt_rate,
            weight_tilt_acceleration: tilt_acceleration, slow_pole, fast_pole, split_time,
        } = *parameters;
        let weights = Weights { position, velocity, tilt_rate, tilt_acceleration, slow_pole, fast_pole };
        Tuning { weights, split_time, disturbance: None }
    }
}

impl Law for Optimal {
    fn at_rest(models: &[AxisModel; 2], parameters: &Parameters) -> Result<Self, Unsolvable> {
        Optimal::new(models, &(&parameters.optimal).into())
    }

    fn set_parameters(
        &mut self,
        models: &[AxisModel; 2],
        parameters: &Parameters,
        states: &[AxisState; 2],
    ) -> Result<[Jump; 2], Unsolvable> {
        self.retune(models, &(&parameters.optimal).into(), states)
    }

    fn decisions(&mut self, law_input: &LawInput, step: f64) -> Option<[Decision; 2]> {
        Some(self.decide(&law_input.states, law_input.references, step))
    }
}

/// Travel above which its weight no longer falls with the square of its limit, and the least that a
/// longer one counts as \[m\].
const WEIGHED_TRAVEL: [f64; 2] = [0.45, 0.3];

/// The model whose limit of travel the weights refer to.
///
/// A long travel is used up before the tilt, whose rate is the same on every rig, can give it
/// back. Beyond D, the first of [`WEIGHED_TRAVEL`], the weights of the travel L therefore grow: L
/// counts as D^2/L. Their growth has an end: a platform that keeps too near to its middle
/// gives less.
pub(in crate::cueing) fn weighed(model: &AxisModel) -> AxisModel {
    let [most, least] = WEIGHED_TRAVEL;
    let limit = model.position_limit;
    AxisModel { position_limit: limit.min((most * most / limit).max(least)), ..*model }
}

impl Optimal {
    /// At rest.
    ///
    /// # Errors
    /// The weights cannot be used.
    pub fn new(models: &[AxisModel; 2], tuning: &Tuning) -> Result<Self, Unsolvable> {
        let regulator = |axis: usize| match &tuning.disturbance {
            None => Regulator::new(&weighed(&models[axis]), &tuning.weights),
            Some(disturbance) => disturbance.regulator(&weighed(&models[axis]), &tuning.weights),
        };
        let regulators = [regulator(0)?, regulator(1)?];
        Ok(Optimal { models: *models, regulators, tuning: *tuning, slow: [0.0; 2], fast: [0.0; 2] })
    }

    /// Takes other parameters. Returns by how much less the dropped forces are for them in these
    /// states.
    ///
    /// # Errors
    /// The weights cannot be used. Nothing has changed then.
    pub fn retune(
        &mut self,
        models: &[AxisModel; 2],
        tuning: &Tuning,
        states: &[AxisState; 2],
    ) -> Result<[Jump; 2], Unsolvable> {
        if (models, tuning) == (&self.models, &self.tuning) {
            return Ok([Jump::default(); 2]);
        }
        let before = *self;
        *self = Optimal { slow: self.slow, fast: self.fast, ..Optimal::new(models, tuning)? };
        let at_rest = |law: &Optimal| Optimal { slow: [0.0; 2], fast: [0.0; 2], ..*law };
        let less = |before: &Optimal, after: &Optimal, k: usize, state: &AxisState| {
            before.control(k, state).dropped_force - after.control(k, state).dropped_force
        };
        Ok([0, 1].map(|k: usize| Jump {
            force: less(&before, self, k, &states[k]),
            slope: less(&at_rest(&before), &at_rest(self), k, &states[k].coasting()),
        }))
    }

    /// Decision for a step of `step` seconds that begins in these states, with these
    /// references at its end.
    pub fn decide(&mut self, states: &[AxisState; 2], references: [f64; 2], step: f64) -> [Decision; 2] {
        let fraction = 1.0 - libm::exp(-step / self.tuning.split_time);
        [0, 1].map(|k: usize| {
            self.slow[k] = at_rest_if_tiny(self.slow[k] + fraction * (references[k] - self.slow[k]));
            self.fast[k] = references[k] - self.slow[k];
            self.control(k, &states[k])
        })
    }

    /// The decision in this state of an axis.
    fn control(&self, axis: usize, state: &AxisState) -> Decision {
        let AxisState { position, velocity, tilt, tilt_rate, .. } = *state;
        let state = State::new(position, velocity, tilt, tilt_rate, self.slow[axis], self.fast[axis]);
        let [dropped_force, tilt_acceleration] = self.regulators[axis].control(&state);
        Decision { dropped_force, tilt_acceleration }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cueing::strategy::regulator::tests::MODEL;
    use crate::interface::Parameters;

    const STEP: f64 = 0.01;

    fn tuning() -> Tuning {
        (&Parameters::default().optimal).into()
    }

    fn after(steps: usize, references: [f64; 2]) -> Optimal {
        let mut optimal = Optimal::new(&[MODEL; 2], &tuning()).unwrap();
        for _ in 0..steps {
            optimal.decide(&[AxisState::default(); 2], references, STEP);
        }
        optimal
    }

    #[test]
    fn the_reference_is_split_by_a_low_pass_and_fed_back_with_the_state() {
        let references = [1.5, -0.7];
        let states = [0.1, -0.2].map(|position| AxisState {
            position,
            velocity: 0.3 * position,
            tilt: -0.4 * position,
            tilt_rate: 0.05 * position,
            tilt_acceleration: 0.0,
        });
        let mut optimal = after(6, references);
        let decisions = optimal.decide(&states, references, STEP);
        let gains = Regulator::new(&weighed(&MODEL), &tuning().weights).unwrap().gains;
        for k in 0..2 {
            let slow = references[k] * (1.0 - (-7.0 * STEP / tuning().split_time).exp());
            let AxisState { position, velocity, tilt, tilt_rate, .. } = states[k];
            let state = [position, velocity, tilt, tilt_rate, slow, references[k] - slow];
            let expected = [0, 1].map(|i| -(0..6).map(|j| gains[(i, j)] * state[j]).sum::<f64>());
            let Decision { dropped_force, tilt_acceleration } = decisions[k];
            assert!((dropped_force - expected[0]).abs() < 1e-12, "{dropped_force} beside {expected:?}");
            assert!((tilt_acceleration - expected[1]).abs() < 1e-12, "{tilt_acceleration} beside {expected:?}");
        }
    }

    #[test]
    fn a_longer_travel_counts_as_less_but_not_as_none() {
        let counts_as = |position_limit| weighed(&AxisModel { position_limit, ..MODEL }).position_limit;
        for (limit, expected) in [(0.1, 0.1), (0.45, 0.45), (0.5, 0.405), (0.675, 0.3), (0.9, 0.3), (1e9, 0.3)] {
            assert!((counts_as(limit) - expected).abs() < 1e-12, "{limit} m as {} m", counts_as(limit));
        }
    }

    #[test]
    fn retuning_keeps_the_slow_part_and_without_a_regulator_everything() {
        let mut optimal = after(6, [1.5, -0.7]);
        let before = optimal;
        let states = [AxisState { position: 0.1, velocity: 0.2, tilt: 0.05, ..AxisState::default() }; 2];
        optimal.retune(&[MODEL; 2], &tuning(), &states).unwrap();
        assert_eq!(optimal, before);
        let other = Tuning { weights: Weights { position: 2.0, ..tuning().weights }, ..tuning() };
        let jumps = optimal.retune(&[MODEL; 2], &other, &states).unwrap();
        let made = Optimal::new(&[MODEL; 2], &other).unwrap();
        assert_eq!(optimal, Optimal { slow: before.slow, fast: before.fast, ..made });
        for k in 0..2 {
            let state = State::new(0.1, 0.2, 0.05, 0.0, before.slow[k], before.fast[k]);
            let [old, new] = [&before, &made].map(|law| law.regulators[k].control(&state)[0]);
            let found = jumps[k].force;
            assert!((found - (old - new)).abs() < 1e-12 && found.abs() > 1e-3, "{found}");
            let gain = |law: &Optimal| law.regulators[k].gains[(0, 0)];
            assert!((jumps[k].slope - 0.2 * (gain(&made) - gain(&before))).abs() < 1e-12, "{jumps:?}");
        }
        assert_ne!(optimal.slow, [0.0; 2]);
        let kept = optimal;
        let unusable = Weights { position: f64::NAN, ..other.weights };
        let refused = optimal.retune(&[MODEL; 2], &Tuning { weights: unusable, ..other }, &states);
        assert_eq!(refused, Err(Unsolvable::RiccatiEquation));
        assert_eq!(optimal, kept);
    }
}
