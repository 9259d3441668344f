//! An earlier pass of the same road, followed beside the vehicle.

use serde::{Deserialize, Serialize};

use crate::line::Line;
use crate::smooth::{LAG_TICKS, RoadPoint};
use crate::ticks::TICK;

/// Passes that are followed at once.
pub const MAX_PASSES: usize = 6;
/// Distance from the remembered line within which the vehicle is on it \[m\].
pub const ON_LINE_DISTANCE: f64 = 10.0;
/// Cosine of the angle between two directions that are the same.
pub const SAME_DIRECTION: f64 = 0.8;
/// Time constant with which the pace is expected to become that of the pass \[s\].
const PACE_FADE: f64 = 3.0;
/// Squared error of a pass of which nothing is known \[(m/s2)^2\].
pub const UNKNOWN_PASS_ERROR: f64 = 4.0;

/// Part of a difference of the pace from 1 that is left after so many seconds.
pub fn pace_weight(time: f64) -> f64 {
    libm::exp(-time / PACE_FADE)
}

/// The place on an earlier pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// Number of the point beside the vehicle, with a fraction.
    pub number: f64,
    /// Speed of the vehicle over that of the pass.
    pub pace: f64,
    /// Mean squared error of its force at the vehicle's place \[(m/s2)^2\].
    pub errors: [f64; 2],
    missed: u32,
}

impl Pass {
    /// A pass at a point, with its squared errors so far.
    pub fn new(number: u64, errors: [f64; 2]) -> Self {
        Pass { number: number as f64, pace: 1.0, errors, missed: 0 }
    }

    /// Goes on by a tick to the place beside the vehicle. False where the vehicle has left the
    /// line, or the line ends.
    pub fn advance(&mut self, line: &Line, place: &RoadPoint) -> bool {
        // Ticks off the line after which the pass is given up.
        const MAX_OFF_LINE_TICKS: u32 = 10;
        // Least and greatest pace.
        const PACE_RANGE: [f64; 2] = [0.5, 2.0];
        // Time constant of the pace [s].
        const PACE_TIME: f64 = 0.1;
        // Fraction of a difference in place that is corrected at each tick.
        const CORRECTION_PER_TICK: f64 = 0.4;
        let expected = self.number + self.pace;
        match nearest(line, place, expected) {
            Some(found) => {
                self.number = expected + CORRECTION_PER_TICK * (found - expected);
                self.missed = 0;
            }
            None => {
                self.number = expected;
                self.missed += 1;
            }
        }
        let Some(here) = line.at(self.number) else { return false };
        if here.speed() > 0.0 {
            let pace = (place.speed / here.speed()).clamp(PACE_RANGE[0], PACE_RANGE[1]);
            self.pace += (pace - self.pace) * (TICK / PACE_TIME);
        }
        self.missed <= MAX_OFF_LINE_TICKS
    }

    /// The force to come at a time whose [`fade`] is this; none where the line is not
    /// known \[m/s2\].
    pub fn force_ahead(&self, line: &Line, time: f64, fade: f64) -> Option<[f64; 2]> {
        // Difference of the pace from 1 up to which it mostly wanders; beyond, it is expected to
        // return.
        const WANDERING_PACE_DIFFERENCE: f64 = 0.1;
        let excess = self.pace - 1.0;
        let square = excess * excess;
        let change =
            -excess * fade / PACE_FADE * square / (square + WANDERING_PACE_DIFFERENCE * WANDERING_PACE_DIFFERENCE);
        let pace = 1.0 + excess * fade;
        let there = line.at(self.number + (time + excess * PACE_FADE * (1.0 - fade)) / TICK)?;
        Some([there.force(0) + change * there.speed(), there.force(1) * pace * pace])
    }

    /// The force so many seconds ago; none where the line is not known \[m/s2\].
    pub fn force_ago(&self, line: &Line, time: f64) -> Option<[f64; 2]> {
        let there = line.at(self.number - time * self.pace / TICK)?;
        Some([there.force(0), there.force(1) * self.pace * self.pace])
    }

    /// Compares the pass with the force [`LAG_TICKS`] ticks ago.
    pub fn compare(&mut self, line: &Line, truth: [f64; 2]) {
        // Time constant of the squared error [s].
        const ERROR_TIME: f64 = 2.0;
        let Some(force) = self.force_ago(line, LAG_TICKS as f64 * TICK) else { return };
        for axis in 0..2 {
            let error = force[axis] - truth[axis];
            self.errors[axis] += (error * error - self.errors[axis]) * (TICK / ERROR_TIME);
        }
    }
}

/// Number of the point of the line nearest to a place, of those around a number.
fn nearest(line: &Line, place: &RoadPoint, around: f64) -> Option<f64> {
    // Points before and after the expected one among which the nearest is searched.
    const SEARCHED_POINTS_BEHIND: u64 = 6;
    const SEARCHED_POINTS_AHEAD: u64 = 8;
    let middle = around.max(0.0) as u64;
    let mut best: Option<(f64, f64)> = None;
    for number in middle.saturating_sub(SEARCHED_POINTS_BEHIND)..middle + SEARCHED_POINTS_AHEAD {
        let Some((from, to)) = line.point(number).zip(line.point(number + 1)) else { continue };
        if from.run != to.run || dot(&from.direction, &place.direction) < SAME_DIRECTION {
            continue;
        }
        let along: [f64; 3] = difference(&from.position, &to.position);
        let offset = difference(&from.position, &place.position);
        let length = dot(&along, &along);
        let fraction = if length > 0.0 { (dot(&offset, &along) / length).clamp(0.0, 1.0) } else { 0.0 };
        let apart: [f64; 3] = core::array::from_fn(|k| offset[k] - fraction * along[k]);
        let square = dot(&apart, &apart);
        if square <= ON_LINE_DISTANCE * ON_LINE_DISTANCE && best.is_none_or(|(least, _)| square < least) {
            best = Some((square, number as f64 + fraction));
        }
    }
    best.map(|(_, number)| number)
}

/// Scalar product.
pub fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn difference(from: &[f64; 3], to: &[f64; 3]) -> [f64; 3] {
    core::array::from_fn(|k| to[k] - from[k])
}
