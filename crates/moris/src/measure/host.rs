//! A recording replayed as a host does it: in steps of the host's length, with or without
//! slopes of the inputs.

use anyhow::{Result, bail};
use moris_washout::{Input, Output, Parameters, Preview, Washout};

use crate::ride::Ride;
use crate::ride::preview::Previewer;
use crate::run::Recording;

/// Input within a step, as given by the host.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Inputs {
    /// Value and slope: the input goes linearly through the step
    #[default]
    Slopes,
    /// The value at the step's start alone
    Values,
}

/// The host's communication steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Host {
    /// Length of a step \[s\]; none: the recording's.
    pub step: Option<f64>,
    /// Input within a step, as given by the host.
    pub inputs: Inputs,
    /// Length of the preview that the host gives \[s\]; 0: none.
    pub preview: f64,
}

/// Tolerance of the ratio of two steps against a whole number.
const ROUNDING: f64 = 1e-6;

impl Host {
    /// Replays a recording from rest at neutral. Between its samples the recording is linear;
    /// outputs are kept at its samples, or at the ends of the host's steps where those are longer.
    ///
    /// # Errors
    /// The parameters cannot be used, or neither of the host's step and the recording's is a
    /// multiple of the other.
    pub fn replay(&self, ride: &Ride, parameters: &Parameters) -> Result<Recording> {
        let steps = Steps::of(ride, self.step)?;
        let mut inputs = ride.inputs().iter().step_by(steps.samples);
        let mut last = *inputs.next().unwrap_or(&Input::default());
        let mut washout = Washout::new(parameters)?.starting_with(&last);
        let mut recording = Recording {
            step: steps.samples as f64 * ride.step(),
            parameters: *parameters,
            inputs: vec![last],
            outputs: vec![washout.output()],
        };
        let previewer = Previewer::new(ride.inputs(), ride.step(), self.preview);
        for input in inputs {
            let start = (recording.inputs.len() - 1) as f64 * recording.step;
            let preview = |k: usize| previewer.at(start + k as f64 * steps.step);
            let output = self.between_samples(&mut washout, &last, input, preview, &steps);
            recording.inputs.push(*input);
            recording.outputs.push(output);
            last = *input;
        }
        Ok(recording)
    }

    /// The output at the end of the steps between two inputs; its flags say what
    /// acted in any of them.
    fn between_samples(
        &self,
        washout: &mut Washout,
        from: &Input,
        to: &Input,
        preview: impl Fn(usize) -> Preview,
        steps: &Steps,
    ) -> Output {
        let mut flags = [false; 3];
        for k in 0..steps.divisions {
            let at = |k: usize| from.towards(to, k as f64 / steps.divisions as f64);
            if self.preview > 0.0 {
                washout.preview(&preview(k));
            }
            match self.inputs {
                Inputs::Slopes => washout.step_between(&at(k), &at(k + 1), steps.step),
                Inputs::Values => washout.step(&at(k), steps.step),
            }
            let Output { tilt_limited, safety_active, actuator_limited, .. } = washout.output();
            flags = [flags[0] | tilt_limited, flags[1] | safety_active, flags[2] | actuator_limited];
        }
        let [tilt_limited, safety_active, actuator_limited] = flags;
        Output { tilt_limited, safety_active, actuator_limited, ..washout.output() }
    }
}

/// Relation of the host's steps to the recording's samples.
struct Steps {
    /// Samples from one kept output to the next.
    samples: usize,
    /// Host steps from one kept output to the next.
    divisions: usize,
    /// Length of the host's step \[s\].
    step: f64,
}

impl Steps {
    fn of(ride: &Ride, step: Option<f64>) -> Result<Self> {
        let sample = ride.step();
        let step = step.unwrap_or(sample);
        let whole = |ratio: f64| {
            let count = ratio.round();
            (count >= 1.0 && (ratio - count).abs() <= ROUNDING * count).then_some(count as usize)
        };
        match (whole(sample / step), whole(step / sample)) {
            (Some(divisions), _) => Ok(Steps { samples: 1, divisions, step: sample / divisions as f64 }),
            (None, Some(samples)) => Ok(Steps { samples, divisions: 1, step: samples as f64 * sample }),
            (None, None) => bail!(
                "--step is {step} s, but the samples of {} come every {sample} s; one must be a multiple of the other",
                ride.name
            ),
        }
    }
}
