//! The dead time of the commands.

use serde::{Deserialize, Serialize};

/// The six commands over a stretch of time, linear from one end to the other \[m\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ramp {
    /// Duration \[s\].
    pub duration: f64,
    pub from: [f64; 6],
    pub to: [f64; 6],
}

/// Capacity of the queue, in ramps.
const QUEUE_CAPACITY: usize = 32;

/// A queue of ramps whose durations add up to the dead time.
///
/// Two neighbours that together last less than about a fourteenth of the dead time are joined;
/// longer ones leave the queue exactly as they entered it. There is no clock, so nothing drifts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DelayLine {
    ramps: [Ramp; QUEUE_CAPACITY],
    first: usize,
    count: usize,
    /// Two neighbours that last no longer than this together are joined \[s\].
    finest: f64,
}

impl DelayLine {
    /// A dead time \[s\], during which the commands were these.
    pub fn new(dead_time: f64, commands: &[f64; 6]) -> Self {
        let constant = Ramp { duration: dead_time, from: *commands, to: *commands };
        let finest = 2.0 * dead_time / (QUEUE_CAPACITY - 4) as f64;
        DelayLine { ramps: [constant; QUEUE_CAPACITY], first: 0, count: usize::from(dead_time > 0.0), finest }
    }

    /// Changes the dead time \[s\]. A straight line to the newest command replaces the pending
    /// commands, so that the output does not jump. With a dead time of 0 the newest command is the
    /// output at once.
    pub fn set_dead_time(&mut self, dead_time: f64) {
        let newest = self.ramps[(self.first + self.count + QUEUE_CAPACITY - 1) % QUEUE_CAPACITY].to;
        let next = if self.count > 0 { self.ramps[self.first % QUEUE_CAPACITY].from } else { newest };
        *self = DelayLine::new(dead_time, &newest);
        self.ramps[0].from = next;
    }

    /// Appends the next command.
    pub fn push(&mut self, ramp: &Ramp) {
        if self.count > 0 {
            let last = &mut self.ramps[(self.first + self.count - 1) % QUEUE_CAPACITY];
            if last.duration + ramp.duration <= self.finest || self.count >= QUEUE_CAPACITY {
                last.duration += ramp.duration;
                last.to = ramp.to;
                return;
            }
        }
        self.ramps[(self.first + self.count) % QUEUE_CAPACITY] = *ramp;
        self.count += 1;
    }

    /// Removes the next command that arrives: linear, and at most `longest` \[s\] but for rounding.
    ///
    /// An empty queue repeats the last command.
    pub fn pop(&mut self, longest: f64) -> Ramp {
        /// Relative remainder of a ramp that leaves with it.
        const ROUNDING: f64 = 1e-9;
        if self.count == 0 {
            let last = self.ramps[(self.first + QUEUE_CAPACITY - 1) % QUEUE_CAPACITY].to;
            return Ramp { duration: longest, from: last, to: last };
        }
        let head = &mut self.ramps[self.first % QUEUE_CAPACITY];
        if head.duration <= longest * (1.0 + ROUNDING) {
            self.first = (self.first + 1) % QUEUE_CAPACITY;
            self.count -= 1;
            return *head;
        }
        let t = longest / head.duration;
        let between = std::array::from_fn(|i| head.from[i] + t * (head.to[i] - head.from[i]));
        let taken = Ramp { duration: longest, from: head.from, to: between };
        head.from = between;
        head.duration -= longest;
        taken
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Puts in ramps of `u` at steps of `step`, and takes them out again at once, in parts of
    /// `part`.
    fn delayed(dead_time: f64, step: f64, part: f64, stop: f64, u: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let mut line = DelayLine::new(dead_time, &[u(0.0); 6]);
        let (mut arrived, mut time) = (Vec::new(), 0.0);
        for k in 0..(stop / step).round() as usize {
            let (begin, end) = (k as f64 * step, (k + 1) as f64 * step);
            line.push(&Ramp { duration: step, from: [u(begin); 6], to: [u(end); 6] });
            let mut left = step;
            while left > 1e-12 {
                let ramp = line.pop(left.min(part));
                assert!(ramp.duration > 0.0 && ramp.duration <= part * (1.0 + 1e-8));
                left -= ramp.duration;
                time += ramp.duration;
                arrived.push((time, ramp.to[3]));
            }
        }
        arrived
    }

    #[test]
    fn what_goes_in_comes_out_after_the_dead_time() {
        // Linear between points that are communication points in every case.
        let u = |t: f64| if t < 0.02 { 1.0 } else { (1.0 + 3.0 * (t - 0.02)).min(1.12) };
        for (dead_time, step, part) in [
            (0.004, 0.001, 0.001),
            (0.0035, 0.001, 0.001),
            (0.0, 0.001, 0.0004),
            (0.05, 0.01, 0.001),
            (0.004, 0.02, 0.001),
        ] {
            for (time, value) in delayed(dead_time, step, part, 0.2, u) {
                let expected = u((time - dead_time).max(0.0));
                assert!((value - expected).abs() < 1e-12, "{dead_time} {step}: at {time} {value}, not {expected}");
            }
        }
    }

    /// The command rises at 1 m/s; the dead time changes at 0.05 s.
    #[test]
    fn another_dead_time_makes_no_jump_and_holds_from_then_on() {
        for (before, after) in [(0.004, 0.02), (0.02, 0.004), (0.0, 0.01), (0.01, 0.01), (0.004, 1e-9)] {
            let step = 0.001;
            let mut line = DelayLine::new(before, &[0.0; 6]);
            let (mut arrived, mut end) = (0.0, 0.0);
            for k in 0..200 {
                if k == 50 {
                    line.set_dead_time(after);
                }
                let (from, to) = (step * f64::from(k), step * f64::from(k + 1));
                line.push(&Ramp { duration: step, from: [from; 6], to: [to; 6] });
                let mut left = step;
                while left > 1e-12 {
                    let ramp = line.pop(left.min(step));
                    assert!((ramp.from[0] - end).abs() < 1e-12, "{before} to {after}: a jump at step {k}");
                    (end, left) = (ramp.to[0], left - ramp.duration);
                }
                arrived = end;
            }
            assert!((arrived - (0.2 - after)).abs() < 1e-9, "{before} to {after}: {arrived}");
        }
    }

    /// Delayed commands arrive at once when the dead time becomes zero; the drives smooth the jump.
    #[test]
    fn without_a_dead_time_the_last_command_arrives_at_once() {
        let mut line = DelayLine::new(0.01, &[0.0; 6]);
        line.push(&Ramp { duration: 0.001, from: [0.0; 6], to: [1.0; 6] });
        line.pop(0.001);
        line.set_dead_time(0.0);
        line.push(&Ramp { duration: 0.001, from: [1.0; 6], to: [2.0; 6] });
        assert_eq!(line.pop(0.001), Ramp { duration: 0.001, from: [1.0; 6], to: [2.0; 6] });
        assert_eq!(line.pop(0.001).from, [2.0; 6]);
    }

    #[test]
    fn many_short_steps_are_joined_and_nothing_is_lost() {
        let u = |t: f64| 1.0 + 0.1 * (20.0 * t).sin();
        for (time, value) in delayed(0.1, 1e-5, 1e-3, 0.3, u) {
            assert!((value - u((time - 0.1).max(0.0))).abs() < 40.0 * 0.0075_f64.powi(2));
        }
    }
}
