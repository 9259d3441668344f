//! Force and position as they are remembered.
//!
//! The force is a mean around its time, weighted by a triangle that ends 0.2 s before and after: a
//! low-pass of 1.6 Hz without a shift in time. Elements of a preview that are 0.2 s apart do not
//! alias what it leaves.

use serde::{Deserialize, Serialize};

use crate::line::Point;
use crate::ticks::{TICK, Tick, distance};

/// Ticks by which the smoothed force lags.
pub const LAG: usize = 4;
/// Ticks that a smoothed force is made of.
const WIDTH: usize = 2 * LAG;
/// Weights of the ticks: the triangle at their middles.
const WEIGHTS: [f64; WIDTH] = [0.03125, 0.09375, 0.15625, 0.21875, 0.21875, 0.15625, 0.09375, 0.03125];
/// Ticks of the latest force.
pub const LATEST: usize = 4;
/// Time by which it lags \[s\].
pub const LATEST_LAG: f64 = 0.5 * LATEST as f64 * TICK;
/// Ticks over which a position is averaged.
const POSITIONS: usize = 4;
/// Ticks over which a direction and a speed are taken.
const STRETCH: usize = 6;
/// Places that are kept.
const KEPT: usize = WIDTH;

/// The last ticks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Smooth {
    forces: [[f64; 2]; WIDTH],
    positions: [[f64; 3]; POSITIONS],
    /// Averaged positions and speeds, the latest first.
    places: [RoadPoint; KEPT],
    /// Ticks so far, at most [`KEPT`] and [`POSITIONS`] together.
    count: usize,
}

/// Position of the vehicle at a tick, with its direction and speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RoadPoint {
    /// Mean over 0.2 s \[m\].
    pub position: [f64; 3],
    /// Unit vector; zero at rest.
    pub direction: [f64; 3],
    /// Speed \[m/s\].
    pub speed: f64,
}

impl Smooth {
    /// Takes a tick.
    pub fn push(&mut self, tick: &Tick) {
        if self.count == 0 {
            self.positions = [tick.position; POSITIONS];
        }
        self.count = (self.count + 1).min(KEPT + POSITIONS);
        self.forces.rotate_right(1);
        self.forces[0] = tick.force;
        self.positions.rotate_right(1);
        self.positions[0] = tick.position;
        let position =
            core::array::from_fn(|axis| self.positions.iter().map(|p| p[axis]).sum::<f64>() / POSITIONS as f64);
        self.places.rotate_right(1);
        if self.count == 1 {
            self.places = [RoadPoint { position, ..RoadPoint::default() }; KEPT];
        }
        let before = self.places[STRETCH].position;
        let length = distance(&before, &position);
        let direction = match length {
            0.0 => [0.0; 3],
            _ => core::array::from_fn(|axis| (position[axis] - before[axis]) / length),
        };
        let speed = tick.speed.map_or(length / (STRETCH as f64 * TICK), f64::abs);
        self.places[0] = RoadPoint { position, direction, speed };
    }

    /// True once all kept ticks are the vehicle's.
    pub fn is_full(&self) -> bool {
        self.count == KEPT + POSITIONS
    }

    /// The place at the latest tick.
    pub fn place(&self) -> &RoadPoint {
        &self.places[0]
    }

    /// The force of the latest ticks, which lags by [`LATEST_LAG`], and its slope on each axis
    /// \[m/s2, m/s3\].
    pub fn latest(&self) -> [[f64; 2]; 2] {
        let mean = |axis: usize, from: usize| {
            self.forces[from..from + LATEST].iter().map(|force| force[axis]).sum::<f64>() / LATEST as f64
        };
        core::array::from_fn(|axis| [mean(axis, 0), (mean(axis, 0) - mean(axis, LATEST)) / (LATEST as f64 * TICK)])
    }

    /// The point of the line [`LAG`] ticks ago.
    pub fn point(&self) -> Point {
        let RoadPoint { position, direction, speed } = self.places[LAG];
        let force = |axis: usize| self.forces.iter().zip(WEIGHTS).map(|(force, weight)| weight * force[axis]).sum();
        Point { position, direction, speed, force: core::array::from_fn(force), run: 0 }
    }
}
