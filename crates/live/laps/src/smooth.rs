//! Force and position as they are remembered.
//!
//! The force is a mean around its time, weighted by a triangle that ends 0.2 s before and after: a
//! low-pass of 1.6 Hz without a shift in time. Elements of a preview that are 0.2 s apart do not
//! alias what it leaves.

use serde::{Deserialize, Serialize};

use crate::line::Point;
use crate::ticks::{Sample, TICK, distance};

/// Ticks by which the smoothed force lags.
pub const LAG_TICKS: usize = 4;
/// Ticks that a smoothed force is made of.
const TRIANGLE_TICKS: usize = 2 * LAG_TICKS;
/// Ticks of the latest force.
pub const LATEST_FORCE_TICKS: usize = 4;
/// Time by which it lags \[s\].
pub const LATEST_LAG: f64 = 0.5 * LATEST_FORCE_TICKS as f64 * TICK;
/// Ticks over which a position is averaged.
const POSITION_TICKS: usize = 4;
/// Places that are kept.
const KEPT_PLACES: usize = TRIANGLE_TICKS;

/// The last ticks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Smooth {
    forces: [[f64; 2]; TRIANGLE_TICKS],
    positions: [[f64; 3]; POSITION_TICKS],
    /// Averaged positions and speeds, the latest first.
    places: [RoadPoint; KEPT_PLACES],
    /// Ticks so far, at most [`KEPT_PLACES`] and [`POSITION_TICKS`] together.
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
    pub fn push(&mut self, tick: &Sample) {
        // Ticks over which a direction and a speed are taken.
        const DIRECTION_TICKS: usize = 6;
        if self.count == 0 {
            self.positions = [tick.position; POSITION_TICKS];
        }
        self.count = (self.count + 1).min(KEPT_PLACES + POSITION_TICKS);
        self.forces.rotate_right(1);
        self.forces[0] = tick.force;
        self.positions.rotate_right(1);
        self.positions[0] = tick.position;
        let position =
            core::array::from_fn(|axis| self.positions.iter().map(|p| p[axis]).sum::<f64>() / POSITION_TICKS as f64);
        self.places.rotate_right(1);
        if self.count == 1 {
            self.places = [RoadPoint { position, ..RoadPoint::default() }; KEPT_PLACES];
        }
        let before = self.places[DIRECTION_TICKS].position;
        let length = distance(&before, &position);
        let direction = match length {
            0.0 => [0.0; 3],
            _ => core::array::from_fn(|axis| (position[axis] - before[axis]) / length),
        };
        let speed = tick.speed.map_or(length / (DIRECTION_TICKS as f64 * TICK), f64::abs);
        self.places[0] = RoadPoint { position, direction, speed };
    }

    /// True once all kept ticks are the vehicle's.
    pub fn is_full(&self) -> bool {
        self.count == KEPT_PLACES + POSITION_TICKS
    }

    /// The place at the latest tick.
    pub fn place(&self) -> &RoadPoint {
        &self.places[0]
    }

    /// The force of the latest ticks, which lags by [`LATEST_LAG`], and its slope on each axis
    /// \[m/s2, m/s3\].
    pub fn latest(&self) -> [[f64; 2]; 2] {
        let mean = |axis: usize, from: usize| {
            self.forces[from..from + LATEST_FORCE_TICKS].iter().map(|force| force[axis]).sum::<f64>()
                / LATEST_FORCE_TICKS as f64
        };
        core::array::from_fn(|axis| {
            [mean(axis, 0), (mean(axis, 0) - mean(axis, LATEST_FORCE_TICKS)) / (LATEST_FORCE_TICKS as f64 * TICK)]
        })
    }

    /// The point of the line [`LAG_TICKS`] ticks ago.
    pub fn point(&self) -> Point {
        // Weights of the ticks: the triangle at their middles.
        const TRIANGLE_WEIGHTS: [f64; TRIANGLE_TICKS] =
            [0.03125, 0.09375, 0.15625, 0.21875, 0.21875, 0.15625, 0.09375, 0.03125];
        let RoadPoint { position, direction, speed } = self.places[LAG_TICKS];
        let force =
            |axis: usize| self.forces.iter().zip(TRIANGLE_WEIGHTS).map(|(force, weight)| weight * force[axis]).sum();
        Point { position, direction, speed, force: core::array::from_fn(force), run: 0 }
    }
}
