//! Pauses in which a source sends on: a replay, a menu, a bridge that repeats its last packet.
//!
//! Two things tell them from a vehicle. All numbers of its motion stay the same although it moves,
//! or its position stays the same although its speed says otherwise.

use crate::motion::Sample;

/// Time for which all numbers stay the same in a vehicle that moves, from which on it is paused
/// \[s\]; the least of that for a position.
pub const STANDSTILL_TIME: f64 = 0.5;

/// Numbers of the source that stand still, and since when.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Standing {
    last: Option<(f64, Sample)>,
    motion_since: f64,
    position_since: f64,
    position_changes: u32,
    /// Samples that are not the one before of a vehicle that moves.
    changes: u64,
    /// Longest time between two changes of the position of a vehicle that moves \[s\].
    longest_wait: f64,
}

impl Standing {
    /// Takes a sample that arrived then. True while the vehicle is paused.
    pub fn is_paused(&mut self, arrival: f64, sample: &Sample) -> bool {
        // Speed [m/s] and angular velocity [rad/s] from which on a vehicle moves.
        const LEAST_SPEED: f64 = 0.1;
        const LEAST_RATE: f64 = 0.02;
        // Time without a packet after which a position begins anew [s].
        const LONG_GAP: f64 = 0.2;
        let Some((before, last)) = self.last.replace((arrival, *sample)) else {
            (self.motion_since, self.position_since) = (arrival, arrival);
            self.changes += 1;
            return false;
        };
        let changes = sample.motion != last.motion || sample.position != last.position;
        if changes {
            self.motion_since = arrival;
        }
        let moves = sample.motion.speed().abs() > LEAST_SPEED || sample.motion.rates().amax() > LEAST_RATE;
        self.changes += u64::from(changes || !moves);
        let all_stand = moves && arrival - self.motion_since >= STANDSTILL_TIME;
        all_stand | self.position_stands(arrival, arrival - before > LONG_GAP, sample, &last)
    }

    /// Number of samples that are not the one before of a vehicle that moves.
    pub fn changes(&self) -> u64 {
        self.changes
    }

    fn position_stands(&mut self, arrival: f64, is_after_gap: bool, sample: &Sample, last: &Sample) -> bool {
        // Changes of the position after which it counts as measured.
        const POSITION_CHANGES: u32 = 5;
        // A position stands if it does so longer than it ever did between two changes, times this:
        // a receiver of 1 Hz repeats its position for a second.
        const USUAL_WAITS: f64 = 2.5;
        // Speed from which on a position that stands says something [m/s], and the way that the
        // vehicle has gone meanwhile [m], which a coarse position does not show.
        const POSITION_SPEED: f64 = 1.0;
        const POSITION_WAY: f64 = 2.0;
        let speed = sample.motion.speed().abs();
        let waited = arrival - self.position_since;
        let most = STANDSTILL_TIME.max(USUAL_WAITS * self.longest_wait);
        let stands = sample.position.is_some()
            && self.position_changes >= POSITION_CHANGES
            && speed > POSITION_SPEED
            && speed * waited > POSITION_WAY
            && waited >= most;
        let has_moved = sample.position != last.position;
        if has_moved || is_after_gap || speed <= POSITION_SPEED {
            if has_moved {
                let is_usual = !stands && !is_after_gap && speed > POSITION_SPEED;
                self.longest_wait = if is_usual { self.longest_wait.max(waited) } else { self.longest_wait };
                self.position_changes = self.position_changes.saturating_add(1);
            }
            self.position_since = arrival;
            return false;
        }
        stands
    }

    /// All times until now are earlier by this time \[s\].
    pub fn slip(&mut self, time: f64) {
        self.last.iter_mut().for_each(|(arrival, _)| *arrival -= time);
        self.motion_since -= time;
        self.position_since -= time;
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;

    /// A car at 20 m/s whose position is known so often a second.
    fn car(t: f64, position_rate: f64) -> Sample {
        let mut sample = Sample { time: Some(t), ..Sample::default() };
        sample.motion.0[0] = (0.7 * t).sin();
        sample.motion.0[9] = 20.0 + t.cos();
        let x = 20.0 * (t * position_rate + 1e-9).floor() / position_rate;
        sample.position = Some(Vector3::new(x, 0.0, 0.0));
        sample
    }

    /// Times at which it is paused, within 30 s at 100 Hz.
    fn paused(sample: impl Fn(f64) -> Sample) -> Vec<f64> {
        let mut standing = Standing::default();
        let times = (0..3000).map(|k| f64::from(k) * 0.01);
        times.filter(|t| standing.is_paused(7.0 + t, &sample(*t))).collect()
    }

    fn assert_from_to(times: &[f64], from: f64, to: f64) {
        let is_one = times.windows(2).all(|pair| pair[1] - pair[0] < 0.011);
        let [first, last] = [times[0], times[times.len() - 1]];
        assert!(is_one && (first - from).abs() < 0.011 && (last - to).abs() < 0.011, "{first} to {last} s");
    }

    /// The source sends the sample of 10 s on until 20 s, with a clock that stands or runs.
    #[test]
    fn packets_that_stay_the_same_are_a_pause() {
        for clock_runs in [true, false] {
            let times = paused(|t| {
                let sample = car(if t < 20.0 { t.min(10.0) } else { t }, 100.0);
                Sample { time: if clock_runs { Some(t) } else { sample.time }, position: None, ..sample }
            });
            assert_from_to(&times, 10.5, 19.99);
        }
        // A vehicle moves from 0.1 m/s and from 0.02 rad/s on; at rest it does not.
        let still = |k: usize, value: f64| {
            let mut sample = Sample::default();
            sample.motion.0[k] = value;
            paused(|_| sample).len()
        };
        assert_eq!([still(9, 0.09), still(9, -0.09), still(5, 0.019), still(0, 3.0), still(0, 0.0)], [0; 5]);
        assert!([still(9, 0.11), still(9, -0.11), still(5, -0.021)].iter().all(|count| *count > 2900));
        // Nor does one that sends each sample ten times, as a slow simulation.
        assert!(paused(|t| car((10.0 * t).floor() / 10.0, 100.0)).is_empty());
    }

    #[test]
    fn a_position_that_stands_in_a_vehicle_that_drives_is_a_pause() {
        let held = |t: f64| if (10.0..20.0).contains(&t) { car(10.0, 100.0).position } else { car(t, 100.0).position };
        assert_from_to(&paused(|t| Sample { position: held(t), ..car(t, 100.0) }), 10.5, 19.99);
        // Receivers of 1, 5 and 10 Hz, and a source without a position: all zeros.
        for rate in [1.0, 5.0, 10.0] {
            assert!(paused(|t| car(t, rate)).is_empty(), "{rate} Hz");
        }
        assert!(paused(|t| Sample { position: Some(Vector3::zeros()), ..car(t, 100.0) }).is_empty());
        // A position of 1 Hz stands after 2.5 s.
        let coarse = |t: f64| if (10.0..20.0).contains(&t) { car(10.0, 1.0).position } else { car(t, 1.0).position };
        assert_from_to(&paused(|t| Sample { position: coarse(t), ..car(t, 100.0) }), 12.5, 19.99);
        // A car that stops.
        let stops = |t: f64| {
            let mut sample = Sample { position: held(t), ..car(t, 100.0) };
            sample.motion.0[9] *= if (10.0..20.0).contains(&t) { 0.0 } else { 1.0 };
            sample
        };
        assert!(paused(stops).is_empty());
    }
}
