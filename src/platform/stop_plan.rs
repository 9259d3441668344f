//! The stop plan: a trajectory to rest, as data.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::PlatformCoordinates;
use crate::motion::Motion;
use crate::motion::min_max::max;

/// A trajectory of the platform from a moving state to rest, and the time already spent on it.
///
/// Coordinate k decelerates steadily from its velocity u to zero in its duration T: its position
/// is q + u (t - t²/(2 T)), and from t = T on it rests. Any part of the trajectory that is left
/// is a stop plan again.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StopPlan {
    start: PlatformCoordinates,
    durations: StopDurations,
    elapsed: f64,
}

/// Durations of the stops of surge, sway and heave, and the common one of roll, pitch and yaw
/// \[s\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StopDurations {
    pub linear: Vector3<f64>,
    pub angular: f64,
}

impl StopDurations {
    /// The same duration for all coordinates: the platform stays on a straight path in coordinates.
    pub fn common(duration: f64) -> Self {
        StopDurations { linear: Vector3::repeat(duration), angular: duration }
    }

    /// The instants at which the acceleration of a coordinate changes, in ascending order \[s\].
    pub fn breakpoints(&self) -> [f64; 4] {
        let mut stops = [self.linear.x, self.linear.y, self.linear.z, self.angular];
        stops.sort_by(f64::total_cmp);
        stops
    }
}

impl StopPlan {
    /// The stop from a state in these durations.
    #[inline(always)]
    pub fn new(start: &PlatformCoordinates, durations: StopDurations) -> Self {
        StopPlan { start: *start, durations, elapsed: 0.0 }
    }

    /// The state from which the plan starts.
    pub fn start(&self) -> &PlatformCoordinates {
        &self.start
    }

    /// Durations of the whole plan.
    pub fn durations(&self) -> &StopDurations {
        &self.durations
    }

    /// The plan after `step` seconds of it.
    pub fn advanced(&self, step: f64) -> Self {
        let [.., last] = self.durations.breakpoints();
        StopPlan { elapsed: (self.elapsed + step).min(max(last, self.elapsed)), ..*self }
    }

    /// Times from now until surge, sway and heave are no faster than these limits \[m/s\], zero
    /// where they are so already \[s\].
    pub fn times_until_within(&self, limits: &Vector3<f64>) -> [f64; 3] {
        let StopPlan { start, durations, elapsed } = self;
        core::array::from_fn(|k| {
            // On an axis that rests from the start the product is NaN; its time is then zero.
            let end = durations.linear[k] * (1.0 - limits[k] / start.linear.velocity[k].abs());
            max(end - elapsed, 0.0)
        })
    }

    /// The coordinates at the time that the plan has reached.
    pub fn coordinates(&self) -> PlatformCoordinates {
        self.at(self.elapsed)
    }

    /// The state `time` seconds after the plan's start; accelerations are those that follow.
    pub fn at(&self, time: f64) -> PlatformCoordinates {
        let StopPlan { start, durations, .. } = self;
        PlatformCoordinates {
            linear: Motion::from_axes(|k| motion_while_stopping(&start.linear.axis(k), durations.linear[k], time)),
            angles: Motion::from_axes(|k| motion_while_stopping(&start.angles.axis(k), durations.angular, time)),
        }
    }
}

/// One coordinate `time` seconds after it began to stop in `duration`.
fn motion_while_stopping(start: &Motion, duration: f64, time: f64) -> Motion {
    let Motion { position, velocity, .. } = *start;
    if time >= duration {
        return Motion::at_rest(position + 0.5 * velocity * duration);
    }
    Motion {
        position: position + velocity * (time - 0.5 * time * time / duration),
        velocity: velocity * (1.0 - time / duration),
        acceleration: -velocity / duration,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn velocities_and_accelerations_are_the_derivatives_of_positions() {
        let start = PlatformCoordinates {
            linear: Motion {
                position: Vector3::new(0.1, -0.2, 0.05),
                velocity: Vector3::new(0.8, -0.3, 0.0),
                ..Motion::default()
            },
            angles: Motion { velocity: Vector3::new(0.2, -0.1, 0.4), ..Motion::default() },
        };
        let plan = StopPlan::new(&start, StopDurations { linear: Vector3::new(0.5, 0.3, 0.2), angular: 0.4 });
        assert_eq!(plan.at(0.0).linear.velocity, start.linear.velocity);
        assert_eq!(plan.at(1.0).angles.velocity, Vector3::zeros());
        let near = |found: Vector3<f64>, expected: Vector3<f64>| assert!((found - expected).amax() < 1e-8, "{found}");
        let h = 1e-4;
        for time in [0.05, 0.15, 0.25, 0.35, 0.45, 0.6] {
            let [before, now, after] = [time - h, time, time + h].map(|time| plan.at(time));
            for (before, now, after) in
                [(before.linear, now.linear, after.linear), (before.angles, now.angles, after.angles)]
            {
                near(now.velocity, (after.position - before.position) / (2.0 * h));
                near(now.acceleration, (after.velocity - before.velocity) / (2.0 * h));
            }
        }
    }

    #[test]
    fn a_plan_keeps_limits_of_velocity_from_its_times_on() {
        let start = PlatformCoordinates {
            linear: Motion { velocity: Vector3::new(0.8, -0.4, 0.0), ..Motion::default() },
            ..PlatformCoordinates::default()
        };
        let plan = StopPlan::new(&start, StopDurations { linear: Vector3::new(0.2, 0.4, 0.0), angular: 0.4 });
        for (limits, expected) in [
            ([0.2, 0.1, 0.01], [0.15, 0.3, 0.0]),
            ([1.0, 0.3, 0.01], [0.0, 0.1, 0.0]),
            ([0.8, 0.4, 0.0], [0.0, 0.0, 0.0]),
        ] {
            let close = |plan: StopPlan, expected: [f64; 3]| {
                let times = plan.times_until_within(&Vector3::from(limits));
                assert!((Vector3::from(times) - Vector3::from(expected)).amax() < 1e-15, "{times:?}, not {expected:?}");
            };
            close(plan, expected);
            close(plan.advanced(0.12), expected.map(|time| (time - 0.12).max(0.0)));
        }
    }
}
