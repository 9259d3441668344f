//! Frames as they leave: the actuators' change from one frame to the next stays within their speed.
//!
//! The loop's commands change within the limits from step to step. Frames may be left out or
//! delayed on their way, so that the next one is far from the last that left. Then the difference
//! goes to zero: a glide, whose speed comes on top of the commands' own. Actuators that have come
//! to rest are taken from there to the commands, so that no glide leaves the stroke.

use std::time::Duration;

use moris_live::frame::Values;

/// Change between two frames, in terms of the largest speed, from which on a frame begins a glide.
const LARGEST: f64 = 1.15;
/// Speed of a glide in terms of the actuators' largest.
const GLIDE_SPEED: f64 = 0.1;
/// Speed of a glide to a controller that was lost \[m/s\].
const LOST_SPEED: f64 = 0.05;
/// Largest slope of the glide's profile, and its shortest time \[s\].
const STEEPEST: f64 = 1.5;
const SHORTEST: f64 = 0.2;

/// Numbers of a frame that a glide changes.
const NUMBERS: usize = 17;

/// Limits of the actuators.
#[derive(Clone, Copy, Debug)]
pub struct Actuators {
    /// Largest speed \[m/s\].
    pub speed: f64,
    /// Shortest and longest length \[m\].
    pub stroke: [f64; 2],
}

/// The way of frames to the controller.
#[derive(Clone, Debug)]
pub struct Wire {
    /// Time between frames \[s\].
    interval: f64,
    actuators: Actuators,
    last: Option<(Duration, Values)>,
    glide: Option<Glide>,
    /// The actuators have stopped since the last frame.
    is_lost: bool,
}

#[derive(Clone, Copy, Debug)]
struct Glide {
    /// What the last frame had beyond the commands at the beginning.
    difference: [f64; NUMBERS],
    /// The last frame, if the actuators have come to rest there.
    rest: Option<[f64; NUMBERS]>,
    /// Its beginning in the session's time, and its length \[s\].
    begin: f64,
    duration: f64,
}

impl Glide {
    /// The part of the difference that is left.
    fn left(&self, time: f64) -> f64 {
        let part = ((time - self.begin) / self.duration).clamp(0.0, 1.0);
        1.0 - part * part * (3.0 - 2.0 * part)
    }
}

impl Wire {
    /// A way with frames at this interval \[s\] to these actuators.
    pub fn new(interval: f64, actuators: Actuators) -> Self {
        Wire { interval, actuators, last: None, glide: None, is_lost: false }
    }

    /// The actuators are where the next frame has them, as a person or the controller says: it has
    /// nothing to do with the last one.
    pub fn begin_anew(&mut self) {
        (self.last, self.glide, self.is_lost) = (None, None, false);
    }

    /// The controller does not receive frames, or has stopped by itself: its actuators come to rest
    /// where they are.
    pub fn lose(&mut self) {
        self.is_lost = true;
    }

    /// Time since the last frame, until now.
    pub fn gap(&self, now: Duration) -> Option<Duration> {
        self.last.map(|(at, _)| now.saturating_sub(at))
    }

    /// The frame that leaves now for these commands.
    pub fn pass(&mut self, now: Duration, commanded: &Values) -> Values {
        let has_stopped = std::mem::take(&mut self.is_lost);
        let mut values = self.with_glide(commanded);
        if let Some((_, last)) = self.last {
            let change =
                |values: &Values| (0..6).map(|k| (values.length[k] - last.length[k]).abs()).fold(0.0, f64::max);
            if change(&values) > LARGEST * self.actuators.speed * self.interval {
                self.begin(&last, commanded, has_stopped);
                values = self.with_glide(commanded);
            }
        }
        self.last = Some((now, values));
        values
    }

    /// Begins a glide from the last frame, which goes on at the commands' speed.
    fn begin(&mut self, last: &Values, commanded: &Values, has_stopped: bool) {
        // Whoever was lost stands still.
        let has_stopped = has_stopped || self.was_long_ago(last, commanded);
        let fastest = self.actuators.speed;
        let (goes_on, speed) = match has_stopped {
            true => (0.0, LOST_SPEED.min(GLIDE_SPEED * fastest)),
            false => (self.interval, GLIDE_SPEED * fastest),
        };
        let mut from = *last;
        for (length, velocity) in from.length.iter_mut().zip(commanded.velocity) {
            *length += goes_on * velocity.clamp(-fastest, fastest);
        }
        let [from, to] = [&from, commanded].map(numbers);
        let difference: [f64; NUMBERS] = std::array::from_fn(|k| from[k] - to[k]);
        let farthest = difference[..6].iter().fold(0.0, |most: f64, one| most.max(one.abs()));
        let duration = (STEEPEST * farthest / speed).max(SHORTEST);
        let rest = has_stopped.then_some(from);
        self.glide = Some(Glide { difference, rest, begin: commanded.time, duration });
    }

    /// True if the actuators have come to rest since the last frame.
    fn was_long_ago(&self, last: &Values, commanded: &Values) -> bool {
        commanded.time - last.time > 0.5
    }

    fn with_glide(&mut self, commanded: &Values) -> Values {
        let Some(glide) = self.glide else { return *commanded };
        let left = glide.left(commanded.time);
        if left <= 0.0 {
            self.glide = None;
        }
        let commands = numbers(commanded);
        // From rest the commands come in as the difference goes out: a mean of two places in the stroke.
        let difference = glide.rest.map_or(glide.difference, |rest| std::array::from_fn(|k| rest[k] - commands[k]));
        let velocity = (left - glide.left(commanded.time - self.interval)) / self.interval;
        let own = if glide.rest.is_some() { 1.0 - left } else { 1.0 };
        let mut values = *commanded;
        for (k, speed) in values.velocity.iter_mut().enumerate() {
            *speed = own * *speed + velocity * difference[k];
        }
        set(&mut values, &std::array::from_fn(|k| commands[k] + left * difference[k]));
        // Commands that have come nearer to the stroke's end since the glide began leave it less room.
        let [shortest, longest] = self.actuators.stroke;
        values.length = values.length.map(|length| length.clamp(shortest, longest));
        values
    }
}

fn numbers(values: &Values) -> [f64; NUMBERS] {
    let all = values.length.iter().chain(&values.pose).chain(&values.own).chain([&values.heave, &values.heave_above]);
    let mut all = all.copied();
    std::array::from_fn(|_| all.next().unwrap_or_default())
}

fn set(values: &mut Values, numbers: &[f64; NUMBERS]) {
    let places = values.length.iter_mut().chain(&mut values.pose).chain(&mut values.own);
    let places = places.chain([&mut values.heave, &mut values.heave_above]);
    places.zip(numbers).for_each(|(place, number)| *place = *number);
}

#[cfg(test)]
mod tests {
    use super::*;

    const INTERVAL: f64 = 0.01;
    const SPEED: f64 = 1.0;
    const ACTUATORS: Actuators = Actuators { speed: SPEED, stroke: [1.0, 1.6] };

    /// A command at a time \[s\]: a sine of 0.1 m and 0.9 m/s at most.
    fn commanded(time: f64) -> Values {
        let length = [1.3 + 0.1 * (9.0 * time).sin(); 6];
        Values { time, length, velocity: [0.9 * (9.0 * time).cos(); 6], ..Values::default() }
    }

    /// Frames that leave at these times \[ms\].
    fn passed(wire: &mut Wire, times: impl IntoIterator<Item = u32>) -> Vec<Values> {
        times
            .into_iter()
            .map(|time| wire.pass(Duration::from_millis(time.into()), &commanded(f64::from(time) * 1e-3)))
            .collect()
    }

    #[test]
    fn frames_on_time_pass_as_they_are() {
        let mut wire = Wire::new(INTERVAL, ACTUATORS);
        for (k, values) in passed(&mut wire, (0..3000).step_by(10)).iter().enumerate() {
            assert_eq!(*values, commanded(k as f64 * 10.0 * 1e-3));
        }
    }

    #[test]
    fn the_change_between_frames_stays_within_the_limits_after_any_gap() {
        for gap in [20, 30, 106, 219, 700, 1670, 5000] {
            let mut wire = Wire::new(INTERVAL, ACTUATORS);
            let times = (0..500).step_by(10).chain((490 + gap..12_000).step_by(10));
            let frames = passed(&mut wire, times);
            let steps = frames.windows(2).map(|pair| (pair[1].length[0] - pair[0].length[0]).abs());
            let most = steps.fold(0.0, f64::max);
            assert!(most <= 1.2 * SPEED * INTERVAL, "gap of {gap} ms: {most} m in a frame");
            // It comes back to the commands.
            let last = frames.last().unwrap();
            assert_eq!(last.length, commanded(last.time).length, "gap of {gap} ms");
        }
    }

    /// Frames that were left out near the end of the stroke, and commands that come back there.
    #[test]
    fn no_glide_leaves_the_stroke() {
        let mut wire = Wire::new(INTERVAL, ACTUATORS);
        let at = |time: f64, length: f64| Values { time, length: [length; 6], ..Values::default() };
        wire.pass(Duration::ZERO, &at(0.0, 1.59));
        for k in 20..1000 {
            let time = f64::from(k) * INTERVAL;
            let now = wire.pass(Duration::from_secs_f64(time), &at(time, (1.4 + 0.2 * (time - 0.2)).min(1.6)));
            assert!((1.0..=1.6).contains(&now.length[0]), "{} m at {time} s", now.length[0]);
        }
    }

    #[test]
    fn a_controller_that_was_lost_is_followed_from_where_it_was() {
        let mut wire = Wire::new(INTERVAL, ACTUATORS);
        passed(&mut wire, (0..500).step_by(10));
        let before = wire.last.unwrap().1.length[0];
        wire.lose();
        let first = wire.pass(Duration::from_secs(9), &Values { time: 9.0, length: [1.0; 6], ..Values::default() });
        assert!((first.length[0] - before).abs() < 1e-9);
        // The commands go up meanwhile: no frame leaves the stroke, and none jumps.
        let mut last = first.length[0];
        for k in 1..4000 {
            let time = 9.0 + 0.01 * f64::from(k);
            let up = [1.0 + 0.6 * (0.2 * (time - 9.0)).min(1.0); 6];
            let now = wire.pass(Duration::from_secs_f64(time), &Values { time, length: up, ..Values::default() });
            assert!((1.0..=1.6).contains(&now.length[0]) && (now.length[0] - last).abs() < 0.0025, "{time} s");
            last = now.length[0];
        }
        assert_eq!(last, 1.6);
        // Somebody knows where the platform is.
        wire.begin_anew();
        assert_eq!(wire.pass(Duration::from_secs(50), &commanded(50.0)).length, commanded(50.0).length);
    }
}
