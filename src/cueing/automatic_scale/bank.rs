//! The bank of shadows: what the platform would feel at fixed scales, and the largest scale at
//! which that has the right shape.

use core::f64::consts::{FRAC_1_SQRT_2, PI};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::ahead::{Tracker, is_known, reference_points};
use super::platform::{Platform, REGULATOR_WEIGHTS};
use crate::cueing::conditioning::soft_limit;
use crate::cueing::strategy::coordinated::models;
use crate::cueing::strategy::optimal::weighed;
use crate::cueing::strategy::predictive::preview::{PreviewedCue, TIME_ROUNDING};
use crate::cueing::strategy::regulator::{AxisModel, Gains, Regulator, State};
use crate::cueing::strategy::{Unsolvable, at_rest_if_tiny};
use crate::interface::Parameters;
use crate::motion::min_max::{max, min};

/// Number of shadows.
const SHADOW_COUNT: usize = 13;
/// Scale of a shadow relative to that of the one before; the first has 1, the last 0.03.
const SHADOW_SCALE_RATIO: f64 = 0.746_6;
/// Time between two samples of the bank \[s\].
const SAMPLE_TIME: f64 = 0.02;
/// Frequency below which forces are compared \[Hz\], as in the measure of shape.
const CUE_FREQUENCY: f64 = 2.0;
/// Largest force that is compared \[m/s2\]: a spike does not rule the memory for minutes.
const LARGEST_FORCE: f64 = 40.0;
/// Mean square that is added to a reference's \[m2/s4\]: rest counts as no error.
const MEAN_SQUARE_FLOOR: f64 = 0.1;
/// Weight of what is felt the wrong way round, beside that of any error.
const WRONG_WAY_WEIGHT: f64 = 0.54;
/// Fraction of the mean square of the references at which the factor may rise at its full rate. In
/// a pause nothing shows that more would fit.
const ACTIVE_FRACTION: f64 = 0.5;
/// Memory at the ride's start \[s\]; it grows with the ride.
const FIRST_MEMORY: f64 = 1.65;

/// The shadows, and their shape errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bank {
    models: [AxisModel; 2],
    gains: [Gains; 2],
    trackers: [Tracker; 2],
    /// Courses of the references that are previewed, at a factor of 1 without a limit.
    courses: [PreviewedCue; 2],
    shadows: [[Shadow; 2]; SHADOW_COUNT],
    /// The references below [`CUE_FREQUENCY`].
    desired: [LowPass; 2],
    /// Means of their squares \[m2/s4\].
    power: [f64; 2],
    /// Integral of the references since the last sample \[m/s\], and the time.
    sum: [f64; 2],
    since: f64,
    /// Time over which the bank remembers \[s\].
    memory: f64,
}

/// The outcome of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// The largest scale at which the worse axis has the shape error that is allowed.
    pub scale: f64,
    /// 0 in a pause, 1 while the references are as large as usual.
    pub activity: f64,
}

/// One axis at one scale.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Shadow {
    platform: Platform,
    felt: LowPass,
    /// Mean square of the felt force less the scaled reference \[m2/s4\].
    error: f64,
}

impl Bank {
    /// At rest.
    ///
    /// # Errors
    /// There is no regulator for the platform's limits.
    pub fn new(parameters: &Parameters) -> Result<Self, Unsolvable> {
        let models = models(parameters);
        Ok(Bank {
            models,
            gains: regulator_gains(&models)?,
            trackers: new_trackers(&models)?,
            courses: [PreviewedCue::default(); 2],
            shadows: [[Shadow::default(); 2]; SHADOW_COUNT],
            desired: [LowPass::default(); 2],
            power: [0.0; 2],
            sum: [0.0; 2],
            since: 0.0,
            memory: FIRST_MEMORY,
        })
    }

    /// Takes the platform's limits from other parameters.
    ///
    /// # Errors
    /// There is no regulator for them. Nothing has changed then.
    pub fn retune(&mut self, parameters: &Parameters) -> Result<(), Unsolvable> {
        let models = models(parameters);
        if models != self.models {
            (self.gains, self.trackers) = (regulator_gains(&models)?, new_trackers(&models)?);
            self.models = models;
        }
        Ok(())
    }

    /// Sets the courses that the references will take.
    pub fn preview(&mut self, courses: &[PreviewedCue; 2]) {
        self.courses = *courses;
    }

    /// Delays courses that have just been given by `lag` seconds.
    pub fn delay_preview(&mut self, lag: f64) {
        self.courses.iter_mut().for_each(|course| course.delay(lag));
    }

    /// Advances by `step` seconds, at whose end the references are these. Returns the goal, with
    /// each sample.
    pub fn advance(
        &mut self,
        references: [f64; 2],
        force_limit: &Vector3<f64>,
        largest_error: f64,
        memory: f64,
        step: f64,
    ) -> Option<Goal> {
        self.courses.iter_mut().filter(|course| course.count > 0).for_each(|course| course.advance(step));
        for (sum, reference) in self.sum.iter_mut().zip(references) {
            *sum += reference.clamp(-LARGEST_FORCE, LARGEST_FORCE) * step;
        }
        self.since += step;
        if self.since < SAMPLE_TIME - TIME_ROUNDING {
            return None;
        }
        let references = self.sum.map(|sum| at_rest_if_tiny(sum / self.since));
        let desired = self.sample(references, force_limit, memory);
        (self.sum, self.since) = ([0.0; 2], 0.0);
        let usual = ACTIVE_FRACTION * (self.power[0] + self.power[1]);
        let activity = min(
            (desired[0] * desired[0] + desired[1] * desired[1]) / (usual + ACTIVE_FRACTION * MEAN_SQUARE_FLOOR),
            1.0,
        );
        Some(Goal { scale: self.fitting(largest_error), activity })
    }

    /// Moves all shadows under these references since the last sample. Returns the references below
    /// [`CUE_FREQUENCY`].
    fn sample(&mut self, references: [f64; 2], force_limit: &Vector3<f64>, memory: f64) -> [f64; 2] {
        let step = self.since;
        self.memory = min(self.memory + step, memory);
        let share = 1.0 - libm::exp(-step / self.memory);
        let filter = Coefficients::new(step);
        let is_previewed = is_known(&self.courses);
        [0, 1].map(|axis: usize| {
            let reference = references[axis];
            let desired = self.desired[axis].advance(reference, &filter);
            self.power[axis] = at_rest_if_tiny(self.power[axis] + share * (desired * desired - self.power[axis]));
            let (model, gains, tracker) = (&self.models[axis], &self.gains[axis], &self.trackers[axis]);
            let forward =
                is_previewed.then(|| tracker.forward(&reference_points(reference, &self.courses[axis], LARGEST_FORCE)));
            let mut scale = 1.0;
            for shadows in &mut self.shadows {
                let Shadow { platform, felt, error } = &mut shadows[axis];
                let cued = soft_limit(scale * reference, force_limit[axis]);
                let law = |state: &State| match forward {
                    None => (-(gains * state)).into(),
                    Some(forward) => tracker.control(&state.fixed_rows::<4>(0).into(), forward, scale),
                };
                let felt = felt.advance(platform.advance(model, &law, cued, step), &filter);
                let wrong_way = if felt * desired < 0.0 { WRONG_WAY_WEIGHT * felt * felt } else { 0.0 };
                let missed = felt - scale * desired;
                *error = at_rest_if_tiny(*error + share * (missed * missed + wrong_way - *error));
                scale *= SHADOW_SCALE_RATIO;
            }
            desired
        })
    }

    /// The largest scale at which the worse axis has at most this shape error, between the shadows'
    /// scales. The least of theirs if there is none.
    fn fitting(&self, largest_error: f64) -> f64 {
        let allowed = largest_error * largest_error;
        let (mut scale, mut before) = (1.0, None);
        for shadows in &self.shadows {
            let error = self.relative_error(shadows, scale);
            if error <= allowed {
                let Some(larger) = before else { return scale };
                // Linear in the logarithms, between this scale and the one before.
                let part = libm::log(allowed / error) / libm::log(larger / error);
                return scale * libm::pow(SHADOW_SCALE_RATIO, -part);
            }
            before = Some(error);
            scale *= SHADOW_SCALE_RATIO;
        }
        scale / SHADOW_SCALE_RATIO
    }

    /// The square of the worse axis's shape error at a scale.
    fn relative_error(&self, shadows: &[Shadow; 2], scale: f64) -> f64 {
        let of = |axis: usize| shadows[axis].error / (scale * scale * (self.power[axis] + MEAN_SQUARE_FLOOR));
        max(of(0), of(1))
    }
}

/// The regulators' gains for surge and sway.
fn regulator_gains(models: &[AxisModel; 2]) -> Result<[Gains; 2], Unsolvable> {
    let gains =
        |axis: usize| Regulator::new(&weighed(&models[axis]), &REGULATOR_WEIGHTS).map(|regulator| regulator.gains);
    Ok([gains(0)?, gains(1)?])
}

/// The trackers for surge and sway.
fn new_trackers(models: &[AxisModel; 2]) -> Result<[Tracker; 2], Unsolvable> {
    let tracker = |axis: usize| Tracker::new(&weighed(&models[axis]));
    Ok([tracker(0)?, tracker(1)?])
}

/// A second-order Butterworth low-pass at [`CUE_FREQUENCY`], by the bilinear transform.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct LowPass {
    states: [f64; 2],
}

/// Coefficients of [`LowPass`] for one step.
struct Coefficients {
    gain: f64,
    first: f64,
    second: f64,
}

impl Coefficients {
    fn new(step: f64) -> Self {
        let k = libm::tan(PI * CUE_FREQUENCY * step);
        let damping = 2.0 * k * FRAC_1_SQRT_2;
        let gain = 1.0 / (1.0 + damping + k * k);
        Coefficients { gain: gain * k * k, first: 2.0 * gain * (k * k - 1.0), second: gain * (1.0 - damping + k * k) }
    }
}

impl LowPass {
    fn advance(&mut self, value: f64, coefficients: &Coefficients) -> f64 {
        let Coefficients { gain, first, second } = *coefficients;
        let [one, two] = self.states;
        let input = gain * value;
        let output = input + one;
        self.states = [two + 2.0 * input - first * output, input - second * output].map(at_rest_if_tiny);
        output
    }
}
