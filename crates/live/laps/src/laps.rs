//! The whole: samples in, preview out.

use moris_washout::Preview;
use serde::{Deserialize, Serialize};

use crate::account::Account;
use crate::forecast::{FORECAST_POINTS, POINT_SPACING_TICKS, Record, time_ahead};
use crate::line::{Line, MAX_POINTS, Point};
use crate::pass::{MAX_PASSES, Pass, UNKNOWN_PASS_ERROR, pace_weight};
use crate::search::{LEAST_AGE, MIN_PASS_DISTANCE, Search};
use crate::smooth::{LAG_TICKS, LATEST_LAG, Smooth};
use crate::ticks::{Sample, TICK, Ticks};

/// A memory of the road, and the preview by it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Laps {
    ticks: Ticks,
    memory: Memory,
}

/// All but the ticks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Memory {
    smooth: Smooth,
    line: Line,
    passes: [Option<Pass>; MAX_PASSES],
    /// Force of surge and sway to come by the passes \[m/s2\].
    forecast: Option<[[f64; FORECAST_POINTS]; 2]>,
    records: [Record; 2],
    search: Search,
    account: Account,
    is_given: bool,
}

impl Laps {
    /// An empty memory.
    pub fn new() -> Self {
        Laps::default()
    }

    /// A memory of these points, the oldest first. The latest ones are kept.
    pub fn remembering(points: &[Point]) -> Self {
        let mut laps = Laps::default();
        let mut run = None;
        for point in points {
            if run.replace(point.run).is_some_and(|run| run != point.run) {
                laps.memory.line.interrupt();
            }
            laps.memory.line.push(point);
        }
        laps.memory.line.interrupt();
        laps
    }

    /// The remembered points, the oldest first.
    pub fn points(&self) -> impl Iterator<Item = &Point> {
        self.memory.line.points()
    }

    /// Takes a sample.
    pub fn step(&mut self, sample: &Sample) {
        if !self.ticks.push(sample, |tick| self.memory.tick(tick)) {
            self.memory.interrupt();
        }
    }

    /// Says that the next sample has nothing to do with those before: another place or ride.
    pub fn interrupt(&mut self) {
        self.ticks = Ticks::default();
        self.memory.interrupt();
    }

    /// Number of earlier passes of this place that are followed.
    pub fn passes(&self) -> usize {
        self.memory.passes.iter().flatten().count()
    }

    /// Trust in the preview, from 0 to 1; 0 without one.
    pub fn trust(&self) -> f64 {
        if self.memory.is_given { overall_trust(&self.memory.records) } else { 0.0 }
    }

    /// The force of the next 4 s; without elements where nothing is known.
    pub fn preview(&self) -> Preview {
        let mut preview = Preview::default();
        let Some([surge, sway]) = &self.memory.forecast else { return preview };
        if !self.memory.is_given {
            return preview;
        }
        let elements = preview.surge.len();
        preview.count = elements as i32;
        let fraction = self.ticks.since() / (POINT_SPACING_TICKS as f64 * TICK);
        for k in 0..elements {
            let at = |forecast: &[f64; FORECAST_POINTS]| forecast[k] + fraction * (forecast[k + 1] - forecast[k]);
            (preview.surge[k], preview.sway[k]) = (at(surge), at(sway));
        }
        preview
    }
}

/// Trust of both axes, weighted by the squared errors without memory.
fn overall_trust(records: &[Record; 2]) -> f64 {
    let sum = records.iter().fold([0.0; 2], |[sum, weights], record| {
        let weight = record.error_without_memory() + 1e-6;
        [sum + weight * record.trust(), weights + weight]
    });
    sum[0] / sum[1]
}

impl Memory {
    fn interrupt(&mut self) {
        self.smooth = Smooth::default();
        self.line.interrupt();
        self.passes = [None; MAX_PASSES];
        self.search = Search::default();
        self.is_given = false;
        self.forecast = None;
        for record in &mut self.records {
            record.interrupt();
        }
    }

    fn tick(&mut self, tick: &Sample) {
        // Below this speed there is no line to follow [m/s].
        const LEAST_SPEED: f64 = 1.0;
        // Trust from which on there is a preview, and below which there is none any more.
        const PREVIEW_TRUST_THRESHOLDS: [f64; 2] = [0.5, 0.2];
        self.smooth.push(tick);
        if !self.smooth.is_full() {
            return;
        }
        let point = self.smooth.point();
        let place = *self.smooth.place();
        let is_moving = place.speed >= LEAST_SPEED && point.speed >= LEAST_SPEED;
        if is_moving {
            self.line.push(&point);
        } else {
            self.line.interrupt();
        }
        for slot in &mut self.passes {
            if slot.as_mut().is_some_and(|pass| !is_moving || !pass.advance(&self.line, &place)) {
                *slot = None;
            }
        }
        self.drop_doubles();
        for pass in self.passes.iter_mut().flatten() {
            pass.compare(&self.line, point.force);
        }
        if !is_moving {
            self.search = Search::default();
        } else if let Some(number) = self.search.tick(&self.line, &place, &self.passes) {
            self.follow(number);
        }
        let held = self.smooth.latest();
        let known = self.by_passes();
        let of_axis = |axis: usize| known.as_ref().map(|(ahead, now)| (&ahead[axis], now[axis]));
        let [surge, sway] = &mut self.records;
        let surge = surge.tick(point.force[0], held[0], of_axis(0));
        let sway = sway.tick(point.force[1], held[1], of_axis(1));
        self.forecast = surge.zip(sway).map(|(surge, sway)| [surge, sway]);
        self.account.tick(point.force, [self.records[0].gain(), self.records[1].gain()]);
        let is_trusted = overall_trust(&self.records) > PREVIEW_TRUST_THRESHOLDS[usize::from(self.is_given)];
        self.is_given = self.forecast.is_some() && is_trusted && self.account.allows(self.is_given);
        if self.is_given {
            self.records.iter_mut().for_each(Record::give);
        }
    }

    /// Keeps the latest of passes that have come together, and gives up those that are not past.
    fn drop_doubles(&mut self) {
        let newest = self.line.next() as f64 - LEAST_AGE as f64;
        for k in 0..MAX_PASSES {
            let Some(pass) = self.passes[k] else { continue };
            let doubles =
                self.passes[..k].iter().flatten().any(|other| (other.number - pass.number).abs() < MIN_PASS_DISTANCE);
            if doubles || pass.number > newest {
                self.passes[k] = None;
            }
        }
    }

    /// Follows a pass from this point on, in place of the oldest one that is followed.
    fn follow(&mut self, number: u64) {
        let oldest = |slot: &Option<Pass>| slot.map_or(-1.0, |pass| pass.number);
        let slot = self.passes.iter().enumerate().min_by(|(_, a), (_, b)| oldest(a).total_cmp(&oldest(b)));
        if let Some((slot, _)) = slot.filter(|(_, pass)| oldest(pass) < number as f64) {
            self.passes[slot] = Some(Pass::new(number, self.errors_so_far(number)));
        }
    }

    /// Mean squared errors of a pass over the vehicle's way so far.
    fn errors_so_far(&self, number: u64) -> [f64; 2] {
        // Ticks of the vehicle's way with which a found pass is compared.
        const COMPARED_TICKS: u64 = 80;
        let now = self.line.next() - 1;
        // As if ten points of an unknown pass had been compared.
        let mut count = 10.0;
        let mut sums = [UNKNOWN_PASS_ERROR * count; 2];
        let run = self.line.point(now).map(|point| point.run);
        for back in 0..COMPARED_TICKS.min(number).min(now) {
            // The vehicle's last point is older than its place.
            let (Some(own), Some(then)) =
                (self.line.point(now - back), self.line.point(number.saturating_sub(back + LAG_TICKS as u64)))
            else {
                break;
            };
            if Some(own.run) != run {
                break;
            }
            for (sum, (own, then)) in sums.iter_mut().zip(own.force.iter().zip(&then.force)) {
                *sum += (own - then) * (own - then);
            }
            count += 1.0;
        }
        sums.map(|sum| sum / count)
    }

    /// Forces to come and present forces by the passes, weighted by their errors.
    fn by_passes(&self) -> Option<([[f64; FORECAST_POINTS]; 2], [f64; 2])> {
        // Squared error added to those of passes before they are weighed [(m/s2)^2].
        const WEIGHT_FLOOR: f64 = 0.02;
        // Difference of the pace from 1 at which a pass has half of its weight.
        const HALF_WEIGHT_PACE_DIFFERENCE: f64 = 0.05;
        let mut ahead = [[0.0; FORECAST_POINTS]; 2];
        let mut now = [0.0; 2];
        let mut weights = [0.0; 2];
        // Parts of the differences of the pace that are left at the times ahead.
        let fades: [f64; FORECAST_POINTS] = core::array::from_fn(|k| pace_weight(time_ahead(k)));
        for pass in self.passes.iter().flatten() {
            let mut forces = [[0.0; 2]; FORECAST_POINTS];
            let is_known = forces.iter_mut().enumerate().all(|(k, force)| {
                let there = pass.force_ahead(&self.line, time_ahead(k), fades[k]);
                *force = there.unwrap_or_default();
                there.is_some()
            });
            let Some(present) = pass.force_ago(&self.line, LATEST_LAG).filter(|_| is_known) else { continue };
            let difference = (pass.pace - 1.0) / HALF_WEIGHT_PACE_DIFFERENCE;
            let alike = 1.0 / (1.0 + difference * difference);
            for axis in 0..2 {
                let weight = alike / (pass.errors[axis] + WEIGHT_FLOOR);
                weights[axis] += weight;
                now[axis] += weight * present[axis];
                for (sum, force) in ahead[axis].iter_mut().zip(&forces) {
                    *sum += weight * force[axis];
                }
            }
        }
        let mean = |axis: usize| ahead[axis].map(|sum| sum / weights[axis]);
        (weights[0] > 0.0).then(|| ([mean(0), mean(1)], [now[0] / weights[0], now[1] / weights[1]]))
    }
}

const _: () = assert!(MAX_POINTS as u64 > LEAST_AGE);
