//! Forecasts of an axis, and their errors once their times have come.
//!
//! A forecast is M + b D. M is the force of the earlier passes at the place to come, and D how far
//! the present force is from theirs. For each time ahead, b is the least-squares fit to what came
//! in the last minute, with a prior that fades with the time ahead.

use alloc::{vec, vec::Vec};

use serde::{Deserialize, Serialize};

use crate::account::Gain;
use crate::smooth::{LAG_TICKS, LATEST_FORCE_TICKS, LATEST_LAG};
use crate::ticks::TICK;

/// Times ahead: the preview's elements, and one more to interpolate.
pub const FORECAST_POINTS: usize = 21;
/// Ticks from one to the next.
pub const POINT_SPACING_TICKS: usize = 4;
/// Forecasts that are kept.
const KEPT_FORECASTS: usize = FORECAST_POINTS * POINT_SPACING_TICKS + LAG_TICKS + 1;
/// Weight of the prior of b: squared force, summed over ticks \[(m/s2)^2\].
const PRIOR_WEIGHT: f64 = 50.0;
/// Elements whose errors count: 0.4, 1 and 2 s ahead.
const COMPARED_ELEMENTS: [usize; 3] = [1, 4, 9];
/// Forecasts without memory.
const MEMORYLESS_FORECASTS: usize = 4;
/// Squared error added to the least one without memory \[(m/s2)^2\].
const ERROR_FLOOR: f64 = 0.002;

/// A forecast, kept until its times have come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Made {
    /// False after an interruption.
    is_known: bool,
    is_made: bool,
    /// The preview was given.
    is_given: bool,
    /// Force of the earlier passes at the times to come \[m/s2\].
    passes: [f64; FORECAST_POINTS],
    /// Present force less that of the earlier passes \[m/s2\].
    difference: f64,
    /// The forecast at the compared times \[m/s2\].
    forces: [f64; COMPARED_ELEMENTS.len()],
    present: Present,
    /// What a wave was expected to be at the compared times \[m/s2\].
    waves: [f64; COMPARED_ELEMENTS.len()],
}

/// Time ahead of an element \[s\].
pub fn time_ahead(element: usize) -> f64 {
    TICK * ((element + 1) * POINT_SPACING_TICKS) as f64
}

/// Growth of a trend up to an element's time; it fades \[s\].
fn trend_growth(element: usize) -> f64 {
    // Time constant with which a trend fades [s].
    const TREND_TIME: f64 = 1.5;
    TREND_TIME * (1.0 - libm::exp(-(time_ahead(element) + LATEST_LAG) / TREND_TIME))
}

/// Part of a difference that is expected to last up to an element's time.
fn lasting_part(element: usize) -> f64 {
    // Time constant of the prior of b [s].
    const LASTING_TIME: f64 = 0.5;
    libm::exp(-time_ahead(element) / LASTING_TIME)
}

/// Sums of D^2 and of D times the error of M.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Fit {
    squares: f64,
    products: f64,
}

impl Fit {
    fn carried(&self, prior: f64) -> f64 {
        // Range of b.
        const COEFFICIENT_RANGE: [f64; 2] = [0.0, 1.0];
        ((self.products + PRIOR_WEIGHT * prior) / (self.squares + PRIOR_WEIGHT))
            .clamp(COEFFICIENT_RANGE[0], COEFFICIENT_RANGE[1])
    }
}

/// Present force \[m/s2\], its slope, and that of 0.2 s ago \[m/s3\].
type Present = [f64; 3];

/// Least squares of the force at a time ahead on the present one and its slopes, good for waves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Wave {
    /// Sums of products of the present values with each other, and with the force that came.
    squares: [Present; 3],
    products: Present,
}

impl Wave {
    fn learn(&mut self, forgetting_factor: f64, present: &Present, truth: f64) {
        for i in 0..3 {
            for j in 0..=i {
                self.squares[i][j] = forgetting_factor * self.squares[i][j] + present[i] * present[j];
            }
            self.products[i] = forgetting_factor * self.products[i] + present[i] * truth;
        }
    }

    /// The forecast, by L D L' of the sums with a prior.
    fn forecast(&self, present: &Present) -> f64 {
        let s = &self.squares;
        let d0 = s[0][0] + PRIOR_WEIGHT;
        let [l1, l2] = [s[1][0] / d0, s[2][0] / d0];
        let d1 = s[1][1] + PRIOR_WEIGHT - l1 * s[1][0];
        let m2 = (s[2][1] - l1 * s[2][0]) / d1;
        let d2 = s[2][2] + PRIOR_WEIGHT - l2 * s[2][0] - m2 * m2 * d1;
        let solved = |v: &Present| {
            let y1 = v[1] - l1 * v[0];
            [v[0], y1, v[2] - l2 * v[0] - m2 * y1]
        };
        let ([p0, p1, p2], [q0, q1, q2]) = (solved(&self.products), solved(present));
        p0 * q0 / d0 + p1 * q1 / d1 + p2 * q2 / d2
    }
}

/// The forecasts of an axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// A ring, with the latest forecast at `latest`.
    made: Vec<Made>,
    latest: usize,
    fits: [Fit; FORECAST_POINTS],
    /// Mean squared error of the forecasts, and of the passes at present \[(m/s2)^2\].
    error: f64,
    error_now: f64,
    /// Errors of the forecasts without memory, at each of the compared times: of the present force
    /// held, of no force, of a trend, and of a wave.
    plain: [[f64; MEMORYLESS_FORECASTS]; COMPARED_ELEMENTS.len()],
    waves: [Wave; COMPARED_ELEMENTS.len()],
    /// Of the forecasts whose times have come with the latest tick.
    gain: Gain,
}

impl Default for Record {
    fn default() -> Self {
        Record {
            made: vec![Made::default(); KEPT_FORECASTS],
            latest: 0,
            fits: [Fit::default(); FORECAST_POINTS],
            error: 0.0,
            error_now: 0.0,
            plain: [[0.0; MEMORYLESS_FORECASTS]; COMPARED_ELEMENTS.len()],
            waves: [Wave::default(); COMPARED_ELEMENTS.len()],
            gain: Gain::default(),
        }
    }
}

impl Record {
    /// Forgets the forecasts whose times have not come.
    pub fn interrupt(&mut self) {
        self.made.fill(Made::default());
    }

    /// Goes on to the next tick with the force [`LAG_TICKS`] ticks ago, and the present one with
    /// its slope. `passes` are the forces of the earlier passes to come and at present, if there
    /// are any. Returns the forecast.
    pub fn tick(
        &mut self,
        truth: f64,
        [held, slope]: [f64; 2],
        passes: Option<(&[f64; FORECAST_POINTS], f64)>,
    ) -> Option<[f64; FORECAST_POINTS]> {
        // Time constant of the mean squared error at present [s].
        const NOW_TIME: f64 = 0.5;
        self.latest = (self.latest + 1) % KEPT_FORECASTS;
        self.compare(truth);
        let before = &self.made[(self.latest + KEPT_FORECASTS - LATEST_FORCE_TICKS) % KEPT_FORECASTS];
        let present = [held, slope, if before.is_known { before.present[1] } else { slope }];
        let waves = self.waves.map(|wave| wave.forecast(&present));
        self.made[self.latest] = Made { is_known: true, present, waves, ..Made::default() };
        let (passes, now) = passes?;
        let difference = held - now;
        self.error_now += TICK / NOW_TIME * (difference * difference - self.error_now);
        let forecast: [f64; FORECAST_POINTS] =
            core::array::from_fn(|k| passes[k] + self.fits[k].carried(lasting_part(k)) * difference);
        let forces = COMPARED_ELEMENTS.map(|k| forecast[k]);
        let made = &mut self.made[self.latest];
        *made = Made { is_made: true, passes: *passes, difference, forces, ..*made };
        Some(forecast)
    }

    fn compare(&mut self, truth: f64) {
        // Time constant of the fit [s].
        const FIT_TIME: f64 = 60.0;
        // Time constants with which a mean squared error follows larger and smaller ones [s]. The
        // first is that of a forecast that proves itself, too.
        const ERROR_TIMES: [f64; 2] = [2.0, 8.0];
        // A forecast proves itself where its squared error now is below this part of that without
        // memory.
        const PROVED_ERROR_RATIO: f64 = 0.25;
        let [rising, falling] = ERROR_TIMES.map(|time| TICK / time);
        let latest = self.latest + KEPT_FORECASTS;
        let before = |ticks: usize| (latest - ticks) % KEPT_FORECASTS;
        let forgetting_factor = 1.0 - TICK / FIT_TIME;
        for (k, fit) in self.fits.iter_mut().enumerate() {
            let made = &self.made[before(LAG_TICKS + (k + 1) * POINT_SPACING_TICKS)];
            if made.is_made {
                fit.squares = forgetting_factor * fit.squares + made.difference * made.difference;
                fit.products = forgetting_factor * fit.products + made.difference * (truth - made.passes[k]);
            }
        }
        let [mut square, mut without, mut count] = [0.0; 3];
        self.gain = Gain::default();
        for (k, element) in COMPARED_ELEMENTS.into_iter().enumerate() {
            let made = &self.made[before(LAG_TICKS + (element + 1) * POINT_SPACING_TICKS)];
            let [held, slope, _] = made.present;
            let plain = [held, 0.0, held + slope * trend_growth(element), made.waves[k]];
            let squares = plain.map(|forecast| (forecast - truth) * (forecast - truth));
            if made.is_made {
                let best = (0..MEMORYLESS_FORECASTS)
                    .min_by(|a, b| self.plain[k][*a].total_cmp(&self.plain[k][*b]))
                    .unwrap_or(0);
                without += squares[best];
                let error = (made.forces[k] - truth) * (made.forces[k] - truth);
                square += error;
                let gain = (squares[best] - error) / COMPARED_ELEMENTS.len() as f64;
                if made.is_given {
                    self.gain.given += gain;
                } else {
                    self.gain.made += gain;
                }
                count += 1.0;
            }
            if made.is_known {
                self.waves[k].learn(forgetting_factor, &made.present, truth);
                for (error, square) in self.plain[k].iter_mut().zip(squares) {
                    *error += falling * (square - *error);
                }
            }
        }
        if count > 0.0 {
            let mean = square / count;
            let is_quick = mean > self.error || square < PROVED_ERROR_RATIO * without;
            self.error += if is_quick { rising } else { falling } * (mean - self.error);
        } else {
            self.error = self.error_without_memory() + ERROR_FLOOR;
        }
    }

    /// Gain of the forecasts whose times have come with the latest tick.
    pub fn gain(&self) -> Gain {
        self.gain
    }

    /// Says that the latest forecast is given.
    pub fn give(&mut self) {
        self.made[self.latest].is_given = true;
    }

    /// The weight that the forecast deserves against those without memory, from 0 to 1.
    pub fn trust(&self) -> f64 {
        // Ratio of the squared errors at which the forecast has half of the trust.
        const HALF_TRUST_RATIO: f64 = 0.6;
        let ratio = self.error.max(self.error_now) / (HALF_TRUST_RATIO * (self.error_without_memory() + ERROR_FLOOR));
        1.0 / (1.0 + ratio * ratio * ratio * ratio)
    }

    /// Mean squared error of the best forecast without memory: the present force held, no force,
    /// a trend, or a wave \[(m/s2)^2\].
    pub fn error_without_memory(&self) -> f64 {
        self.plain.iter().map(|errors| errors.iter().copied().fold(f64::INFINITY, f64::min)).sum::<f64>()
            / COMPARED_ELEMENTS.len() as f64
    }
}
