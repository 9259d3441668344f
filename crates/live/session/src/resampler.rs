//! Irregular samples at the times of the steps: linear between them, with a delay.
//!
//! The delay must be as long as the time from a sample to the arrival of the next. Where it is not,
//! the last sample is held until the next one arrives.

use std::collections::VecDeque;

use crate::attitude::{between, nearest_angles};
use crate::gaps::Gaps;
use crate::motion::{ANGLE_CHANNELS, Channels, Motion};
use nalgebra::Vector3;

/// Samples that are kept: 0.6 s at 400 Hz.
const SAMPLE_CAPACITY: usize = 256;
/// Longest delay \[s\].
pub const MAX_DELAY: f64 = 0.25;
/// Delay from which on the operator is warned \[s\].
pub const WARNED_DELAY: f64 = 0.06;

/// The samples of the last moments.
#[derive(Clone, Debug)]
pub struct Resampler {
    /// The newest first.
    samples: VecDeque<Stamped>,
    /// Samples whose time has not been reached: those that [`Resampler::reached`] has not given.
    ahead: usize,
    /// Arrival of the newest \[s\].
    arrival: f64,
    gaps: Gaps,
}

/// A sample with its time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stamped {
    /// Time \[s\].
    pub time: f64,
    /// Motion.
    pub motion: Motion,
    /// Place in the world, if it is known \[m\].
    pub position: Option<Vector3<f64>>,
}

/// The motion at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct At {
    /// Motion at the asked time.
    pub motion: Motion,
    /// Slope of each channel of the motion there.
    pub slope: Channels,
    /// Time of the sample from which on nothing is known, if that is past: it is held \[s\].
    pub held_from: Option<f64>,
}

impl Default for Resampler {
    fn default() -> Self {
        let samples = VecDeque::with_capacity(SAMPLE_CAPACITY);
        Resampler { samples, ahead: 0, arrival: 0.0, gaps: Gaps::default() }
    }
}

impl Resampler {
    /// Adds a sample of this time, later than the last one's.
    pub fn push(&mut self, arrival: f64, time: f64, motion: Motion, position: Option<Vector3<f64>>) {
        // Packets that arrive within this time after another came with it [s].
        const BURST_TIME: f64 = 1e-3;
        let motion = self.continued(motion);
        let passed = arrival - self.arrival;
        if let Some(newest) = self.samples.front().filter(|_| passed >= BURST_TIME) {
            self.gaps.take(arrival - newest.time, passed);
        }
        self.arrival = arrival;
        self.samples.truncate(SAMPLE_CAPACITY - 1);
        self.samples.push_front(Stamped { time, motion, position });
        self.ahead = (self.ahead + 1).min(SAMPLE_CAPACITY);
    }

    /// Puts a motion in the place of the newest sample's.
    pub fn replace(&mut self, motion: Motion) {
        let motion = self.continued(motion);
        self.samples.front_mut().into_iter().for_each(|newest| newest.motion = motion);
    }

    /// The motion with the description of its attitude that is nearest to the newest sample's: an
    /// attitude has two, and each angle any number of turns.
    fn continued(&self, mut motion: Motion) -> Motion {
        if let Some(newest) = self.samples.front() {
            motion.set_angles(nearest_angles(&motion.angles(), &newest.motion.angles()));
        }
        motion
    }

    /// All times until now are earlier by this time \[s\].
    pub fn slip(&mut self, time: f64) {
        self.arrival -= time;
        self.samples.iter_mut().for_each(|sample| sample.time -= time);
    }

    /// Forgets all samples: the next one has nothing to do with them.
    pub fn clear(&mut self) {
        self.samples.clear();
        self.ahead = 0;
    }

    /// The next sample whose time is now past \[s\]; each is given once.
    pub fn reached(&mut self, time: f64) -> Option<Stamped> {
        let next = self.samples[self.ahead.checked_sub(1)?];
        (next.time <= time).then(|| {
            self.ahead -= 1;
            next
        })
    }

    /// The delay with which this part of the samples of late would not have come too late \[s\].
    pub fn delay(&self, part: f64) -> f64 {
        self.gaps.delay(part)
    }

    /// The motion at a time; none without a sample.
    pub fn at(&self, time: f64) -> Option<At> {
        // A change of an angle within a sample that may be one of its description alone [rad].
        const MAX_ANGLE_CHANGE: f64 = 0.5;
        let mut after = self.samples.front()?;
        let still = |motion: Motion, held_from| At { motion, slope: Channels::zeros(), held_from };
        if time >= after.time {
            return Some(still(after.motion, Some(after.time)));
        }
        for before in self.samples.iter().skip(1) {
            if before.time <= time {
                let slope = (after.motion.0 - before.motion.0) / (after.time - before.time);
                let mut motion = Motion(before.motion.0 + slope * (time - before.time));
                if ANGLE_CHANNELS.take(3).any(|k| (after.motion.0[k] - before.motion.0[k]).abs() > MAX_ANGLE_CHANGE) {
                    let part = (time - before.time) / (after.time - before.time);
                    motion.set_angles(between(&before.motion.angles(), &after.motion.angles(), part));
                }
                return Some(At { motion, slope, held_from: None });
            }
            after = before;
        }
        Some(still(after.motion, None))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surge(value: f64) -> Motion {
        let mut motion = Motion::at_rest();
        motion.0[0] = value;
        motion
    }

    #[test]
    fn irregular_samples_of_a_line_are_that_line_with_the_delay() {
        for rate in [20.0, 60.0, 100.0, 400.0] {
            let mut resampler = Resampler::default();
            let (mut next, mut sent) = (0.0, 0);
            for k in 0..8_000 {
                let now = f64::from(k) * 1e-3;
                while next <= now {
                    resampler.push(now, next, surge(0.5 * next), None);
                    sent += 1;
                    // Every third interval is half as long again.
                    next += if sent % 3 == 0 { 1.5 } else { 0.75 } / rate;
                }
                if now > 2.0 {
                    let delay = resampler.delay(1.0);
                    let at = resampler.at(now - delay).unwrap();
                    assert!((at.motion.0[0] - 0.5 * (now - delay)).abs() < 1e-9 && at.held_from.is_none(), "{rate} Hz");
                    assert!((at.slope[0] - 0.5).abs() < 1e-9);
                    assert!(delay <= 1.7 / rate + 2.5e-3, "{rate} Hz: {delay} s");
                }
            }
        }
    }

    #[test]
    fn what_does_not_come_is_held() {
        let mut resampler = Resampler::default();
        assert!(resampler.at(0.0).is_none());
        resampler.push(1.0, 1.0, surge(1.0), None);
        assert_eq!(resampler.at(0.5).unwrap().motion, surge(1.0));
        resampler.push(1.1, 1.1, surge(2.0), None);
        let held = resampler.at(1.3).unwrap();
        assert_eq!((held.motion, held.held_from), (surge(2.0), Some(1.1)));
        assert_eq!(held.slope, Channels::zeros());
    }

    #[test]
    fn each_sample_is_reached_once_and_in_order() {
        let mut resampler = Resampler::default();
        assert_eq!(resampler.reached(1.0), None);
        for k in 1..=3 {
            resampler.push(0.1 * f64::from(k), 0.1 * f64::from(k), surge(f64::from(k)), Some(Vector3::x()));
        }
        let mut reached = |time| resampler.reached(time).map(|sample| sample.motion.0[0]);
        assert_eq!(
            [0.05, 0.25, 0.25, 0.25, 0.5, 0.5].map(&mut reached),
            [None, Some(1.0), Some(2.0), None, Some(3.0), None]
        );
        resampler.push(0.6, 0.6, surge(4.0), None);
        resampler.clear();
        assert_eq!(resampler.reached(1.0), None);
    }

    #[test]
    fn an_angle_goes_on_through_half_a_turn() {
        let turned = |yaw: f64| {
            let mut motion = Motion::at_rest();
            motion.0[8] = yaw;
            motion
        };
        let mut resampler = Resampler::default();
        resampler.push(0.0, 0.0, turned(3.1), None);
        resampler.push(0.1, 0.1, turned(-3.1), None);
        let middle = resampler.at(0.05).unwrap();
        assert!((middle.motion.0[8] - std::f64::consts::PI).abs() < 1e-9 && middle.slope[8] < 1.0);
    }
}
