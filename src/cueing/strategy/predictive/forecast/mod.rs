//! The forecast of one axis's reference over the horizon, learned while it is followed.
//!
//! Four experts forecast the reference's mean over each block, and its slow and fast part at the
//! horizon's end. Three are fixed, and linear in the reference and low-passes of it. The fourth is
//! the least-squares fit to what followed these and the angular velocity in the past. The fit
//! forgets, and falls back on a prior (direct multi-step: one regression for each target). The
//! forecast is a mixture of the four, weighted by their latest errors.
//!
//! Only the past enters: a target is used once the time that was forecast is over. So the fits of
//! near blocks learn what has just happened.
//!
//! Where the reference is [previewed](super::preview), the preview replaces the mixture. After the
//! preview's end, the mixture as of that time follows. Preview and mixture are weighted by their
//! latest errors, as the experts are, so that a wrong preview loses its weight.

mod regression;
#[cfg(test)]
mod tests;

use alloc::{vec, vec::Vec};

use nalgebra::{SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

use super::expected::{DECAY_RATES, Forecast};
use super::horizon::{BLOCK_SAMPLES, BLOCKS, FORECAST_SAMPLES, FORECAST_TIME, Horizon, PLAN_INTERVAL, end_samples};
use super::preview::{Ahead, PreviewedCue, PreviewedCues, PreviewedReference};
use crate::cueing::strategy::at_rest_if_tiny;
use crate::interface::ForecastKind;
use regression::{Covariance, FEATURES, FORCES, Features, Regression};

/// Time constants of the reference's low-passes \[s\]: the five that the fit uses, and two for
/// [`SLOW_LOW_PASS`] and [`QUICK_LOW_PASS`].
const TIME_CONSTANTS: [f64; LOW_PASSES] = [0.03, 0.1, 0.3, 1.0, 3.0, 0.6, 0.06];
const LOW_PASSES: usize = 7;
/// The low-pass that stands for the slow part of the reference.
const SLOW_LOW_PASS: usize = 5;
/// The one of the fit's low-passes that stands for it in the prior.
const FIT_SLOW: usize = 3;
/// The low-pass that leaves out vibration alone.
const QUICK_LOW_PASS: usize = 6;
/// The two low-passes for a trend.
const TREND_LOW_PASSES: [usize; 2] = [1, 2];
/// Number of targets of a forecast: the means over the blocks, and the slow and the fast part
/// at the horizon's end.
const TARGETS: usize = BLOCKS + 2;
const EXPERTS: usize = 4;
/// Variance of each angular velocity in the prior \[(rad/s)^2\].
const RATE_VARIANCE: f64 = 0.1;

/// Samples that are remembered: the horizon's and the present one.
const REMEMBERED_SAMPLES: usize = FORECAST_SAMPLES + 1;

/// Decay of the expert that holds the reference \[1/s\].
const HOLD_DECAY_RATE: f64 = 0.02;
/// Time constant with which a trend fades \[s\].
const TREND_TIME: f64 = 1.5;
/// The prior of a target's fit has the weight of samples over this fraction of the time to the
/// target's end.
const PRIOR_FRACTION: f64 = 0.1;
/// Ridge of the prior \[(m/s2)^2\].
const PRIOR_RIDGE: f64 = 3e-3;
/// Poles \[rad/s\] and variances \[(m/s2)^2\] of the prior's reference: a sum of
/// Ornstein-Uhlenbeck processes.
const PRIOR: [(f64, f64); 3] = [(0.1, 0.5), (1.0, 0.3), (6.0, 0.2)];
/// The least squared error that an expert is taken to have \[(m/s2)^2\].
const LEAST_ERROR: f64 = 1e-4;
/// Squared error added to that of a forecast without preview \[(m/s2)^2\]. While nothing happens,
/// neither the forecast nor the preview errs, but only the preview contains what comes.
const FORECAST_FLOOR: f64 = 0.005;
/// Squared error of a preview before any is known \[(m/s2)^2\].
const UNPROVED_PREVIEW_ERROR: f64 = 0.002;
/// Time constants with which the squared errors beside a preview follow larger
/// and smaller ones \[s\].
const PREVIEW_MEMORY: [f64; 2] = [1.5, 10.0];
/// A preview has the same weight as the forecast without it where its squared errors are smaller by
/// this factor. [`FORECAST_FLOOR`] is included in the forecast's errors.
const UNCERTAINTY_FACTOR: f64 = 1.6;
/// The first block that is longer than the usual time between the elements of a preview.
const FIRST_LONG_BLOCK: usize = 4;
/// Samples from one fit of a target to the next.
const FIT_EVERY: usize = 5;

type Targets = SVector<f64, TARGETS>;
/// A forecast that is linear in the features.
type Linear = SMatrix<f64, TARGETS, FEATURES>;

/// Forgetting time of the forecaster \[s\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Memory {
    /// Of the fit.
    pub fit: f64,
    /// Of the experts' errors.
    pub selection: f64,
}

/// The forecaster of one axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Forecaster {
    value: f64,
    low_passes: SVector<f64, LOW_PASSES>,
    /// Integral of the reference \[m/s\].
    integral: f64,
    /// The step that the low-passes' decays are for \[s\].
    step: f64,
    decays: SVector<f64, LOW_PASSES>,
    /// A ring of [`REMEMBERED_SAMPLES`] samples, the latest at `latest`.
    samples: Vec<StoredSample>,
    latest: u32,
    /// The fit of each target.
    fits: [Regression; TARGETS],
    fitted: Linear,
    /// The targets that are fitted at a sample: one of [`FIT_EVERY`] parts of them.
    turn: usize,
    /// The next target that the latest sample has to be added to, and the part of its fit that it
    /// keeps.
    unlearned: usize,
    fit_forgetting_factor: f64,
    /// Mean squared error of each expert on each target.
    errors: SMatrix<f64, EXPERTS, TARGETS>,
    /// The forecast without the preview.
    forecast: Forecast,
    courses: PreviewedCues,
    /// The part of the reference that is the angular channel's \[m/s2\].
    angular_part: f64,
    /// Angular velocity that the angular channel cues \[rad/s\].
    rates: Vector3<f64>,
    /// Mean squared errors of the means forecast without the preview and by it.
    preview_errors: [SVector<f64, BLOCKS>; 2],
}

/// Stored data of an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct StoredSample {
    value: f64,
    rates: Vector3<f64>,
    low_passes: SVector<f64, LOW_PASSES>,
    integral: f64,
    /// The fit's forecast.
    fitted: Targets,
    /// The means that were forecast without the preview and by it, if there was one.
    expected: Option<[SVector<f64, BLOCKS>; 2]>,
}

impl StoredSample {
    fn features(&self) -> Features {
        let (low, rates) = (&self.low_passes, &self.rates);
        Features::from([self.value, low[0], low[1], low[2], low[3], low[4], rates.x, rates.y, rates.z])
    }

    /// The slow and the fast part of the reference, and its slope.
    fn parts(&self) -> [f64; 3] {
        let slow = self.low_passes[SLOW_LOW_PASS];
        let [quick, lagging] = TREND_LOW_PASSES.map(|k| self.low_passes[k]);
        let slope = (quick - lagging) / (TIME_CONSTANTS[TREND_LOW_PASSES[1]] - TIME_CONSTANTS[TREND_LOW_PASSES[0]]);
        [slow, self.value - slow, slope]
    }
}

/// Constants of every forecaster.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tables {
    /// Targets of the fixed experts for a slow and a fast part of 1, and for a slope of 1.
    hold: [Targets; 2],
    decay: [Targets; 2],
    trend: Targets,
    /// Prior of each target's recursive least-squares fit; old data decay towards it.
    priors: [Regression; TARGETS],
    /// Fractions of the squared errors beside a preview that are kept over a sample, while they
    /// rise and while they fall.
    preview_forgetting_factors: [f64; 2],
}

impl Tables {
    /// Forecasts of a target by the fixed experts, for these [parts](StoredSample::parts): hold,
    /// trend, fade.
    fn fixed_forecasts(&self, [slow, fast, slope]: [f64; 3], target: usize) -> [f64; EXPERTS - 1] {
        let hold = slow * self.hold[0][target] + fast * self.hold[1][target];
        let decay = slow * self.decay[0][target] + fast * self.decay[1][target];
        [hold, hold + slope * self.trend[target], decay]
    }
}

impl Default for Tables {
    fn default() -> Self {
        let [slow, fast] = DECAY_RATES;
        let decay = [exponential(slow, true), exponential(fast, false)];
        let (covariance, linear) = (prior_covariance() + PRIOR_RIDGE * Covariance::identity(), from_features(&decay));
        Tables {
            hold: [exponential(HOLD_DECAY_RATE, true), exponential(HOLD_DECAY_RATE, false)],
            decay,
            trend: trend(),
            priors: core::array::from_fn(|target| {
                let samples = PRIOR_FRACTION * samples_to_end(target) as f64;
                Regression::new(samples * covariance, &linear.row(target).transpose())
            }),
            preview_forgetting_factors: PREVIEW_MEMORY.map(|time| libm::exp(-PLAN_INTERVAL / time)),
        }
    }
}

/// Number of samples from now to a target's end.
fn samples_to_end(target: usize) -> usize {
    end_samples()[target.min(BLOCKS - 1)]
}

/// Means over the blocks of a part that decays from 1, and the part at the end: the
/// slow one or the fast one.
fn exponential(decay: f64, slow: bool) -> Targets {
    let (ends, durations) = (Horizon::Near.ends(), Horizon::Near.durations());
    let end = libm::exp(-decay * FORECAST_TIME);
    let (slow_end, fast_end) = if slow { (end, 0.0) } else { (0.0, end) };
    Targets::from_fn(|k, _| match k {
        BLOCKS => slow_end,
        k if k > BLOCKS => fast_end,
        _ => {
            let start = ends[k] - durations[k];
            (libm::exp(-decay * start) - libm::exp(-decay * ends[k])) / (decay * durations[k])
        }
    })
}

/// Contribution of a slope of 1 by the middle of each block, and by the horizon's end. There, half
/// of it goes to either part.
fn trend() -> Targets {
    let grown = |time: f64| TREND_TIME * (1.0 - libm::exp(-time / TREND_TIME));
    let (ends, durations) = (Horizon::Near.ends(), Horizon::Near.durations());
    Targets::from_fn(|k, _| if k < BLOCKS { grown(ends[k] - 0.5 * durations[k]) } else { 0.5 * grown(FORECAST_TIME) })
}

/// Forecast of a slow and a fast part of 1, as a function of the features.
fn from_features([slow, fast]: &[Targets; 2]) -> Linear {
    let mut linear = Linear::zeros();
    linear.set_column(0, fast);
    linear.set_column(1 + FIT_SLOW, &(slow - fast));
    linear
}

/// Covariance of the features for the prior's reference.
fn prior_covariance() -> Covariance {
    // The reference itself is a low-pass without lag.
    let pole = |feature: usize| if feature == 0 { f64::INFINITY } else { 1.0 / TIME_CONSTANTS[feature - 1] };
    Covariance::from_fn(|i, j| {
        if i.max(j) >= FORCES {
            return if i == j { RATE_VARIANCE } else { 0.0 };
        }
        let (a, b) = (pole(i), pole(j));
        PRIOR.iter().fold(0.0, |sum, &(s, variance)| {
            sum + variance
                * match (a.is_finite(), b.is_finite()) {
                    (false, false) => 1.0,
                    (false, true) => b / (b + s),
                    (true, false) => a / (a + s),
                    (true, true) => a * b / (a + b) * (1.0 / (a + s) + 1.0 / (b + s)),
                }
        })
    })
}

impl Forecaster {
    /// Before the first step, with a reference of zero.
    pub fn new(tables: &Tables) -> Self {
        Forecaster {
            value: 0.0,
            low_passes: SVector::zeros(),
            integral: 0.0,
            step: 0.0,
            decays: SVector::zeros(),
            samples: vec![StoredSample::default(); REMEMBERED_SAMPLES],
            latest: 0,
            fits: tables.priors,
            fitted: from_features(&tables.decay),
            turn: 0,
            unlearned: TARGETS,
            fit_forgetting_factor: 0.0,
            errors: SMatrix::repeat(LEAST_ERROR),
            forecast: Forecast::default(),
            courses: PreviewedCues::default(),
            angular_part: 0.0,
            rates: Vector3::zeros(),
            preview_errors: [LEAST_ERROR, UNPROVED_PREVIEW_ERROR].map(SVector::repeat),
        }
    }

    /// Advances by `step` seconds in which the reference is `value` \[m/s2\].
    pub fn advance(&mut self, value: f64, step: f64) {
        if step != self.step {
            self.step = step;
            self.decays = SVector::from(TIME_CONSTANTS).map(|time| 1.0 - libm::exp(-step / time));
        }
        self.value = value;
        self.courses.advance(step);
        self.low_passes += self.decays.component_mul(&self.low_passes.map(|low| value - low));
        self.low_passes.apply(|low| *low = at_rest_if_tiny(*low));
        self.integral += value * step;
    }

    /// Sets the course that the cue will take. A course without values removes it.
    pub fn preview(&mut self, course: &PreviewedCue) {
        self.courses.give(course);
    }

    /// Delays a preview that has just been given by `lag` seconds.
    pub fn delay_preview(&mut self, lag: f64) {
        self.courses.delay(lag);
    }

    /// Time to the end of the preview \[s\].
    pub fn preview_length(&self) -> f64 {
        self.courses.length()
    }

    /// The part of the reference that is the angular channel's \[m/s2\], and the angular velocity
    /// that it cues \[rad/s\].
    pub fn set_angular(&mut self, angular_part: f64, rates: &Vector3<f64>) {
        self.angular_part = angular_part;
        self.rates = *rates;
    }

    /// The forecast over the blocks of a horizon, by the preview where there is one.
    pub fn over(&self, horizon: Horizon, tables: &Tables, kind: ForecastKind) -> Forecast {
        let learned = if horizon == Horizon::Near { self.forecast } else { self.forecast.over(horizon) };
        match self.preview_over(horizon, tables, kind) {
            Some(previewed) => learned.towards(&previewed, &self.trust(horizon)),
            None => learned,
        }
    }

    /// The forecast by the preview alone, if there is one.
    fn preview_over(&self, horizon: Horizon, tables: &Tables, kind: ForecastKind) -> Option<Forecast> {
        // Most steps have no preview: they need no room for it.
        if self.preview_length() == 0.0 {
            return None;
        }
        self.previewed_reference(&mut Ahead::default(), tables, kind).map(|previewed| previewed.over(horizon))
    }

    /// The reference by the preview, followed from the preview's end by the
    /// forecast as of that time.
    ///
    /// `ahead` is the room for it, so that the many corners are not moved.
    fn previewed_reference<'a>(
        &self,
        ahead: &'a mut Ahead,
        tables: &Tables,
        kind: ForecastKind,
    ) -> Option<PreviewedReference<'a>> {
        let past = (TIME_CONSTANTS[QUICK_LOW_PASS], self.low_passes[QUICK_LOW_PASS]);
        if !ahead.set(&self.courses, past, self.angular_part) {
            return None;
        }
        let mut end = StoredSample { value: ahead.last(), ..StoredSample::default() };
        // No forecast uses the last one, of vibration alone.
        let [low, times] = [&self.low_passes.data.0[0], &TIME_CONSTANTS].map(|all| core::array::from_fn(|k| all[k]));
        let low: [f64; QUICK_LOW_PASS] = ahead.low_passes(low, times, ahead.length());
        end.low_passes.fixed_rows_mut::<QUICK_LOW_PASS>(0).copy_from_slice(&low);
        let fitted = self.fitted * end.features();
        let after = self.expected(&end, &fitted, tables, kind);
        Some(PreviewedReference {
            ahead,
            after,
            slow: self.low_passes[SLOW_LOW_PASS],
            slow_time: TIME_CONSTANTS[SLOW_LOW_PASS],
        })
    }

    /// The weight of the preview in each block of a horizon, from 0 to 1.
    ///
    /// The weight follows from the ratio of the preview's error to that of the forecast without it,
    /// [`FORECAST_FLOOR`] included. The ratio in a block is the largest of the blocks up to
    /// it, since a preview that is worse for near blocks is not better for later ones. For
    /// later blocks, the first [`FIRST_LONG_BLOCK`] blocks are left out: they are shorter than
    /// what a preview resolves.
    fn trust(&self, horizon: Horizon) -> SVector<f64, BLOCKS> {
        let [learned, previewed] = &self.preview_errors;
        let ratios = previewed.component_div(&learned.add_scalar(FORECAST_FLOOR));
        let own_ends = Horizon::Near.ends();
        let ends = horizon.ends();
        SVector::from_fn(|k, _| {
            let block = own_ends.iter().position(|end| *end >= ends[k]).unwrap_or(BLOCKS - 1);
            let first = block.min(FIRST_LONG_BLOCK);
            let ratio = UNCERTAINTY_FACTOR * ratios.rows(first, block + 1 - first).max();
            1.0 / (1.0 + ratio * ratio * ratio * ratio)
        })
    }

    /// The forecast for a reference that keeps its value until the vehicle stops, and
    /// is zero from then on.
    pub fn until_stop(&self, time: f64, horizon: Horizon) -> Forecast {
        let (ends, durations) = (horizon.ends(), horizon.durations());
        let before = |k: usize| ((time - ends[k] + durations[k]) / durations[k]).clamp(0.0, 1.0);
        let slow = self.low_passes[SLOW_LOW_PASS];
        let end = if time < ends[BLOCKS - 1] { [0.0; 2] } else { [slow, self.value - slow] };
        Forecast { means: SVector::from_fn(|k, _| self.value * before(k)), end }
    }

    /// Updates the errors and the fit with the latest samples, and forecasts anew. To be called
    /// once every [`PLAN_INTERVAL`].
    pub fn sample(&mut self, tables: &Tables, kind: ForecastKind, memory: &Memory) {
        while self.unlearned < TARGETS {
            self.learn_next(tables);
        }
        self.latest = self.latest.wrapping_add(1) % REMEMBERED_SAMPLES as u32;
        let mut now = StoredSample {
            value: self.value,
            rates: self.rates,
            low_passes: self.low_passes,
            integral: self.integral,
            ..StoredSample::default()
        };
        self.remember(&now);
        self.learn(tables, memory);
        now.fitted = self.fitted * now.features();
        self.forecast = self.expected(&now, &now.fitted, tables, kind);
        now.expected =
            self.preview_over(Horizon::Near, tables, kind).map(|previewed| [self.forecast.means, previewed.means]);
        self.remember(&now);
    }

    /// The experts' forecast from an instant on; `fitted` is the fit's forecast.
    fn expected(&self, then: &StoredSample, fitted: &Targets, tables: &Tables, kind: ForecastKind) -> Forecast {
        let parts = then.parts();
        let target = |target: usize| {
            let [hold, trend, decay] = tables.fixed_forecasts(parts, target);
            match kind {
                ForecastKind::Hold => hold,
                ForecastKind::Decay => decay,
                ForecastKind::Learned => self.mixture(target, [hold, trend, decay, fitted[target]]),
            }
        };
        Forecast { means: SVector::from_fn(|block, _| target(block)), end: [target(BLOCKS), target(BLOCKS + 1)] }
    }

    fn remember(&mut self, now: &StoredSample) {
        if let Some(sample) = self.samples.get_mut(self.latest as usize) {
            *sample = *now;
        }
    }

    /// The sample that is `count` samples old.
    fn ago(&self, count: usize) -> Option<&StoredSample> {
        self.samples.get((self.latest as usize + REMEMBERED_SAMPLES - count) % REMEMBERED_SAMPLES)
    }

    /// The sample from whose time on a target has just ended, and the target's value.
    fn ended(&self, target: usize) -> Option<(&StoredSample, f64)> {
        let (then, now) = (self.ago(samples_to_end(target))?, self.ago(0)?);
        let truth = match target {
            BLOCKS => now.low_passes[SLOW_LOW_PASS],
            target if target > BLOCKS => now.value - now.low_passes[SLOW_LOW_PASS],
            block => (now.integral - self.ago(BLOCK_SAMPLES[block])?.integral) / Horizon::Near.durations()[block],
        };
        Some((then, truth))
    }

    /// Updates the errors with the targets whose time has just ended. Fits a part of the targets
    /// anew; the fits of the others learn [in the steps that follow](Forecaster::learn_next).
    fn learn(&mut self, tables: &Tables, memory: &Memory) {
        let [fit_forgetting_factor, error_forgetting_factor] =
            [memory.fit, memory.selection].map(|time| libm::exp(-PLAN_INTERVAL / time));
        for target in 0..TARGETS {
            self.compare(target, tables, error_forgetting_factor);
        }
        (self.unlearned, self.fit_forgetting_factor) = (0, fit_forgetting_factor);
        self.turn = (self.turn + 1) % FIT_EVERY;
        for target in (self.turn..TARGETS).step_by(FIT_EVERY) {
            self.add_to_fit(target, tables);
            if let Some(coefficients) = self.fits[target].coefficients() {
                self.fitted.set_row(target, &coefficients.transpose());
            }
        }
    }

    /// Adds the latest sample to the fit of one more target, if one is left. To be called once a
    /// step, so that no step has all of them.
    pub fn learn_next(&mut self, tables: &Tables) {
        if self.unlearned < TARGETS && self.unlearned % FIT_EVERY == self.turn {
            self.unlearned += 1;
        }
        if self.unlearned < TARGETS {
            self.add_to_fit(self.unlearned, tables);
            self.unlearned += 1;
        }
    }

    /// Adds a target whose time ended at the latest sample to its fit.
    fn add_to_fit(&mut self, target: usize, tables: &Tables) {
        if let Some((then, truth)) = self.ended(target) {
            let features = then.features();
            self.fits[target].add(self.fit_forgetting_factor, &tables.priors[target], &features, truth);
        }
    }

    /// Updates the mean squared errors with those of the forecasts of a target whose time has just
    /// ended. The experts' errors keep the part `forgetting_factor` of what they were.
    fn compare(&mut self, target: usize, tables: &Tables, forgetting_factor: f64) {
        let Some((then, truth)) = self.ended(target) else { return };
        let ([hold, trend, decay], fitted) = (tables.fixed_forecasts(then.parts(), target), then.fitted[target]);
        let expected = then.expected.filter(|_| target < BLOCKS).map(|means| means.map(|means| means[target]));
        for (expert, forecast) in [hold, trend, decay, fitted].into_iter().enumerate() {
            let error = forecast - truth;
            let mean = &mut self.errors[(expert, target)];
            *mean = forgetting_factor * *mean + (1.0 - forgetting_factor) * (LEAST_ERROR + error * error);
        }
        if let Some(expected) = expected {
            let [rising, falling] = tables.preview_forgetting_factors;
            for (errors, mean) in self.preview_errors.iter_mut().zip(expected) {
                let error = mean - truth;
                let squared = LEAST_ERROR + error * error;
                let forgetting_factor = if squared > errors[target] { rising } else { falling };
                errors[target] = forgetting_factor * errors[target] + (1.0 - forgetting_factor) * squared;
            }
        }
    }

    /// The experts' forecasts of a target, weighted by the inverse fourth power of the mean squared
    /// errors.
    fn mixture(&self, target: usize, forecasts: [f64; EXPERTS]) -> f64 {
        let errors = self.errors.column(target);
        let least = errors.min();
        let (mut sum, mut weights) = (0.0, 0.0);
        for (forecast, error) in forecasts.into_iter().zip(errors.iter()) {
            let squared = (least / error) * (least / error);
            sum += squared * squared * forecast;
            weights += squared * squared;
        }
        sum / weights
    }
}
