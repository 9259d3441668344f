//! The objective: shape of the felt force of a recording, then its size, time with active limits,
//! and discomfort.
//!
//! The error of a recording is a weighted sum of three parts, each 0 where it is perfect and 1 for
//! a platform at rest:
//!
//! - what is felt wrong: 1 - shape + 2 inverted, the mean of surge and sway;
//! - what is felt too small: 1 - size, with the geometric mean of surge and sway, so that neither
//!   vanishes. A size above 1 counts as its reciprocal;
//! - the sensed error of all channels.
//!
//! Axes of surge and sway on which hardly anything is desired do not count. Where neither counts,
//! the sensed error is the error.
//!
//! A recording has six channels: specific force and angular velocity along x, y and z. Each is the
//! vestibular model's response in units of the perception threshold, so that forces and rates can
//! be added. With e_k the RMS of felt minus desired on channel k, d_k the RMS of desired, and w_k
//! the channel's weight, the sensed error is
//!
//! sqrt(sum w_k e_k^2) / sqrt(sum w_k d_k^2),
//!
//! with the denominator at least 1 threshold. 0 is perfect. Above that threshold, a platform at
//! rest scores 1 on any recording, so that scaling everything down to zero
//! gains nothing. False cues on channels with no desired motion count as they are sensed.

use moris_simulation::measures::statistics::rms;
use std::sync::OnceLock;

use moris_simulation::measures::comfort::{Reference, divisions};
use moris_simulation::measures::cues::{FORCE_THRESHOLDS, RATE_THRESHOLDS};
use moris_simulation::measures::shape::{AxisShape, Desired, Shape};
use moris_simulation::measures::vestibular::{CANALS, OTOLITHS, sensed};
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::Vector3;
use moris_washout::{Output, ParameterError, Parameters, Washout};

use super::space::{orders, with_orders};
use crate::recording::Recording;
use moris_simulation::Simulation;

/// Six channels: specific force x, y, z, angular velocity x, y, z.
pub type Channels<T> = [T; 6];

/// The channels on which none of these recordings desires a motion that is felt, by the RMS of each
/// in thresholds.
pub fn still_channels<'a>(desired: impl Iterator<Item = &'a Channels<f64>>) -> Channels<bool> {
    // Largest RMS of a channel on which nothing is desired [thresholds].
    const NOTHING_DESIRED: f64 = 0.1;
    let largest = desired.fold([0.0; 6], |largest: Channels<f64>, rms| std::array::from_fn(|k| largest[k].max(rms[k])));
    largest.map(|rms| rms < NOTHING_DESIRED)
}

/// Cost of a recording.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// RMS error of each channel, in thresholds.
    pub channels: Channels<f64>,
    /// The recording's error: 0 is perfect, 1 is a platform at rest.
    pub error: f64,
    /// Shape, size and inverted time of surge and sway.
    pub shape: Shape,
    /// Fraction of the steps in which a safety unit or the actuator guard was active or the
    /// reserve of stroke was touched.
    pub violated: f64,
    /// Shake, jolt and peak of the felt specific force, the largest of the axes \[m/s2\].
    pub comfort: [f64; 3],
    /// Relative amounts by which these exceed their bounds, added. A bound is at least the value
    /// with the parameters that the search starts from.
    pub excess: f64,
}

impl Cost {
    /// True if all constraints were kept throughout.
    pub fn is_feasible(&self) -> bool {
        self.violated == 0.0 && self.excess == 0.0
    }
}

/// Aim of a search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Aim {
    /// Shape of surge and sway, then their size, then the sensed error
    #[default]
    Shape,
    /// The sensed error alone
    Error,
}

impl Aim {
    /// The aim of this name.
    pub fn named(name: &str) -> Option<Aim> {
        match name {
            "shape" => Some(Aim::Shape),
            "error" => Some(Aim::Error),
            _ => None,
        }
    }
}

/// A recording that parameters are judged on.
#[derive(Clone, Debug)]
pub struct Objective {
    recording: Recording,
    desired: Channels<Vec<f64>>,
    /// RMS of each channel as it is desired, in thresholds.
    desired_rms: Channels<f64>,
    weights: Channels<f64>,
    aim: Aim,
    /// The desired force of surge and sway, for its comparison with a felt one.
    cue: Desired,
    /// Every actuator stays this far from either end of its stroke \[m\].
    stroke_reserve: f64,
    /// The fixed parameters, with the recording's step as internal step, at most [`LONGEST_STEP`].
    fixed: Parameters,
    /// Washouts at rest, indexed by the orders of splitter and angular channel less 2. Washouts are
    /// kept, because constructing a washout surveys its rig; apart, because objectives are moved.
    coarse: [[OnceLock<Box<Washout>>; 3]; 3],
    /// The parameters that the search starts from.
    start: Parameters,
    /// Bounds of shake, jolt and peak \[m/s2\].
    comfort_bounds: [f64; 3],
    /// Shake, jolt and peak with the start's parameters, in the search's long steps and in those
    /// that the parameters will be used with.
    start_comfort: [OnceLock<[f64; 3]>; 2],
    /// The desired force in the same steps, with what its comparison with a felt one needs: it is
    /// the same for all parameters.
    references: [OnceLock<References>; 2],
}

/// The desired force on the three axes.
#[derive(Clone, Debug)]
struct References {
    /// Samples of the felt force to one of the recording.
    divisions: usize,
    axes: [Reference; 3],
}

/// Default bounds of shake, jolt and peak \[m/s2\].
pub const COMFORT_BOUNDS: [f64; 3] = [0.2, 4.0, 4.0];

/// Internal steps of a simulation.
#[derive(Clone, Copy)]
enum Steps {
    /// The search's long ones.
    Coarse,
    /// The steps that the parameters will be used with.
    Full,
}

/// Longest internal step in the search \[s\], unless the parameters have a longer one. The filters
/// are exact for any step, but the limits act more coarsely. So the result is simulated again with
/// the internal step that it will be used with.
const LONGEST_STEP: f64 = 0.02;

/// Fraction of the acceleration limits that the search's long steps may use. The rest allows for
/// the variation of acceleration within a step.
const TUNED_ACCELERATION_FRACTION: f64 = 0.85;

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
        let start = *parameters;
        let mut parameters = recording.parameters(parameters);
        let desired = desired_channels(&recording, &parameters);
        parameters.structure.max_step = recording.step().min(LONGEST_STEP).max(parameters.structure.max_step);
        parameters.rig.acceleration_limit *= TUNED_ACCELERATION_FRACTION;
        let desired_rms = std::array::from_fn(|k| sensed_rms(k, &desired[k], recording.step()));
        let force: Vec<[f64; 3]> = recording.inputs().iter().map(|input| input.specific_force.into()).collect();
        let objective = Objective {
            cue: Desired::new(&force, recording.step()),
            recording,
            desired,
            desired_rms,
            weights: *weights,
            aim: Aim::default(),
            stroke_reserve,
            fixed: parameters,
            coarse: Default::default(),
            start,
            comfort_bounds: COMFORT_BOUNDS,
            start_comfort: Default::default(),
            references: Default::default(),
        };
        objective.coarse(&parameters)?;
        Ok(objective)
    }

    /// The objective with these bounds of shake, jolt and peak in place of [`COMFORT_BOUNDS`]
    /// \[m/s2\]. All are positive; an infinite one bounds nothing.
    pub fn with_comfort_bounds(self, comfort_bounds: [f64; 3]) -> Self {
        Objective { comfort_bounds, ..self }
    }

    /// The objective with another aim than the shape.
    pub fn with_aim(self, aim: Aim) -> Self {
        Objective { aim, ..self }
    }

    /// The parameters that the search starts from.
    pub fn start(&self) -> &Parameters {
        &self.start
    }

    /// The recording's name.
    pub fn name(&self) -> &str {
        &self.recording.name
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
        let (errors, felt) = self.coarse_run(parameters)?;
        self.judged(&errors, &felt, Steps::Coarse, || Ok(self.coarse_run(&self.start)?.1))
    }

    /// The errors, and the felt specific force after each of the search's long steps.
    fn coarse_run(&self, parameters: &Parameters) -> Result<(Errors<'_>, Vec<Vector3<f64>>), ParameterError> {
        let mut washout = self.coarse(parameters)?.clone();
        let mut parameters = self.recording.parameters(parameters);
        let Parameters { structure, rig, .. } = washout.parameters();
        (parameters.structure, parameters.rig) = (*structure, *rig);
        parameters.safety.acceleration_limit *= TUNED_ACCELERATION_FRACTION;
        washout.retune(&parameters)?;
        let mut washout = washout.starting_with(&self.recording.inputs()[0]);
        let mut errors = Errors::new(self);
        errors.add(&washout.output());
        let mut felt = vec![washout.output().felt_specific_force];
        let feel = |force: &Vector3<f64>| felt.push(*force);
        let replay = self.recording.replay();
        replay.run_part(0..usize::MAX, &mut washout, |_, _| (), feel, |_, output| errors.add(output));
        Ok((errors, felt))
    }

    /// A washout at rest with the fixed parameters and the orders of these.
    fn coarse(&self, parameters: &Parameters) -> Result<&Washout, ParameterError> {
        let orders = orders(parameters);
        let [splitter, angular] = orders.map(|order| order.clamp(2, 4) as usize - 2);
        let place = &self.coarse[splitter][angular];
        if let Some(washout) = place.get() {
            return Ok(washout);
        }
        let washout = Box::new(Washout::new(&with_orders(&self.fixed, orders))?);
        Ok(place.get_or_init(|| washout))
    }

    /// Cost of a simulation.
    ///
    /// # Errors
    /// The parameters that the search starts from cannot be used.
    pub fn cost(&self, simulation: &Simulation) -> Result<Cost, ParameterError> {
        let mut errors = Errors::new(self);
        simulation.outputs.iter().for_each(|output| errors.add(output));
        let start = || {
            let parameters = self.recording.parameters(&self.start);
            Ok(Simulation::of(&self.recording.replay(), &parameters, || ())?.felt_within_steps)
        };
        self.judged(&errors, &simulation.felt_within_steps, Steps::Full, start)
    }

    /// The cost of these errors and of a felt specific force. `start` simulates that with the
    /// start's parameters.
    fn judged(
        &self,
        errors: &Errors,
        felt: &[Vector3<f64>],
        steps: Steps,
        start: impl FnOnce() -> Result<Vec<Vector3<f64>>, ParameterError>,
    ) -> Result<Cost, ParameterError> {
        let comfort = self.comfort(felt, steps);
        let channels = std::array::from_fn(|k| sensed_rms(k, &errors.channels[k], self.recording.step()));
        // If the desired motion is below a threshold, its error is not magnified.
        let whole = self.weighted(&self.desired_rms).max(1.0);
        let sensed = self.weighted(&channels) / whole;
        let scale = &self.start.conditioning.force_scale;
        let shape = self.cue.shape(&errors.felt, [scale.x, scale.y]);
        Ok(Cost {
            channels,
            error: self.error(&shape, sensed),
            shape,
            violated: errors.violated as f64 / errors.channels[0].len() as f64,
            comfort,
            excess: self.excess(&comfort, steps, start)?,
        })
    }

    /// The error of a recording with this shape and this sensed error.
    fn error(&self, shape: &Shape, sensed: f64) -> f64 {
        // Weights of what is felt wrong, of what is felt too small, and of the sensed error; 1
        // together.
        const WEIGHTS_OF_SHAPE: [f64; 3] = [0.5, 0.25, 0.25];
        // Weight of the inverted fraction of the time beside the shape.
        const WEIGHT_OF_INVERTED: f64 = 2.0;
        let axes = || (0..2).filter_map(|k| Some((self.weights[k], shape.axes[k]?))).filter(|axis| axis.0 > 0.0);
        let whole: f64 = axes().map(|(weight, _)| weight).sum();
        if self.aim == Aim::Error || whole == 0.0 {
            return sensed;
        }
        let mean = |of: fn(&AxisShape) -> f64| axes().map(|(weight, axis)| weight * of(&axis)).sum::<f64>() / whole;
        let wrong = mean(|axis| 1.0 - axis.shape + WEIGHT_OF_INVERTED * axis.inverted);
        let small = 1.0 - mean(|axis| axis.size.min(1.0 / axis.size).ln()).exp();
        let parts = [wrong, small, sensed];
        parts.iter().zip(WEIGHTS_OF_SHAPE).map(|(part, weight)| weight * part).sum()
    }

    /// Shake, jolt and peak of a felt specific force, the largest of the axes.
    fn comfort(&self, felt: &[Vector3<f64>], steps: Steps) -> [f64; 3] {
        let divisions = divisions(self.desired[0].len(), felt.len());
        let kept = self.references[steps as usize].get_or_init(|| self.references(divisions));
        // Parameters with other internal steps have references of their own.
        let own = (kept.divisions != divisions).then(|| self.references(divisions));
        let References { axes, .. } = own.as_ref().unwrap_or(kept);
        let of_axis = |k: usize| axes[k].comfort(felt.iter().map(|felt| (felt - force_at_rest())[k])).values();
        let axes: [[f64; 3]; 3] = std::array::from_fn(of_axis);
        std::array::from_fn(|k| axes.iter().map(|values| values[k]).fold(0.0, f64::max))
    }

    /// The desired force for so many samples of the felt one to one of the recording.
    fn references(&self, divisions: usize) -> References {
        let axis = |k: usize| Reference::new(&self.desired[k], divisions, 0.0, self.recording.step());
        References { divisions, axes: std::array::from_fn(axis) }
    }

    /// Relative amounts, added, by which shake, jolt and peak exceed both their bounds and those of
    /// the start in the same steps. `start` simulates the latter's felt force, once.
    fn excess(
        &self,
        values: &[f64; 3],
        steps: Steps,
        start: impl FnOnce() -> Result<Vec<Vector3<f64>>, ParameterError>,
    ) -> Result<f64, ParameterError> {
        let beyond = |bounds: &[f64; 3]| values.iter().zip(bounds).any(|(value, bound)| value > bound);
        if !beyond(&self.comfort_bounds) {
            return Ok(0.0);
        }
        let place = &self.start_comfort[steps as usize];
        let start = match place.get() {
            Some(start) => start,
            None => {
                let start = self.comfort(&start()?, steps);
                place.get_or_init(|| start)
            }
        };
        let bounds = self.comfort_bounds.iter().zip(start).map(|(bound, start)| bound.max(*start));
        Ok(values.iter().zip(bounds).map(|(value, bound)| (value / bound - 1.0).max(0.0)).sum())
    }
}

/// Errors of a simulation, added output by output.
struct Errors<'a> {
    objective: &'a Objective,
    channels: Channels<Vec<f64>>,
    /// The felt specific force.
    felt: Vec<[f64; 3]>,
    /// Number of outputs with limits active or the reserve of stroke touched.
    violated: usize,
}

impl<'a> Errors<'a> {
    fn new(objective: &'a Objective) -> Self {
        let samples = objective.desired[0].len();
        let channels = std::array::from_fn(|_| Vec::with_capacity(samples));
        Errors { objective, channels, felt: Vec::with_capacity(samples), violated: 0 }
    }

    fn add(&mut self, output: &Output) {
        let sample = self.channels[0].len();
        let force = output.felt_specific_force - force_at_rest();
        for (k, felt) in channel_values(force, output.felt_angular_velocity).into_iter().enumerate() {
            self.channels[k].push(felt - self.objective.desired[k][sample]);
        }
        self.felt.push(output.felt_specific_force.into());
        let touched = output.stroke_margin < self.objective.stroke_reserve;
        self.violated += usize::from(output.safety_active || output.actuator_limited || touched);
    }
}

/// The desired channels, as deviations from rest.
fn desired_channels(recording: &Recording, parameters: &Parameters) -> Channels<Vec<f64>> {
    let simulation = Simulation::without_outputs(&recording.manoeuvre, parameters);
    let rates = simulation.desired_rates();
    let samples = simulation
        .inputs
        .iter()
        .zip(rates)
        .map(|(input, rate)| channel_values(input.specific_force - force_at_rest(), rate));
    let samples: Vec<Channels<f64>> = samples.collect();
    std::array::from_fn(|k| samples.iter().map(|sample| sample[k]).collect())
}

/// The specific force at rest.
fn force_at_rest() -> Vector3<f64> {
    Vector3::new(0.0, 0.0, STANDARD_GRAVITY)
}

fn channel_values(force: Vector3<f64>, rate: Vector3<f64>) -> Channels<f64> {
    [force.x, force.y, force.z, rate.x, rate.y, rate.z]
}

/// RMS of the sensed signal of channel `k`, in thresholds. `signal` is the deviation from rest.
fn sensed_rms(k: usize, signal: &[f64], step: f64) -> f64 {
    let (organ, threshold) = if k < 3 { (&OTOLITHS, FORCE_THRESHOLDS[k]) } else { (&CANALS, RATE_THRESHOLDS[k - 3]) };
    let sensed = sensed(organ, signal, 0.0, step);
    rms(sensed.iter().copied()) / threshold
}
