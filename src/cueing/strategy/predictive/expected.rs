//! The reference that is expected over a horizon.

use nalgebra::SVector;
use serde::{Deserialize, Serialize};

use super::horizon::{BLOCKS, FORECAST_TIME, Horizon};

/// Decay of the slow and the fast part of a reference that fades \[1/s\].
pub const DECAY_RATES: [f64; 2] = [0.1, 3.0];

/// The expected reference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Forecast {
    /// Mean of the reference over each block \[m/s2\].
    pub means: SVector<f64, BLOCKS>,
    /// The slow and the fast part at the horizon's end \[m/s2\].
    pub end: [f64; 2],
}

impl Forecast {
    /// The forecast over the blocks of another horizon. Beyond its own, its slow
    /// and its fast part fade.
    pub fn over(&self, horizon: Horizon) -> Self {
        let (ends, durations) = (horizon.ends(), horizon.durations());
        let means =
            SVector::from_fn(|k, _| (self.integral(ends[k]) - self.integral(ends[k] - durations[k])) / durations[k]);
        let faded = |part: usize| libm::exp(-DECAY_RATES[part] * (ends[BLOCKS - 1] - FORECAST_TIME).max(0.0));
        Forecast { means, end: [0, 1].map(|part: usize| self.end[part] * faded(part)) }
    }

    /// Integral of the reference from now to a time \[m/s\]. Beyond the forecast's end, its slow
    /// and its fast part fade.
    pub fn integral(&self, time: f64) -> f64 {
        let blocks = Horizon::Near.ends().into_iter().zip(*Horizon::Near.durations());
        let within = |(end, duration): (f64, f64)| (time - (end - duration)).clamp(0.0, duration);
        let inside: f64 = self.means.iter().zip(blocks).map(|(mean, block)| mean * within(block)).sum();
        let beyond = (time - FORECAST_TIME).max(0.0);
        let tail = |part: usize| self.end[part] * (1.0 - libm::exp(-DECAY_RATES[part] * beyond)) / DECAY_RATES[part];
        inside + tail(0) + tail(1)
    }

    /// Between this forecast and another one: `trust` is the weight of the other's means, and that
    /// of the last of them also the weight of its end.
    pub fn towards(&self, other: &Forecast, trust: &SVector<f64, BLOCKS>) -> Self {
        let last = trust[BLOCKS - 1];
        Forecast {
            means: self.means + trust.component_mul(&(other.means - self.means)),
            end: [0, 1].map(|part: usize| self.end[part] + last * (other.end[part] - self.end[part])),
        }
    }
}
