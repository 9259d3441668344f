//! The state vector, and its integration.

use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

use crate::{lateral, rider, suspension};

/// The state of motorcycle and rider, or its time derivative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Position of the rear contact in the world \[m\].
    pub position: Vector2<f64>,
    /// Heading to the left \[rad\].
    pub heading: f64,
    /// Forward speed \[m/s\].
    pub speed: f64,
    /// In the axes of [`crate::lateral`].
    pub lateral: lateral::State,
    pub suspension: suspension::State,
    pub rider: rider::State,
    /// Throttle and brakes after their lags, from 0 to 1.
    pub throttle: f64,
    pub brake: f64,
    /// Place beside the path; all zero without one.
    pub place: PathState,
}

/// Place beside a path: in its own coordinates, positive to the RIGHT as in [`crate::lateral`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PathState {
    /// Distance along the path \[m\].
    pub distance: f64,
    /// Deviation of the rear contact \[m\], and its integral \[m s\].
    pub deviation: f64,
    pub integral: f64,
    /// Heading relative to the path's \[rad\].
    pub heading: f64,
}

/// The state, and the stage on a path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunState {
    pub state: State,
    pub stage: Stage,
    /// True if friction limited a tyre's lateral force in the last internal step.
    pub grip_limited: bool,
}

/// Stage on a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stage {
    /// On the path, or without one.
    Riding,
    /// The motorcycle has left the path.
    OffPath,
    Fallen,
}

impl State {
    /// The state plus `factor` times a derivative.
    pub fn plus(&self, derivative: &State, factor: f64) -> State {
        let mut sum = *self;
        sum.position += derivative.position * factor;
        sum.heading += factor * derivative.heading;
        sum.speed += factor * derivative.speed;
        sum.lateral += derivative.lateral * factor;
        sum.suspension.position += derivative.suspension.position * factor;
        sum.suspension.velocity += derivative.suspension.velocity * factor;
        sum.rider.lean += factor * derivative.rider.lean;
        sum.rider.lean_rate += factor * derivative.rider.lean_rate;
        sum.rider.error += factor * derivative.rider.error;
        sum.rider.torso += factor * derivative.rider.torso;
        sum.rider.torso_rate += factor * derivative.rider.torso_rate;
        sum.throttle += factor * derivative.throttle;
        sum.brake += factor * derivative.brake;
        sum.place.distance += factor * derivative.place.distance;
        sum.place.deviation += factor * derivative.place.deviation;
        sum.place.integral += factor * derivative.place.integral;
        sum.place.heading += factor * derivative.place.heading;
        sum
    }

    /// The state with values below the threshold set to zero, so that the motorcycle comes to rest
    /// in finite time.
    pub fn flush_small(mut self) -> State {
        // Angles, lengths, forces and their rates below this count as zero, in SI units.
        const NEGLIGIBLE_MOTION: f64 = 1e-12;
        let flush = |value: &mut f64| {
            if value.abs() < NEGLIGIBLE_MOTION {
                *value = 0.0;
            }
        };
        self.lateral.iter_mut().for_each(flush);
        self.suspension.position.iter_mut().chain(self.suspension.velocity.iter_mut()).for_each(flush);
        let rider = &mut self.rider;
        [&mut rider.lean, &mut rider.lean_rate, &mut rider.error, &mut rider.torso, &mut rider.torso_rate]
            .into_iter()
            .chain([&mut self.throttle, &mut self.brake])
            .for_each(flush);
        self
    }
}
