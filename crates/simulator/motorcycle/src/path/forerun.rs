//! The motion of the next seconds, for the preview.
//!
//! A second simulation with the same equations, rider and path is stepped ahead of the motorcycle.
//! The second one records the specific force at the head by time and distance. The preview is the
//! recorded force from the motorcycle's present distance on. Until the simulation is far enough
//! ahead, it takes several steps for each step of the motorcycle. Wind and torso command count as
//! constant. The simulation restarts at the motorcycle when the motorcycle's speed or deviation
//! differs too much from the recorded one.

use moris_washout::interface::PREVIEW_SAMPLES;
use nalgebra::SVector;
use serde::{Deserialize, Serialize};

use crate::state::{RunState, State};

/// Time between two elements of the preview \[s\].
pub const PREVIEW_STEP: f64 = 0.2;
/// Time between two records \[s\].
const RECORD_INTERVAL: f64 = 0.02;
const RECORD_CAPACITY: usize = 256;

/// A record of the second simulation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Distance along the path \[m\].
    pub distance: f64,
    pub speed: f64,
    pub deviation: f64,
    /// Specific force at the head \[m/s2\].
    pub surge: f64,
    pub sway: f64,
}

impl Record {
    fn toward(&self, other: &Record, t: f64) -> Record {
        let number = |from: f64, to: f64| from + t * (to - from);
        Record {
            distance: number(self.distance, other.distance),
            speed: number(self.speed, other.speed),
            deviation: number(self.deviation, other.deviation),
            surge: number(self.surge, other.surge),
            sway: number(self.sway, other.sway),
        }
    }
}

/// The second simulation and its records.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Forerun {
    run: RunState,
    /// The last records, each at its number modulo [`RECORD_CAPACITY`].
    records: SVector<Record, RECORD_CAPACITY>,
    /// Number of the last record.
    last: usize,
    /// Internal steps since the last record.
    steps: u32,
    /// Time in the records that corresponds to the motorcycle's present position \[s\].
    now: f64,
    /// Time that may still be simulated ahead \[s\].
    allowance: f64,
}

/// A preview: number of elements in use, surge and sway.
pub type Preview = (i32, [f64; PREVIEW_SAMPLES], [f64; PREVIEW_SAMPLES]);

impl Forerun {
    /// A second simulation that begins at the motorcycle's state.
    pub fn new(run: RunState, here: Record) -> Self {
        Forerun { run, records: SVector::repeat(here), last: 0, steps: 0, now: 0.0, allowance: 0.0 }
    }

    /// Follows a step of the motorcycle of `step` seconds, in internal steps of at most `longest`
    /// seconds: `advanced` makes one, and `record` a record.
    pub fn follow(
        &mut self,
        step: f64,
        longest: f64,
        here: &State,
        advanced: impl Fn(&RunState, f64) -> RunState,
        record: impl Fn(&RunState) -> Record,
    ) {
        // Time by which the second simulation is ahead [s]: the preview and a record.
        const LEAD_TIME: f64 = PREVIEW_STEP * PREVIEW_SAMPLES as f64 + RECORD_INTERVAL;
        // Largest time simulated ahead per second of the motorcycle [s].
        const MAX_AHEAD_RATE: f64 = 5.0;
        self.find(step, here);
        let per_record = libm::ceil(RECORD_INTERVAL / longest - 1e-6).max(1.0);
        let size = RECORD_INTERVAL / per_record;
        self.allowance = (self.allowance + MAX_AHEAD_RATE * step).min(MAX_AHEAD_RATE * step + RECORD_INTERVAL);
        while self.last as f64 * RECORD_INTERVAL < self.now + LEAD_TIME && self.allowance >= size {
            self.run = advanced(&self.run, size);
            self.allowance -= size;
            self.steps += 1;
            if f64::from(self.steps) >= per_record {
                self.steps = 0;
                self.last += 1;
                self.records[self.last % RECORD_CAPACITY] = record(&self.run);
            }
        }
    }

    /// Finds the time in the records that corresponds to the motorcycle's present position.
    fn find(&mut self, step: f64, here: &State) {
        // Speed below which records are found by time, not by distance [m/s].
        const SLOW_SPEED: f64 = 1.0;
        self.now = (self.now + step).min(self.last as f64 * RECORD_INTERVAL);
        if here.speed < SLOW_SPEED {
            return;
        }
        let distance = here.place.distance;
        let mut number = (self.now / RECORD_INTERVAL) as usize;
        let oldest = (self.last + 1).saturating_sub(RECORD_CAPACITY);
        while number > oldest && self.record(number).distance > distance {
            number -= 1;
        }
        while number + 1 < self.last && self.record(number + 1).distance <= distance {
            number += 1;
        }
        let (before, after) = (self.record(number), self.record((number + 1).min(self.last)));
        let covered = after.distance - before.distance;
        if covered > 0.0 {
            let fraction = ((distance - before.distance) / covered).clamp(0.0, 1.0);
            self.now = (number as f64 + fraction) * RECORD_INTERVAL;
        }
    }

    /// True if the motorcycle's speed or deviation differs too much from the recorded one.
    pub fn is_wrong(&self, here: &State) -> bool {
        // Least time between two restarts [s].
        const LEAST_TIME: f64 = 2.0;
        // Largest errors of speed [m/s] and deviation [m] without a restart.
        const LARGEST_SPEED_ERROR: f64 = 0.5;
        const LARGEST_DEVIATION_ERROR: f64 = 0.3;
        let then = self.at(self.now);
        self.now > LEAST_TIME
            && ((then.speed - here.speed).abs() > LARGEST_SPEED_ERROR
                || (then.deviation - here.place.deviation).abs() > LARGEST_DEVIATION_ERROR)
    }

    /// The preview from now on. `felt` is the present specific force in surge and sway at the head
    /// \[m/s2\]. Its difference from the recorded one decays over the preview.
    pub fn preview(&self, felt: [f64; 2]) -> Preview {
        // Time constant with which a difference between the two is assumed to decay [s].
        const DIFFERENCE_TIME_CONSTANT: f64 = 1.0;
        let then = self.at(self.now);
        let [surge, sway] = [felt[0] - then.surge, felt[1] - then.sway];
        let end = self.last as f64 * RECORD_INTERVAL;
        let time = |k: usize| self.now + (k + 1) as f64 * PREVIEW_STEP;
        let count = (0..PREVIEW_SAMPLES).take_while(|&k| time(k) <= end).count();
        let record = |k: usize| if k < count { self.at(time(k)) } else { Record::default() };
        let records: [Record; PREVIEW_SAMPLES] = std::array::from_fn(record);
        let fading = |k: usize| {
            if k < count { libm::exp(-((k + 1) as f64) * PREVIEW_STEP / DIFFERENCE_TIME_CONSTANT) } else { 0.0 }
        };
        (
            count as i32,
            std::array::from_fn(|k| records[k].surge + surge * fading(k)),
            std::array::from_fn(|k| records[k].sway + sway * fading(k)),
        )
    }

    /// The record of this number.
    fn record(&self, number: usize) -> &Record {
        &self.records[number % RECORD_CAPACITY]
    }

    /// The second simulation at a time since its beginning, interpolated between two records.
    fn at(&self, time: f64) -> Record {
        let along = time / RECORD_INTERVAL;
        let number = (along as usize).min(self.last);
        let fraction = (along - number as f64).clamp(0.0, 1.0);
        self.record(number).toward(self.record((number + 1).min(self.last)), fraction)
    }
}
