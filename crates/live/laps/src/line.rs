//! The remembered line: a ring of points, one a tick, found by place.

use alloc::{vec, vec::Vec};

use serde::{Deserialize, Serialize};

use crate::ticks::distance;

/// Points that are kept: 27 minutes.
pub const MAX_POINTS: usize = 1 << 15;
/// Lists of points by cell.
const CELL_LIST_COUNT: usize = 1 << 13;
/// Rows and columns of the cells around a place.
pub const NEIGHBOUR_ROWS: usize = 3;
/// Number that is no point's.
const NO_POINT: u64 = u64::MAX;

/// A point of the line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Position \[m\].
    pub position: [f64; 3],
    /// Unit vector of the motion.
    pub direction: [f64; 3],
    /// Speed \[m/s\].
    pub speed: f64,
    /// Smoothed force of surge and sway \[m/s2\].
    pub force: [f64; 2],
    /// Number of the stretch without interruption.
    pub run: u32,
}

/// The points, numbered from 0 on; the latest [`MAX_POINTS`] are kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    points: Vec<Point>,
    /// Of each point the one that was listed before it in its list.
    before: Vec<u64>,
    /// The latest point of each list.
    lists: Vec<u64>,
    /// Number of the next point.
    next: u64,
    run: u32,
    /// Position of the point that was listed last.
    listed: Option<[f64; 3]>,
}

impl Default for Line {
    fn default() -> Self {
        Line {
            points: vec![Point::default(); MAX_POINTS],
            before: vec![NO_POINT; MAX_POINTS],
            lists: vec![NO_POINT; CELL_LIST_COUNT],
            next: 0,
            run: 0,
            listed: None,
        }
    }
}

impl Line {
    /// Number of the next point.
    pub fn next(&self) -> u64 {
        self.next
    }

    /// Adds a point to the present stretch.
    pub fn push(&mut self, point: &Point) {
        // Least distance of listed points [m].
        const MIN_LISTED_DISTANCE: f64 = 2.0;
        let slot = self.next as usize % MAX_POINTS;
        self.points[slot] = Point { run: self.run, ..*point };
        self.before[slot] = NO_POINT;
        if self.listed.is_none_or(|listed| distance(&listed, &point.position) >= MIN_LISTED_DISTANCE) {
            let list = list(cell(&point.position));
            self.before[slot] = self.lists[list];
            self.lists[list] = self.next;
            self.listed = Some(point.position);
        }
        self.next += 1;
    }

    /// Ends the present stretch.
    pub fn interrupt(&mut self) {
        self.run = self.run.wrapping_add(1);
        self.listed = None;
    }

    /// The kept points, the oldest first.
    pub fn points(&self) -> impl Iterator<Item = &Point> {
        let first = self.next.saturating_sub(MAX_POINTS as u64);
        (first..self.next).map(|number| &self.points[number as usize % MAX_POINTS])
    }

    /// A point that is kept.
    pub fn point(&self, number: u64) -> Option<&Point> {
        let is_kept = number < self.next && self.next - number <= MAX_POINTS as u64;
        is_kept.then(|| &self.points[number as usize % MAX_POINTS])
    }

    /// The line at a number with a fraction; none where it is interrupted.
    pub fn at(&self, number: f64) -> Option<Between<'_>> {
        let whole = libm::floor(number);
        let from = self.point(if whole >= 0.0 { whole as u64 } else { return None })?;
        let to = self.point(whole as u64 + 1).filter(|to| to.run == from.run)?;
        Some(Between { from, to, fraction: number - whole })
    }

    /// Calls `visit` with listed points in a row of the cells around a position, not before the
    /// point with number `first`.
    pub fn visit_around(&self, position: &[f64; 3], row: usize, first: u64, mut visit: impl FnMut(u64, &Point)) {
        // Points visited in a cell, at most.
        const MAX_CELL_VISITS: usize = 128;
        let [x, y] = cell(position);
        for column in 0..NEIGHBOUR_ROWS {
            let [dx, dy] = [column, row].map(|place| place as i64 - 1);
            let mut number = self.lists[list([x.wrapping_add(dx), y.wrapping_add(dy)])];
            for _ in 0..MAX_CELL_VISITS {
                let Some(point) = self.point(number).filter(|_| number >= first) else { break };
                // Those of other cells in the list are far away.
                visit(number, point);
                let before = self.before[number as usize % MAX_POINTS];
                if before >= number {
                    break;
                }
                number = before;
            }
        }
    }
}

/// The line between two points.
#[derive(Clone, Copy, Debug)]
pub struct Between<'a> {
    from: &'a Point,
    to: &'a Point,
    fraction: f64,
}

impl Between<'_> {
    /// Smoothed force of surge or sway at this distance \[m/s2\].
    pub fn force(&self, axis: usize) -> f64 {
        self.from.force[axis] + self.fraction * (self.to.force[axis] - self.from.force[axis])
    }

    /// Speed at this distance \[m/s\].
    pub fn speed(&self) -> f64 {
        self.from.speed + self.fraction * (self.to.speed - self.from.speed)
    }
}

fn cell(position: &[f64; 3]) -> [i64; 2] {
    // Side of a cell [m].
    const CELL_SIZE: f64 = 10.0;
    [0, 1].map(|axis| libm::floor(position[axis] / CELL_SIZE) as i64)
}

fn list([x, y]: [i64; 2]) -> usize {
    let mixed = (x as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (y as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F);
    (mixed >> 32) as usize % CELL_LIST_COUNT
}
