//! Inputs and outputs of the washout in a simulation.

use std::sync::Arc;

use crate::{Manoeuvre, Replay};
use moris_washout::interface::{AngularVelocityFrame, STANDARD_GRAVITY};
use moris_washout::motion::orientation::Orientation;
use moris_washout::nalgebra::Vector3;
use moris_washout::platform::LocationFrame;
use moris_washout::{Input, Output, ParameterError, Parameters, Washout};

use crate::foreign::Foreign;
use crate::preview::Previewer;
use crate::{Limits, TiltFlags, tilt_limits};

/// Every input and output of a simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Time between samples \[s\].
    pub step: f64,
    /// Parameters of the simulation.
    pub parameters: Parameters,
    /// The input at each sample.
    pub inputs: Arc<Vec<Input>>,
    /// The output at each sample; the first is that before the first step.
    pub outputs: Vec<Output>,
    /// The felt specific force at the first sample and after each internal step \[m/s2\].
    pub felt_within_steps: Vec<Vector3<f64>>,
    /// Where another washout computed the outputs: what is known of them.
    pub foreign: Option<Foreign>,
}

/// A simulation that is made part by part.
#[derive(Clone, Debug)]
pub struct Unfinished {
    washout: Washout,
    /// With the outputs so far.
    pub simulation: Simulation,
}

impl Unfinished {
    /// At the first sample, at rest at neutral.
    ///
    /// # Errors
    /// The parameters cannot be used: which, and why.
    pub fn begin(replay: &Replay, parameters: &Parameters) -> Result<Self, ParameterError> {
        let inputs = replay.inputs();
        let washout = Washout::new(parameters)?.starting_with(&inputs[0]);
        let mut outputs = Vec::with_capacity(inputs.len());
        outputs.push(washout.output());
        let felt_within_steps = vec![outputs[0].felt_specific_force];
        let simulation = Simulation {
            step: replay.step(),
            parameters: *parameters,
            inputs,
            outputs,
            felt_within_steps,
            foreign: None,
        };
        Ok(Unfinished { washout, simulation })
    }

    /// Simulates up to so many further samples of the same replay, with a preview before each step
    /// if there is a previewer. `progress` is called after each sample.
    pub fn advance(
        &mut self,
        replay: &Replay,
        samples: usize,
        previewer: Option<&Previewer>,
        mut progress: impl FnMut(),
    ) {
        let Simulation { outputs, felt_within_steps, .. } = &mut self.simulation;
        let at = outputs.len() - 1;
        let preview = |washout: &mut Washout, time: f64| {
            if let Some(previewer) = previewer {
                washout.preview(&previewer.at(time));
            }
        };
        replay.run_part(
            at..at.saturating_add(samples),
            &mut self.washout,
            preview,
            |felt| felt_within_steps.push(*felt),
            |_, output| {
                outputs.push(*output);
                progress();
            },
        );
    }
}

impl Simulation {
    /// Inputs alone, to be simulated with these parameters: no outputs yet.
    pub fn without_outputs(manoeuvre: &Manoeuvre, parameters: &Parameters) -> Self {
        Simulation {
            step: manoeuvre.step(),
            parameters: *parameters,
            inputs: manoeuvre.shared_inputs(),
            outputs: Vec::new(),
            felt_within_steps: Vec::new(),
            foreign: None,
        }
    }

    /// Replays a manoeuvre from rest at neutral. `progress` is called at each observation.
    ///
    /// # Errors
    /// The parameters cannot be used: which, and why.
    pub fn of(replay: &Replay, parameters: &Parameters, progress: impl FnMut()) -> Result<Self, ParameterError> {
        Simulation::previewed(replay, parameters, None, progress)
    }

    /// As [`Simulation::of`], with a preview before each step.
    ///
    /// # Errors
    /// The parameters cannot be used: which, and why.
    pub fn previewed(
        replay: &Replay,
        parameters: &Parameters,
        previewer: Option<Previewer>,
        mut progress: impl FnMut(),
    ) -> Result<Self, ParameterError> {
        let mut unfinished = Unfinished::begin(replay, parameters)?;
        progress();
        unfinished.advance(replay, usize::MAX, previewer.as_ref(), progress);
        Ok(unfinished.simulation)
    }

    /// The time of each sample \[s\].
    pub fn times(&self) -> Vec<f64> {
        (0..self.inputs.len()).map(|k| k as f64 * self.step).collect()
    }

    /// Angular velocity that the vehicle's rider feels, in head axes, at each sample \[rad/s\].
    pub fn desired_rates(&self) -> Vec<Vector3<f64>> {
        (0..self.inputs.len()).map(|k| self.desired_rate(k)).collect()
    }

    /// Desired angular velocity at one sample \[rad/s\].
    pub fn desired_rate(&self, sample: usize) -> Vector3<f64> {
        let input = &self.inputs[sample];
        let in_body = match self.parameters.conditioning.angular_velocity_frame {
            AngularVelocityFrame::Body => input.angular_velocity,
            AngularVelocityFrame::World => {
                Orientation::new(input.orientation).rotation.transpose() * input.angular_velocity
            }
        };
        LocationFrame::new(&self.parameters.structure, input.lean).to_location_axes(in_body)
    }

    /// The felt specific force at a sample as a deviation from rest \[m/s2\].
    pub fn felt_without_gravity(&self, sample: usize) -> Vector3<f64> {
        self.outputs[sample].felt_specific_force - Vector3::z() * STANDARD_GRAVITY
    }

    /// The limits of tilt coordination that act, of roll and pitch, at each sample.
    pub fn tilt_limits(&self) -> TiltFlags {
        let series = |value: fn(&Output) -> f64| self.outputs.iter().map(value).collect::<Vec<f64>>();
        let lags: Vec<bool> = self.outputs.iter().map(|output| output.tilt_limited).collect();
        let [roll, pitch] = [series(|output| output.tilt_roll), series(|output| output.tilt_pitch)];
        let [roll_rate, pitch_rate] = [series(|output| output.tilt_roll_rate), series(|output| output.tilt_pitch_rate)];
        let limits = Limits::from(&self.parameters);
        tilt_limits(&self.times(), &lags, [&roll, &pitch], [&roll_rate, &pitch_rate], &limits)
    }
}
