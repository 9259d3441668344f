//! The search for earlier passes of a place, spread over ticks.

use serde::{Deserialize, Serialize};

use crate::line::{Line, NEIGHBOUR_ROWS};
use crate::pass::{MAX_PASSES, ON_LINE_DISTANCE, Pass, SAME_DIRECTION, dot};
use crate::smooth::RoadPoint;
use crate::ticks::distance;

/// Points by which a pass is older than the vehicle, at least: 8 s.
pub const LEAST_AGE: u64 = 160;
/// Points by which two passes are apart, at least.
pub const MIN_PASS_DISTANCE: f64 = 100.0;
/// Ticks from the beginning of a search to that of the next one.
const SEARCH_INTERVAL_TICKS: usize = 10;

/// A search: a row of cells at each of the first ticks, and then one of its passes at a tick.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Search {
    /// Ticks since it began.
    ticks: usize,
    /// The vehicle then.
    place: RoadPoint,
    /// Nearest points of the latest passes, and their distances \[m\].
    found: [Option<(u64, f64)>; MAX_PASSES],
}

impl Search {
    /// Goes on by a tick. Returns the present point of a pass that is not followed yet.
    pub fn tick(&mut self, line: &Line, place: &RoadPoint, followed: &[Option<Pass>; MAX_PASSES]) -> Option<u64> {
        if self.ticks == SEARCH_INTERVAL_TICKS {
            *self = Search::default();
        }
        if self.ticks == 0 {
            self.place = *place;
        }
        let ticks = self.ticks;
        self.ticks += 1;
        if ticks < NEIGHBOUR_ROWS {
            self.visit(line, ticks, followed);
            return None;
        }
        // As if the pass had the vehicle's pace: the first comparison corrects it.
        self.found.iter_mut().find_map(Option::take).map(|(number, _)| number + ticks as u64)
    }

    /// Looks at a row of cells; the latest passes are preferred.
    fn visit(&mut self, line: &Line, row: usize, followed: &[Option<Pass>; MAX_PASSES]) {
        let Search { place, found, .. } = self;
        let next = line.next();
        // Older ones would not be followed.
        let oldest = |slot: &Option<Pass>| slot.map_or(0, |pass| pass.number as u64);
        let oldest_followed = followed.iter().map(oldest).min().unwrap_or(0);
        line.visit_around(&place.position, row, oldest_followed, |number, point| {
            let apart = distance(&point.position, &place.position);
            if apart > ON_LINE_DISTANCE
                || number + LEAST_AGE > next
                || dot(&point.direction, &place.direction) < SAME_DIRECTION
            {
                return;
            }
            if followed.iter().flatten().any(|pass| (pass.number - number as f64).abs() < MIN_PASS_DISTANCE) {
                return;
            }
            let same = found.iter_mut().flatten().find(|(other, _)| other.abs_diff(number) < MIN_PASS_DISTANCE as u64);
            if let Some(same) = same {
                if apart < same.1 {
                    *same = (number, apart);
                }
                return;
            }
            // The oldest of those found gives way.
            let age = |slot: &Option<(u64, f64)>| slot.map_or(0, |(number, _)| number + 1);
            if let Some(oldest) = found.iter_mut().min_by_key(|slot| age(slot))
                && age(oldest) <= number
            {
                *oldest = Some((number, apart));
            }
        });
    }
}

const _: () = assert!(NEIGHBOUR_ROWS + MAX_PASSES <= SEARCH_INTERVAL_TICKS);
