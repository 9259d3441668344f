//! One manoeuvre, many parameter sets.
//!
//! A [`Replay`] takes a washout through a [`Manoeuvre`] and shows each output. Replays share
//! nothing that changes, so that rayon spreads parameter sets over all cores. Each here keeps a
//! sum, and the batch the least, so that the memory does not grow with the number of sets.
//!
//! ```
//! use moris_simulation::{Manoeuvre, Replay};
//! use moris_washout::{Input, ParameterError, Parameters, Washout};
//! use rayon::prelude::*;
//!
//! let accelerate = Manoeuvre::sampled(0.01, 20.0, |time| {
//!     let mut input = Input::default();
//!     input.specific_force.x = (0.2 * time).min(1.0);
//!     input
//! });
//! let rms_error = |parameters: &Parameters| -> Result<f64, ParameterError> {
//!     let (mut sum, mut count) = (0.0, 0.0);
//!     Replay::new(&accelerate).run(&mut Washout::new(parameters)?, |input, output| {
//!         sum += (output.felt_specific_force.x - input.specific_force.x).powi(2);
//!         count += 1.0;
//!     });
//!     Ok(f64::sqrt(sum / count))
//! };
//! let frequencies = (1..=8).into_par_iter().map(|k| {
//!     let mut parameters = Parameters::default();
//!     parameters.splitter.omega1.x = 0.5 * f64::from(k);
//!     parameters
//! });
//! let best = frequencies
//!     .filter_map(|parameters| Some((rms_error(&parameters).ok()?, parameters)))
//!     .min_by(|a, b| a.0.total_cmp(&b.0))
//!     .expect("one set at least can be used");
//! assert!(best.0 < 0.1);
//! ```

use std::ops::Range;
use std::sync::Arc;

use moris_washout::{Input, InputCourse, Output, Washout};
use nalgebra::Vector3;

use crate::Manoeuvre;

/// Communication steps with which a manoeuvre is replayed. Between its samples it is linear.
#[derive(Clone, Copy, Debug)]
pub struct Replay<'a> {
    manoeuvre: &'a Manoeuvre,
    /// Samples from one observation to the next.
    samples: usize,
    /// Communication steps from one observation to the next.
    divisions: usize,
    /// True if the washout gets each step's slopes; else it gets the values at the step's start.
    slopes: bool,
}

impl<'a> Replay<'a> {
    /// A step a sample, through which the inputs go linearly.
    pub fn new(manoeuvre: &'a Manoeuvre) -> Self {
        Replay { manoeuvre, samples: 1, divisions: 1, slopes: true }
    }

    /// Steps of this length \[s\], with the inputs' slopes or without. None if neither of the step
    /// and the time between samples is a multiple of the other.
    pub fn in_steps(manoeuvre: &'a Manoeuvre, step: f64, slopes: bool) -> Option<Self> {
        // Tolerance of the ratio of two steps against a whole number.
        const STEP_RATIO_TOLERANCE: f64 = 1e-6;
        let whole = |ratio: f64| {
            let count = ratio.round();
            (count >= 1.0 && (ratio - count).abs() <= STEP_RATIO_TOLERANCE * count).then_some(count as usize)
        };
        let sample = manoeuvre.step();
        match (whole(sample / step), whole(step / sample)) {
            (Some(divisions), _) => Some(Replay { manoeuvre, samples: 1, divisions, slopes }),
            (None, Some(samples)) => Some(Replay { manoeuvre, samples, divisions: 1, slopes }),
            (None, None) => None,
        }
    }

    /// Time between observations \[s\].
    pub fn step(&self) -> f64 {
        self.samples as f64 * self.manoeuvre.step()
    }

    /// The inputs at the observations; the first is that before the first step.
    pub fn inputs(&self) -> Arc<Vec<Input>> {
        match self.samples {
            1 => self.manoeuvre.shared_inputs(),
            samples => Arc::new(self.manoeuvre.inputs().iter().step_by(samples).copied().collect()),
        }
    }

    /// Replays the manoeuvre. `observe` receives the input and the output at the end of each step,
    /// or of each sample where steps are shorter. An output's flags are then those of all steps
    /// since the output before.
    pub fn run(&self, washout: &mut Washout, observe: impl FnMut(&Input, &Output)) {
        self.run_part(0..usize::MAX, washout, |_, _| (), |_| (), observe);
    }

    /// As [`Replay::run`], with the steps between these observations only. The washout is as at the
    /// first of them; the last may be beyond the end. `prepare` is called before each step with the
    /// time at its start \[s\], and `feel` with the felt specific force after each internal step
    /// \[m/s2\].
    pub fn run_part(
        &self,
        part: Range<usize>,
        washout: &mut Washout,
        mut prepare: impl FnMut(&mut Washout, f64),
        mut feel: impl FnMut(&Vector3<f64>),
        mut observe: impl FnMut(&Input, &Output),
    ) {
        let step = self.step() / self.divisions as f64;
        let inputs = self.manoeuvre.inputs();
        let intervals = inputs.len().saturating_sub(1) / self.samples;
        for index in part.start..part.end.min(intervals) {
            let [from, to] = [index, index + 1].map(|k| &inputs[k * self.samples]);
            let start = index as f64 * self.step();
            let at = |k: usize| match k {
                0 => *from,
                k if k == self.divisions => *to,
                k => from.towards(to, k as f64 / self.divisions as f64),
            };
            prepare(washout, start);
            let mut output = self.advance(washout, &at(0), &at(1), step, &mut feel);
            for k in 1..self.divisions {
                let before = output;
                prepare(washout, start + k as f64 * step);
                output = self.advance(washout, &at(k), &at(k + 1), step, &mut feel);
                output.tilt_limited |= before.tilt_limited;
                output.soft_limited |= before.soft_limited;
                output.safety_active |= before.safety_active;
                output.actuator_limited |= before.actuator_limited;
            }
            observe(to, &output);
        }
    }

    fn advance(
        &self,
        washout: &mut Washout,
        start: &Input,
        end: &Input,
        step: f64,
        feel: impl FnMut(&Vector3<f64>),
    ) -> Output {
        let course = if self.slopes { InputCourse::Between(start, end) } else { washout.reconstructed(start) };
        washout.follow(course, step, feel);
        washout.output()
    }
}

#[cfg(test)]
mod tests {
    use moris_washout::Parameters;

    use super::*;

    fn swing(size: f64) -> Manoeuvre {
        Manoeuvre::sampled(0.01, 1.0, |time| {
            let mut input = Input::default();
            input.specific_force.x = size * (5.0 * time).sin();
            input
        })
    }

    fn outputs(replay: &Replay, parameters: &Parameters) -> Vec<Output> {
        let mut washout = Washout::new(parameters).unwrap();
        let mut outputs = Vec::new();
        replay.run(&mut washout, |_, output| outputs.push(*output));
        outputs
    }

    #[test]
    fn steps_that_fit_are_taken_and_others_rejected() {
        let manoeuvre = swing(1.0);
        assert_eq!(outputs(&Replay::in_steps(&manoeuvre, 0.002, true).unwrap(), &Parameters::default()).len(), 100);
        assert_eq!(outputs(&Replay::in_steps(&manoeuvre, 0.05, true).unwrap(), &Parameters::default()).len(), 20);
        assert!(Replay::in_steps(&manoeuvre, 0.007, true).is_none());
    }

    #[test]
    fn divided_steps_with_slopes_end_where_whole_ones_do() {
        let manoeuvre = swing(1.0);
        let whole = outputs(&Replay::new(&manoeuvre), &Parameters::default());
        let divided = outputs(&Replay::in_steps(&manoeuvre, 0.001, true).unwrap(), &Parameters::default());
        for (whole, divided) in whole.iter().zip(&divided) {
            // The internal steps are the same, so that only the inputs' rounding differs.
            assert!((whole.position - divided.position).norm() < 1e-12);
        }
        let held = outputs(&Replay::in_steps(&manoeuvre, 0.001, false).unwrap(), &Parameters::default());
        let lag = (held[99].felt_specific_force - divided[99].felt_specific_force).norm();
        assert!(1e-6 < lag && lag < 0.1, "{lag}");
    }

    #[test]
    fn parts_are_the_whole() {
        let manoeuvre = swing(1.0);
        for step in [0.002, 0.01, 0.03] {
            let replay = Replay::in_steps(&manoeuvre, step, true).unwrap();
            let mut washout = Washout::new(&Parameters::default()).unwrap();
            let mut parts = Vec::new();
            for part in [0..1, 1..1, 1..20, 20..usize::MAX] {
                replay.run_part(part, &mut washout, |_, _| (), |_| (), |_, output| parts.push(*output));
            }
            assert_eq!(parts, outputs(&replay, &Parameters::default()));
        }
    }

    #[test]
    fn flags_of_divided_steps_are_those_of_any_of_them() {
        let manoeuvre = swing(9.0);
        let mut parameters = Parameters::default();
        parameters.safety.position_limit /= 10.0;
        let flags = |replay: &Replay| -> Vec<[bool; 4]> {
            let flags = |o: &Output| [o.tilt_limited, o.soft_limited, o.safety_active, o.actuator_limited];
            outputs(replay, &parameters).iter().map(flags).collect()
        };
        let whole = flags(&Replay::new(&manoeuvre));
        assert_eq!(whole, flags(&Replay::in_steps(&manoeuvre, 0.001, true).unwrap()));
        let soft = whole.iter().filter(|flags| flags[1]).count();
        assert!(0 < soft && soft < whole.len(), "{soft}");
    }
}
