//! The course in the plane: the centre of the road, for drawing, and places beside it.

use moris_motorcycle::path::follower::Follower;
use serde::Serialize;

/// Position and heading in the plane, in m and rad, positive to the left.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlanePose {
    pub x: f64,
    pub y: f64,
    pub yaw: f64,
}

impl PlanePose {
    /// The pose moved ahead and to the left, and turned to the left.
    pub fn moved(self, ahead: f64, left: f64, turned: f64) -> PlanePose {
        let (sin, cos) = self.yaw.sin_cos();
        PlanePose { x: self.x + ahead * cos - left * sin, y: self.y + ahead * sin + left * cos, yaw: self.yaw + turned }
    }
}

/// The road, for drawing.
#[derive(Clone, Debug, Serialize)]
pub struct RoadMap {
    /// Points of the centre: x, y, heading, and the speed that a rider plans there.
    pub points: Vec<[f64; 4]>,
    /// Half of the width \[m\].
    pub half_width: f64,
}

/// Place of the motorcycle on the road, for drawing, in m, rad and m/s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct RoadPlace {
    pub x: f64,
    pub y: f64,
    pub yaw: f64,
    /// Distance along the centre.
    pub distance: f64,
    pub steer: f64,
    /// Speed that a rider plans there.
    pub advised: f64,
}

/// The closed course of the ride, sampled along its centre line.
#[derive(Clone, Debug)]
pub struct Circuit {
    length: f64,
    centre: Vec<PlanePose>,
    /// Speed that a rider plans at each point \[m/s\].
    advised: Vec<f64>,
}

impl Circuit {
    /// The course of a rider on a path.
    pub fn new(follower: &Follower) -> Circuit {
        // Distance between two points of the centre [m].
        const SPACING: f64 = 2.0;
        // Parts in which the heading between two points is integrated.
        const HEADING_SUBDIVISIONS: usize = 8;
        let table = follower.table();
        let length = table.length();
        let count = (length / SPACING).round() as usize;
        let spacing = length / count as f64;
        let part = spacing / HEADING_SUBDIVISIONS as f64;
        let mut centre = vec![PlanePose::default()];
        for k in 0..count * HEADING_SUBDIVISIONS {
            let here = centre[centre.len() - 1];
            // Of the model, positive to the right.
            let turn = -table.curvature_at((k as f64 + 0.5) * part) * part;
            let next = here.moved(0.0, 0.0, 0.5 * turn).moved(part, 0.0, 0.5 * turn);
            if k % HEADING_SUBDIVISIONS == 0 {
                centre.push(next);
            } else {
                let last = centre.len() - 1;
                centre[last] = next;
            }
        }
        let advised = (0..=count).map(|k| follower.planned_speed(k as f64 * spacing)).collect();
        Circuit { length, centre, advised }
    }

    /// Length of a lap \[m\].
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The points of the centre, the last at the place of the first, and the advised speeds there.
    pub fn points(&self) -> impl Iterator<Item = (&PlanePose, f64)> {
        self.centre.iter().zip(self.advised.iter().copied())
    }

    /// The road, so wide on each side of the centre.
    pub fn map(&self, half_width: f64) -> RoadMap {
        RoadMap { points: self.points().map(|(at, advised)| [at.x, at.y, at.yaw, advised]).collect(), half_width }
    }

    /// The place of a motorcycle at a distance along the centre, so far to the left of it and
    /// turned to the left. Headings count all laps.
    pub fn at(&self, distance: f64, left: f64, turned: f64) -> PlanePose {
        let laps = (distance / self.length).floor();
        let last = self.centre.len() - 1;
        let along = (distance / self.length - laps) * last as f64;
        let row = (along as usize).min(last - 1);
        let (from, to) = (&self.centre[row], &self.centre[row + 1]);
        let t = along - row as f64;
        let between = |from: f64, to: f64| from + t * (to - from);
        let yaw = between(from.yaw, to.yaw) + laps * self.centre[last].yaw;
        PlanePose { x: between(from.x, to.x), y: between(from.y, to.y), yaw }.moved(0.0, left, turned)
    }
}
