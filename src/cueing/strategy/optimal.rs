//! The optimal strategy: a linear-quadratic regulator for each axis. The [`robust`](super::robust)
//! one is the same with other gains.
//!
//! After Sivan, Ish-Shalom and Huang (1982), Reid and Nahon (1985), and Telban and Cardullo
//! (NASA/CR-2005-213747), with the dropped force in place of the vestibular error. As feedback of
//! the motion that the limits leave, it needs no measure against wind-up.

use nalgebra::SVector;
use serde::{Deserialize, Serialize};

use super::at_rest_if_tiny;
use super::law::{AxisState, Decision, Law, LawInput, Unsolvable};
use super::minimax::Disturbance;
use super::regulator::{AxisModel, Gains, Regulator, State, Weights, control};
use crate::filter::bumpless::{GlidingOffset, compressed, expanded};
use crate::interface::{OptimalParameters, Parameters};

/// The strategy with its state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Optimal {
    models: [AxisModel; 2],
    gains: [Gains; 2],
    tuning: Tuning,
    /// Low-pass of each axis's reference, and the rest of it \[m/s2\].
    slow: [f64; 2],
    fast: [f64; 2],
    /// Gains in force less those, compressed.
    glides: [GlidingOffset<GAIN_COUNT>; 2],
    /// True if the last decision was to move.
    moves: bool,
}

/// Count of an axis's gains.
const GAIN_COUNT: usize = 12;
/// Up to these, gains to the dropped force and to the tilt's acceleration glide evenly.
const EVEN_GAINS: [f64; 2] = [0.3, 0.03];

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

    fn set_parameters(&mut self, models: &[AxisModel; 2], parameters: &Parameters) -> Result<(), Unsolvable> {
        self.retune(models, &(&parameters.optimal).into())
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
        Ok(Optimal {
            models: *models,
            gains: [regulator(0)?.gains, regulator(1)?.gains],
            tuning: *tuning,
            slow: [0.0; 2],
            fast: [0.0; 2],
            glides: [GlidingOffset::default(); 2],
            moves: false,
        })
    }

    /// Takes other parameters. In motion, the gains glide to theirs.
    ///
    /// # Errors
    /// The weights cannot be used. Nothing has changed then.
    pub fn retune(&mut self, models: &[AxisModel; 2], tuning: &Tuning) -> Result<(), Unsolvable> {
        if (models, tuning) == (&self.models, &self.tuning) {
            return Ok(());
        }
        let Optimal { models, gains, tuning, .. } = Optimal::new(models, tuning)?;
        if self.moves {
            for (glide, (before, after)) in self.glides.iter_mut().zip(self.gains.iter().zip(&gains)) {
                glide.add(&(gliding_gains(before) - gliding_gains(after)));
            }
        }
        *self = Optimal { models, gains, tuning, ..*self };
        Ok(())
    }

    /// Decision for a step of `step` seconds that begins in these states, with these
    /// references at its end.
    pub fn decide(&mut self, states: &[AxisState; 2], references: [f64; 2], step: f64) -> [Decision; 2] {
        let fraction = 1.0 - libm::exp(-step / self.tuning.split_time);
        let decisions = [0, 1].map(|k: usize| {
            self.glides[k].advance(step);
            self.slow[k] = at_rest_if_tiny(self.slow[k] + fraction * (references[k] - self.slow[k]));
            self.fast[k] = references[k] - self.slow[k];
            self.control(k, &states[k])
        });
        self.moves = decisions != [Decision::default(); 2];
        decisions
    }

    /// The decision in this state of an axis.
    fn control(&self, axis: usize, state: &AxisState) -> Decision {
        let AxisState { position, velocity, tilt, tilt_rate, .. } = *state;
        let state = State::new(position, velocity, tilt, tilt_rate, self.slow[axis], self.fast[axis]);
        let (gains, glide) = (&self.gains[axis], &self.glides[axis]);
        let [dropped_force, tilt_acceleration] =
            if glide.is_over() { control(gains, &state) } else { control(&gains_in_force(gains, glide), &state) };
        Decision { dropped_force, tilt_acceleration }
    }
}

/// Gains as they glide.
fn gliding_gains(gains: &Gains) -> SVector<f64, GAIN_COUNT> {
    let gliding = gains.map_with_location(|row, _, gain| compressed(gain, EVEN_GAINS[row]));
    SVector::from_column_slice(gliding.as_slice())
}

/// The gains in force on the way to these.
#[cold]
fn gains_in_force(gains: &Gains, glide: &GlidingOffset<GAIN_COUNT>) -> Gains {
    let gliding = gliding_gains(gains) + glide.values();
    Gains::from_column_slice(gliding.as_slice()).map_with_location(|row, _, gain| expanded(gain, EVEN_GAINS[row]))
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
        optimal.retune(&[MODEL; 2], &tuning()).unwrap();
        assert_eq!(optimal, before);
        let other = Tuning { weights: Weights { position: 2.0, ..tuning().weights }, ..tuning() };
        optimal.retune(&[MODEL; 2], &other).unwrap();
        assert_eq!(optimal.slow, before.slow);
        assert_ne!(optimal.slow, [0.0; 2]);
        let kept = optimal;
        let unusable = Weights { position: f64::NAN, ..other.weights };
        let refused = optimal.retune(&[MODEL; 2], &Tuning { weights: unusable, ..other });
        assert_eq!(refused, Err(Unsolvable::RiccatiEquation));
        assert_eq!(optimal, kept);
    }

    #[test]
    fn in_motion_the_gains_glide_from_the_old_to_the_new_and_at_rest_they_do_not() {
        let other = Tuning { weights: Weights { position: 200.0, ..tuning().weights }, ..tuning() };
        let made = Optimal::new(&[MODEL; 2], &other).unwrap();
        let mut resting = after(6, [0.0; 2]);
        resting.retune(&[MODEL; 2], &other).unwrap();
        assert_eq!(resting, made);

        let mut moving = after(6, [1.5, -0.7]);
        let state = AxisState { position: 0.1, velocity: 0.2, tilt: 0.05, ..AxisState::default() };
        let before = moving.control(0, &state);
        moving.retune(&[MODEL; 2], &other).unwrap();
        let difference = |a: Decision, b: Decision| {
            (a.dropped_force - b.dropped_force).abs() + (a.tilt_acceleration - b.tilt_acceleration).abs()
        };
        assert!(difference(moving.control(0, &state), before) < 1e-9);
        let farthest = difference(Optimal { slow: moving.slow, fast: moving.fast, ..made }.control(0, &state), before);
        assert!(farthest > 1.0, "{farthest}");
        let mut last = before;
        for _ in 0..600 {
            moving.decide(&[state; 2], [1.5, -0.7], STEP);
            let now = moving.control(0, &state);
            assert!(difference(now, last) < 0.05 * farthest, "{now:?} after {last:?}");
            last = now;
        }
        let all = Optimal { slow: moving.slow, fast: moving.fast, ..made }.control(0, &state);
        assert!(difference(last, all) < 1e-3 * farthest, "{last:?} beside {all:?}");
    }
}
