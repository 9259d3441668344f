//! Ticks of equal length from samples of any rate.

use serde::{Deserialize, Serialize};

/// Length of a tick \[s\].
pub const TICK: f64 = 0.05;

/// The vehicle at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Time since the sample before \[s\].
    pub step: f64,
    /// Position in any fixed axes; 0 where there is no third \[m\].
    pub position: [f64; 3],
    /// Speed, if it is known \[m/s\].
    pub speed: Option<f64>,
    /// Specific force along the head's x and y \[m/s2\].
    pub force: [f64; 2],
}

/// The samples as ticks: a sample at the end of each, with the mean force. Between samples they are
/// linear.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ticks {
    last: Option<Sample>,
    /// Speed by the positions \[m/s\].
    speed: f64,
    /// Time since the last tick, and the force's integral over it.
    time: f64,
    integral: [f64; 2],
}

impl Ticks {
    /// Time since the last tick \[s\].
    pub fn since(&self) -> f64 {
        self.time
    }

    /// Takes a sample, and calls `tick` at the end of each tick. False where the sample
    /// does not continue those before: after a gap, a jump or a value that is not a number.
    pub fn push(&mut self, sample: &Sample, mut tick: impl FnMut(&Sample)) -> bool {
        // A longer step is a gap in the samples [s].
        const LONGEST_STEP: f64 = 0.5;
        // Displacement within a step that no vehicle has: this, and so many times that of its speed
        // [m].
        const TELEPORT_DISTANCE: f64 = 15.0;
        const JUMP_FACTOR: f64 = 3.0;
        // Time constant of the speed that a displacement is compared with [s].
        const SPEED_TIME: f64 = 0.5;
        // A difference of times below this is rounding [s].
        const TIME_ROUNDING: f64 = 1e-9;
        let numbers = sample.position.iter().chain(&sample.force).chain(&sample.speed).chain([&sample.step]);
        if !numbers.into_iter().all(|number| number.is_finite()) {
            *self = Ticks::default();
            return false;
        }
        let Some(last) = self.last.replace(*sample).filter(|_| sample.step <= LONGEST_STEP) else {
            *self = Ticks { last: Some(*sample), ..Ticks::default() };
            return false;
        };
        if sample.step <= 0.0 {
            return true;
        }
        let displacement = distance(&last.position, &sample.position);
        if displacement > TELEPORT_DISTANCE + JUMP_FACTOR * self.speed * sample.step {
            *self = Ticks { last: Some(*sample), ..Ticks::default() };
            return false;
        }
        self.speed += (displacement / sample.step - self.speed) * (sample.step / SPEED_TIME).min(1.0);
        let at = |fraction: f64| Sample {
            step: TICK,
            position: between(&last.position, &sample.position, fraction),
            speed: last.speed.zip(sample.speed).map(|(from, to)| from + fraction * (to - from)),
            force: between(&last.force, &sample.force, fraction),
        };
        let (mut done, mut from) = (0.0, last.force);
        loop {
            let left = TICK - self.time;
            let is_whole = done + left <= sample.step + TIME_ROUNDING;
            let end = if is_whole { (done + left).min(sample.step) } else { sample.step };
            let now = at(end / sample.step);
            for (integral, (from, now)) in self.integral.iter_mut().zip(from.iter().zip(&now.force)) {
                *integral += 0.5 * (from + now) * (end - done);
            }
            self.time += end - done;
            if !is_whole {
                return true;
            }
            tick(&Sample { force: self.integral.map(|integral| integral / TICK), ..now });
            (self.time, self.integral) = (0.0, [0.0; 2]);
            (done, from) = (end, now.force);
        }
    }
}

/// Distance of two positions.
pub fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    libm::sqrt((0..3).map(|k| (b[k] - a[k]) * (b[k] - a[k])).sum())
}

fn between<const N: usize>(from: &[f64; N], to: &[f64; N], fraction: f64) -> [f64; N] {
    core::array::from_fn(|k| from[k] + fraction * (to[k] - from[k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(time: f64) -> Sample {
        Sample { step: 0.0, position: [3.0 * time, time, 0.0], speed: Some(2.0 * time), force: [time, -4.0 * time] }
    }

    #[test]
    fn ticks_are_equal_at_any_rate() {
        for step in [0.001, 0.012, 0.02, 0.05, 0.13] {
            let mut ticks = Ticks::default();
            let mut made = Vec::new();
            let count = (3.0 / step) as usize;
            for k in 0..count {
                ticks.push(&Sample { step, ..at(k as f64 * step) }, |tick| made.push(*tick));
            }
            assert_eq!(made.len(), ((count - 1) as f64 * step / TICK + 1e-6) as usize);
            for (k, tick) in made.iter().enumerate() {
                let end = (k + 1) as f64 * TICK;
                let expected =
                    Sample { step: TICK, force: at(end - 0.5 * TICK).force, position: at(end).position, speed: None };
                assert!((tick.speed.unwrap() - 2.0 * end).abs() < 1e-6);
                let pairs =
                    tick.position.iter().chain(&tick.force).zip(expected.position.iter().chain(&expected.force));
                assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-6), "{tick:?} {expected:?}");
            }
        }
    }

    #[test]
    fn a_gap_a_jump_and_what_is_no_number_begin_anew() {
        let mut ticks = Ticks::default();
        let mut push = |step: f64, x: f64, force: f64| {
            ticks.push(&Sample { step, position: [x, 0.0, 0.0], speed: None, force: [force, 0.0] }, |_| ())
        };
        assert!(!push(0.02, 0.0, 0.0));
        assert!(push(0.02, 0.5, 0.0));
        assert!(!push(0.6, 15.0, 0.0), "a gap");
        assert!(push(0.02, 15.5, 0.0));
        assert!(!push(0.02, 40.0, 0.0), "a jump");
        assert!(push(0.0, 40.0, 0.0));
        assert!(!push(0.02, 40.5, f64::NAN));
        assert!(!push(0.02, 41.0, 0.0));
        assert!(push(0.02, 41.5, 0.0));
    }
}
