//! The objective: sensed error of a recording, and penalties for active limits.
//!
//! A recording has six channels: specific force and angular velocity along x, y and z. Each is the
//! vestibular model's response in units of the perception threshold, so that forces and rates can
//! be added. With e_k the RMS of felt minus desired on channel k, d_k the RMS of desired, and w_k
//! the channel's weight, the recording's error is
//!
//! sqrt(sum w_k e_k^2) / sqrt(sum w_k d_k^2),
//!
//! with the denominator at least 1 threshold. 0 is perfect. Above that threshold, a platform at
//! rest scores 1 on any recording, so that scaling everything down to zero
//! gains nothing. False cues on channels with no desired motion count as they are sensed.

use std::sync::OnceLock;

use moris_measures::cues::{FORCE_THRESHOLDS, RATE_THRESHOLDS};
use moris_measures::vestibular::{CANALS, OTOLITHS, sensed};
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::Vector3;
use moris_washout::{Output, ParameterError, Parameters, Washout};

use super::space::{orders, with_orders};
use crate::recording::Recording;
use crate::simulate::Simulation;

/// Six channels: specific force x, y, z, angular velocity x, y, z.
pub type Channels<T> = [T; 6];

/// Cost of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// RMS error of each channel, in thresholds.
    pub channels: Channels<f64>,
    /// The recording's error: 0 is perfect, 1 is a platform at rest.
    pub error: f64,
    /// Fraction of the steps in which a safety unit or the actuator guard was active or the
    /// reserve of stroke was touched.
    pub violated: f64,
}

impl Cost {
    /// True if all constraints were kept throughout.
    pub fn is_feasible(&self) -> bool {
        self.violated == 0.0
    }
}

/// A recording that parameters are judged on.
#[derive(Clone, Debug)]
pub struct Objective {
    name: String,
    recording: Recording,
    desired: Channels<Vec<f64>>,
    /// RMS of each channel as it is desired, in thresholds.
    desired_rms: Channels<f64>,
    weights: Channels<f64>,
    /// Every actuator stays this far from either end of its stroke \[m\].
    stroke_reserve: f64,
    /// The fixed parameters, with the recording's step as internal step, at most [`LONGEST_STEP`].
    fixed: Parameters,
    /// Washouts at rest, indexed by the orders of splitter and angular channel less 2. They are
    /// kept, because constructing a washout surveys its rig.
    coarse: [[OnceLock<Washout>; 3]; 3],
}

/// Longest internal step in the search \[s\], unless the parameters have a longer one. The filters
/// are exact for any step, but the limits act more coarsely. So the result is simulated again with
/// the internal step that it will be used with.
const LONGEST_STEP: f64 = 0.02;

/// Fraction of the acceleration limits that the search's long steps may use. The rest allows for
/// the variation of acceleration within a step.
const RESERVE_OF_ACCELERATION: f64 = 0.85;

impl Objective {
    /// The objective on a recording, for parameters that share the fixed ones of these except
    /// orders. Every actuator must stay `stroke_reserve` \[m\] from either end of its stroke.
    ///
    /// # Errors
    /// The parameters cannot be used.
    pub fn new(
        recording: Recording,
        parameters: &Parameters,
        weights: &Channels<f64>,
        stroke_reserve: f64,
    ) -> Result<Self, ParameterError> {
        let mut parameters = recording.parameters(parameters);
        let desired = desired(&recording, &parameters);
        parameters.structure.max_step = recording.step().min(LONGEST_STEP).max(parameters.structure.max_step);
        parameters.rig.acceleration_limit *= RESERVE_OF_ACCELERATION;
        let desired_rms = std::array::from_fn(|k| sensed_rms(k, &desired[k], recording.step()));
        let objective = Objective {
            name: recording.name.clone(),
            recording,
            desired,
            desired_rms,
            weights: *weights,
            stroke_reserve,
            fixed: parameters,
            coarse: Default::default(),
        };
        objective.coarse(&parameters)?;
        Ok(objective)
    }

    /// The recording's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The recording.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// RMS of each channel as it is desired, in thresholds.
    pub fn desired_rms(&self) -> &Channels<f64> {
        &self.desired_rms
    }

    /// The weighted Euclidean norm of the channels.
    fn weighted(&self, channels: &Channels<f64>) -> f64 {
        channels.iter().zip(&self.weights).map(|(value, weight)| weight * value * value).sum::<f64>().sqrt()
    }

    /// Cost of the recording with these parameters, in the search's long steps.
    ///
    /// # Errors
    /// The parameters cannot be used.
    pub fn coarse_cost(&self, parameters: &Parameters) -> Result<Cost, ParameterError> {
        let mut washout = self.coarse(parameters)?.clone();
        let mut parameters = self.recording.parameters(parameters);
        let Parameters { structure, rig, .. } = washout.parameters();
        (parameters.structure, parameters.rig) = (*structure, *rig);
        parameters.safety.acceleration_limit *= RESERVE_OF_ACCELERATION;
        washout.retune(&parameters)?;
        let mut washout = washout.starting_with(&self.recording.inputs()[0]);
        let mut accumulator = CostAccumulator::new(self);
        accumulator.add(&washout.output());
        self.recording.replay().run(&mut washout, |_, output| accumulator.add(output));
        Ok(accumulator.cost())
    }

    /// A washout at rest with the fixed parameters and the orders of these.
    fn coarse(&self, parameters: &Parameters) -> Result<&Washout, ParameterError> {
        let orders = orders(parameters);
        let [splitter, angular] = orders.map(|order| order.clamp(2, 4) as usize - 2);
        let place = &self.coarse[splitter][angular];
        if let Some(washout) = place.get() {
            return Ok(washout);
        }
        let washout = Washout::new(&with_orders(&self.fixed, orders))?;
        Ok(place.get_or_init(|| washout))
    }

    /// Cost of a simulation.
    pub fn cost(&self, simulation: &Simulation) -> Cost {
        let mut accumulator = CostAccumulator::new(self);
        simulation.outputs.iter().for_each(|output| accumulator.add(output));
        accumulator.cost()
    }
}

/// Accumulated cost.
struct CostAccumulator<'a> {
    objective: &'a Objective,
    errors: Channels<Vec<f64>>,
    violated: usize,
}

impl<'a> CostAccumulator<'a> {
    fn new(objective: &'a Objective) -> Self {
        let samples = objective.desired[0].len();
        CostAccumulator { objective, errors: std::array::from_fn(|_| Vec::with_capacity(samples)), violated: 0 }
    }

    fn add(&mut self, output: &Output) {
        let sample = self.errors[0].len();
        let force = output.felt_specific_force - rest();
        for (k, felt) in channels(force, output.felt_angular_velocity).into_iter().enumerate() {
            self.errors[k].push(felt - self.objective.desired[k][sample]);
        }
        let touched = output.stroke_margin < self.objective.stroke_reserve;
        self.violated += usize::from(output.safety_active || output.actuator_limited || touched);
    }

    fn cost(self) -> Cost {
        let Objective { recording, desired_rms, .. } = self.objective;
        let channels = std::array::from_fn(|k| sensed_rms(k, &self.errors[k], recording.step()));
        // If the desired motion is below a threshold, its error is not magnified.
        let whole = self.objective.weighted(desired_rms).max(1.0);
        Cost {
            channels,
            error: self.objective.weighted(&channels) / whole,
            violated: self.violated as f64 / self.errors[0].len() as f64,
        }
    }
}

/// The desired channels, as deviations from rest.
fn desired(recording: &Recording, parameters: &Parameters) -> Channels<Vec<f64>> {
    let simulation = Simulation::without_outputs(recording, parameters);
    let rates = simulation.desired_rates();
    let samples =
        simulation.inputs.iter().zip(rates).map(|(input, rate)| channels(input.specific_force - rest(), rate));
    let samples: Vec<Channels<f64>> = samples.collect();
    std::array::from_fn(|k| samples.iter().map(|sample| sample[k]).collect())
}

/// The specific force at rest.
fn rest() -> Vector3<f64> {
    Vector3::new(0.0, 0.0, STANDARD_GRAVITY)
}

fn channels(force: Vector3<f64>, rate: Vector3<f64>) -> Channels<f64> {
    [force.x, force.y, force.z, rate.x, rate.y, rate.z]
}

/// RMS of the sensed signal of channel `k`, in thresholds. `signal` is the deviation from rest.
fn sensed_rms(k: usize, signal: &[f64], step: f64) -> f64 {
    let (organ, threshold) = if k < 3 { (&OTOLITHS, FORCE_THRESHOLDS[k]) } else { (&CANALS, RATE_THRESHOLDS[k - 3]) };
    let sensed = sensed(organ, signal, 0.0, step);
    (sensed.iter().map(|value| value * value).sum::<f64>() / sensed.len() as f64).sqrt() / threshold
}
