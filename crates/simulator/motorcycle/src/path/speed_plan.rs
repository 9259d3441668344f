//! Speed by distance within the limits of tyres and comfort.
//!
//! Three passes as in Kapania, Subosits and Gerdes, "A sequential two-step algorithm for fast
//! generation of vehicle racing trajectories", J. Dyn. Syst. Meas. Control 138 (2016) 091005: the
//! speed that the curvature permits, a pass forward within the drive's force, and a pass backward
//! within the brakes'. Lateral and longitudinal acceleration stay together within an ellipse.

use nalgebra::SVector;
use serde::{Deserialize, Serialize};

use super::table::{Between, Table};
use crate::interface::{PATH_POINTS, Parameters};
use crate::longitudinal::Longitudinal;

/// Places between two rows of the path, the first row included.
const DIVISIONS_PER_ROW: usize = 12;
const MAX_PLAN_NODES: usize = (PATH_POINTS - 1) * DIVISIONS_PER_ROW + 1;

/// The square of the speed, linear between the places.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpeedPlan {
    square: SVector<f64, MAX_PLAN_NODES>,
    /// Acceleration between two places \[m/s2\].
    acceleration: SVector<f64, MAX_PLAN_NODES>,
}

/// Limits of a plan \[m/s2\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    pub lateral: f64,
    pub forward: f64,
    pub backward: f64,
}

impl Limits {
    /// The rider's limits, and of the tyres' friction and the rider's lean what leaves a reserve.
    pub fn new(parameters: &Parameters) -> Self {
        // Fraction of the friction that a plan uses.
        const FRICTION_FRACTION: f64 = 0.7;
        // Fraction of the largest lean that a plan uses.
        const LEAN_FRACTION: f64 = 0.85;
        let Parameters { path, tyres, rider, run, .. } = parameters;
        let grip = FRICTION_FRACTION * tyres.friction * run.gravity;
        let lean = LEAN_FRACTION * libm::tan(rider.lean_limit) * run.gravity;
        Limits {
            lateral: path.lateral_acceleration.min(grip * path.friction_ratio.min(1.0)).min(lean),
            forward: path.forward_acceleration.min(grip),
            backward: path.deceleration.min(grip),
        }
    }

    /// Fraction of the longitudinal acceleration that the lateral one leaves.
    fn left(&self, lateral: f64) -> f64 {
        let fraction = lateral / self.lateral;
        libm::sqrt((1.0 - fraction * fraction).max(0.0))
    }
}

impl SpeedPlan {
    /// The fastest plan along a path.
    pub fn new(table: &Table, limits: &Limits, longitudinal: &Longitudinal) -> Self {
        // Fraction of the drive's force that a plan uses.
        const DRIVE_FRACTION: f64 = 0.9;
        let nodes = (table.count() - 1) * DIVISIONS_PER_ROW + 1;
        let place = |node: usize| {
            let row = (node / DIVISIONS_PER_ROW).min(table.count() - 2);
            Between { row, fraction: (node - row * DIVISIONS_PER_ROW) as f64 / DIVISIONS_PER_ROW as f64 }
        };
        let curvature = |node: usize| table.curvature(place(node)).abs();
        let length = |node: usize| table.distance(place(node + 1)) - table.distance(place(node));
        let mut square = SVector::<f64, MAX_PLAN_NODES>::zeros();
        for node in 0..nodes {
            let limit = table.speed(place(node));
            square[node] = (limit * limit).min(limits.lateral / curvature(node).max(1e-9));
        }
        // A round that repeats is met by its own end: the second time it is.
        let rounds = if table.repeats() { 2 } else { 1 };
        for _ in 0..rounds {
            for node in 0..nodes - 1 {
                let from = square[node];
                let left = limits.left(from * curvature(node));
                let drive = DRIVE_FRACTION * longitudinal.largest_acceleration(libm::sqrt(from));
                let most = from + 2.0 * length(node) * limits.forward.min(drive).max(0.0) * left;
                square[node + 1] = square[node + 1].min(most);
            }
            if table.repeats() {
                square[0] = square[0].min(square[nodes - 1]);
            }
        }
        for _ in 0..rounds {
            if table.repeats() {
                square[nodes - 1] = square[nodes - 1].min(square[0]);
            }
            for node in (0..nodes - 1).rev() {
                let to = square[node + 1];
                let left = limits.left(to * curvature(node + 1));
                square[node] = square[node].min(to + 2.0 * length(node) * limits.backward * left);
            }
        }
        let mut acceleration = SVector::zeros();
        for node in 0..nodes - 1 {
            acceleration[node] = (square[node + 1] - square[node]) / (2.0 * length(node));
        }
        SpeedPlan { square, acceleration }
    }

    /// Speed \[m/s\] and acceleration \[m/s2\] at a place.
    pub fn at(&self, place: Between) -> (f64, f64) {
        let along = place.fraction * DIVISIONS_PER_ROW as f64;
        let part = (along as usize).min(DIVISIONS_PER_ROW - 1);
        let node = place.row * DIVISIONS_PER_ROW + part;
        let square = self.square[node] + (along - part as f64) * (self.square[node + 1] - self.square[node]);
        (libm::sqrt(square.max(0.0)), self.acceleration[node])
    }
}
