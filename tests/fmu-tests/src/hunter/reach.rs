//! Distance of a sample from the limits of legs and axes.

use super::oracle::{MachineLimits, Safety, Sample};

/// The part of the limits that a sample leaves unused. Legs and axes count alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// The smallest distance from an end, as a fraction of half the range.
    pub room: f64,
    /// The largest speed, as a fraction of its limit.
    pub speed: f64,
    /// The largest part of the room ahead that a stop at the limit of acceleration takes.
    pub stop: f64,
}

impl Reach {
    /// Of a sample on this machine within these limits.
    pub fn of(sample: &Sample, machine: &MachineLimits, safety: &Safety) -> Self {
        let mut reach = Reach { room: f64::INFINITY, speed: 0.0, stop: 0.0 };
        let [shortest, longest] = machine.stroke;
        for (length, velocity) in sample.length.iter().zip(sample.leg_velocity) {
            reach.include([length - shortest, longest - length], velocity, machine.velocity, machine.acceleration);
        }
        for k in 0..3 {
            let (position, limit) = (sample.position[k], safety.position[k]);
            let ends = [position + limit, limit - position];
            reach.include(ends, sample.velocity[k], safety.velocity[k], safety.acceleration[k]);
        }
        reach
    }

    /// Includes a leg or an axis with its distances from both ends, its velocity and its limits.
    fn include(&mut self, [below, above]: [f64; 2], velocity: f64, fastest: f64, hardest: f64) {
        const LEAST_ROOM: f64 = 1e-9;
        self.room = self.room.min(2.0 * below.min(above) / (below + above));
        self.speed = self.speed.max(velocity.abs() / fastest);
        let ahead = if velocity > 0.0 { above } else { below };
        self.stop = self.stop.max(0.5 * velocity * velocity / hardest / ahead.max(LEAST_ROOM));
    }
}
