//! Frames as they leave: the actuators' change from one frame to the next stays within their speed.
//!
//! The loop's commands change within the limits from step to step. Frames may be left out or
//! delayed on their way, so that the next one is far from the last that left. After a short gap the
//! actuators go on with the commands' speed, and the difference to the commands goes to zero. After
//! a longer one they stand: the commands come in from there, a mean of two places in the stroke.

use std::time::Duration;

use moris_live::frame::Values;

/// Acceleration of the legs that a glide may add \[m/s2\], of which a rider feels up to four times
/// as much.
const GLIDE_ACCELERATION: f64 = 0.25;
/// Longest step of a glide \[s\].
const MAX_GLIDE_STEP: f64 = 1e-3;

/// Numbers of a frame that a glide changes.
const GLIDED_NUMBERS: usize = 17;

/// Limits of the actuators.
#[derive(Clone, Copy, Debug)]
pub struct Actuators {
    /// Largest speed of an actuator \[m/s\].
    pub speed: f64,
    /// Largest acceleration of an actuator \[m/s2\].
    pub acceleration: f64,
    /// Shortest and longest length \[m\].
    pub stroke: [f64; 2],
}

impl Actuators {
    /// A length so much later than the last one \[s, m\], from which it can still
    /// brake before its end.
    fn braked(&self, time: f64, last: f64, length: f64) -> f64 {
        // Part of the actuators' acceleration with which a glide brakes before the stroke's end.
        const GLIDE_BRAKING_FRACTION: f64 = 1.2;
        let [shortest, longest] = self.stroke;
        let by_braking = GLIDE_BRAKING_FRACTION * self.acceleration * time * time;
        // The speed of this step is that of which the rest of the stroke is the way to rest.
        let most = |clearance: f64| (by_braking * (by_braking + 2.0 * clearance.max(0.0))).sqrt() - by_braking;
        length.clamp((last - most(last - shortest)).max(shortest), (last + most(longest - last)).min(longest))
    }
}

/// The way of frames to the controller.
#[derive(Clone, Debug)]
pub struct FrameLimiter {
    /// Time between frames \[s\].
    interval: f64,
    actuators: Actuators,
    last: Option<(Duration, Values)>,
    /// Change of the last frame's numbers per second.
    change: [f64; GLIDED_NUMBERS],
    glide: Option<Glide>,
    /// The actuators have stopped since the last frame.
    is_lost: bool,
}

#[derive(Clone, Copy, Debug)]
struct Glide {
    from: GlideStart,
    /// Largest speed of the glide \[m/s\].
    speed: f64,
    /// The part of the way that is left, behind two equal lags.
    lag: f64,
    left: f64,
}

/// The beginning of a glide.
#[derive(Clone, Copy, Debug)]
enum GlideStart {
    /// Actuators that move, so far from the commands.
    Moving([f64; GLIDED_NUMBERS]),
    /// Actuators that stand.
    Standing([f64; GLIDED_NUMBERS]),
}

impl Glide {
    fn difference(&self, commands: &[f64; GLIDED_NUMBERS]) -> [f64; GLIDED_NUMBERS] {
        match self.from {
            GlideStart::Moving(difference) => difference,
            GlideStart::Standing(rest) => std::array::from_fn(|k| rest[k] - commands[k]),
        }
    }

    /// Goes on by a time \[s\], if its whole way is so far \[m\].
    fn advance(&mut self, time: f64, far: f64, actuators: &Actuators) {
        // Part of the actuators' acceleration that a glide may add.
        const GLIDE_PART: f64 = 0.3;
        // Rates at which a glide may go on: with all of its way ahead, and at its end [1/s].
        const GLIDE_PACES: [f64; 2] = [1.0, 4.5];
        let steps = (time / MAX_GLIDE_STEP).ceil();
        let step = time / steps.max(1.0);
        let most = GLIDE_ACCELERATION.min(GLIDE_PART * actuators.acceleration);
        let [first, last] = GLIDE_PACES;
        for _ in 0..steps as u32 {
            let by_way = (most / (far * self.left).max(1e-9)).sqrt();
            let fastest = last.min(first / self.left).min(by_way);
            let ahead = (self.left - self.lag) * far;
            let pace = fastest.min(self.speed / ahead.max(1e-9));
            let kept = (-pace * step).exp();
            self.left = kept * (self.left + pace * step * self.lag);
            self.lag *= kept;
        }
    }
}

impl FrameLimiter {
    /// A way with frames at this interval \[s\] to these actuators.
    pub fn new(interval: f64, actuators: Actuators) -> Self {
        FrameLimiter { interval, actuators, last: None, change: [0.0; GLIDED_NUMBERS], glide: None, is_lost: false }
    }

    /// Forgets the last frame. The operator or the controller has confirmed where the actuators
    /// are, so the next frame need not be continuous with the last one.
    pub fn forget_last_frame(&mut self) {
        *self = FrameLimiter::new(self.interval, self.actuators);
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

    /// Time between frames \[s\].
    pub fn interval(&self) -> f64 {
        self.interval
    }

    /// True if the last frame has the actuators where these values have them.
    pub fn is_at(&self, values: &Values) -> bool {
        // Distance from a place from which on the actuators are there [m].
        const ARRIVAL_DISTANCE: f64 = 1e-4;
        let is_near = |last: &Values| (0..6).all(|k| (last.length[k] - values.length[k]).abs() < ARRIVAL_DISTANCE);
        self.last.is_none_or(|(_, last)| is_near(&last))
    }

    /// The frame that leaves now for these commands.
    pub fn pass(&mut self, now: Duration, commanded: &Values) -> Values {
        // Change between two frames, in terms of the largest speed, from which on a frame begins a
        // glide.
        const GLIDE_SPEED_FACTOR: f64 = 1.15;
        // Time without frames from which on the actuators stand [s], and the same in intervals.
        const STANDSTILL_TIME: f64 = 0.05;
        const STANDS_INTERVALS: f64 = 3.0;
        // Speed of a glide in terms of the actuators' largest.
        const GLIDE_SPEED: f64 = 0.1;
        // Speed of a glide to a controller that was lost, or without frames for so long [m/s, s].
        const LOST_SPEED: f64 = 0.05;
        const STANDSTILL_INTERVALS: f64 = 0.5;
        let was_lost = std::mem::take(&mut self.is_lost);
        let mut values = *commanded;
        if let Some((at, last)) = self.last {
            let gap = now.saturating_sub(at).as_secs_f64();
            let standstill = STANDSTILL_TIME.max(STANDS_INTERVALS * self.interval);
            // Of frames that were left out, too: a glide goes on in the commands' time.
            let mut time = (commanded.time - last.time).clamp(0.0, standstill);
            if was_lost || gap > standstill {
                let speed = GLIDE_SPEED * self.actuators.speed;
                let is_slow = was_lost || gap > STANDSTILL_INTERVALS;
                self.begin(GlideStart::Standing(numbers(&last)), if is_slow { speed.min(LOST_SPEED) } else { speed });
                time = 0.0;
            }
            values = self.with_glide(&last, commanded, time);
            let change = (0..6).map(|k| (values.length[k] - last.length[k]).abs()).fold(0.0, f64::max);
            if change > GLIDE_SPEED_FACTOR * self.actuators.speed * self.interval {
                self.begin(
                    GlideStart::Moving(self.difference_in_motion(&last, commanded)),
                    GLIDE_SPEED * self.actuators.speed,
                );
                values = self.with_glide(&last, commanded, 0.0);
            }
            let [before, now] = [&last, &values].map(numbers);
            self.change = std::array::from_fn(|k| (now[k] - before[k]) / self.interval.max(time));
        }
        self.last = Some((now, values));
        values
    }

    fn begin(&mut self, from: GlideStart, speed: f64) {
        self.glide = Some(Glide { from, speed, lag: 1.0, left: 1.0 });
    }

    /// The difference to the commands of actuators that go on from the last frame at their speed.
    fn difference_in_motion(&self, last: &Values, commanded: &Values) -> [f64; GLIDED_NUMBERS] {
        let fastest = self.actuators.speed;
        let mut from = *last;
        for (length, velocity) in from.length.iter_mut().zip(commanded.velocity) {
            *length += self.interval * velocity.clamp(-fastest, fastest);
        }
        let [from, to] = [&from, commanded].map(numbers);
        std::array::from_fn(|k| from[k] - to[k])
    }

    /// The frame after the last one, with what is left of the glide after this time \[s\].
    fn with_glide(&mut self, last: &Values, commanded: &Values, time: f64) -> Values {
        // Part of a glide that is too short to see.
        const NO_PART: f64 = 1e-7;
        let Some(glide) = &mut self.glide else { return *commanded };
        let commands = numbers(commanded);
        let difference = glide.difference(&commands);
        let far = difference[..6].iter().fold(0.0, |most: f64, one| most.max(one.abs()));
        glide.advance(time, far, &self.actuators);
        if glide.left < NO_PART {
            self.glide = None;
            return *commanded;
        }
        let left = glide.left;
        let mut values = *commanded;
        set(&mut values, &std::array::from_fn(|k| commands[k] + left * difference[k]));
        // A mean of two places in the stroke brakes before its end if both do.
        if let GlideStart::Moving(difference) = &mut glide.from {
            for k in 0..6 {
                let length = self.actuators.braked(self.interval, last.length[k], values.length[k]);
                if length != values.length[k] {
                    // What has been left out is no way to make up for.
                    values.length[k] = length;
                    difference[k] = (length - commands[k]) / left;
                }
            }
        }
        let speed = |k: usize| (values.length[k] - last.length[k]) / self.interval.max(time);
        values.velocity = std::array::from_fn(speed);
        values
    }

    /// The last frame's actuators on their way to rest within the stroke, so much later \[s\]:
    /// there is no washout any more that knows a way.
    pub fn at_rest_after(&self, time: f64) -> Option<Values> {
        // Time in which the speed falls to a third where there is no loop any more [s], and the
        // part of the stroke's rest that the way may take.
        const REST_TIME: f64 = 0.15;
        const REST_WAY: f64 = 0.9;
        let (_, last) = self.last?;
        let [shortest, longest] = self.actuators.stroke;
        let clearance = |k: usize| {
            let end = if last.velocity[k] > 0.0 { longest } else { shortest };
            (end - last.length[k]).abs()
        };
        let fades =
            (0..6).map(|k| REST_WAY * clearance(k) / last.velocity[k].abs().max(1e-9)).fold(REST_TIME, f64::min);
        let fades = fades.max(MAX_GLIDE_STEP);
        let speeds = last.velocity.iter().chain(&self.change[6..]);
        let left = (-time / fades).exp();
        let mut all = numbers(&last);
        all.iter_mut().zip(speeds).for_each(|(number, speed)| *number += speed * fades * (1.0 - left));
        let velocity = last.velocity.map(|speed| speed * left);
        let mut values = Values { time: last.time + time, velocity, ..last };
        set(&mut values, &all);
        values.length = values.length.map(|length| length.clamp(shortest, longest));
        Some(values)
    }
}

fn numbers(values: &Values) -> [f64; GLIDED_NUMBERS] {
    let all = values.length.iter().chain(&values.pose).chain(&values.own).chain([&values.heave, &values.heave_above]);
    let mut all = all.copied();
    std::array::from_fn(|_| all.next().unwrap_or_default())
}

fn set(values: &mut Values, numbers: &[f64; GLIDED_NUMBERS]) {
    let places = values.length.iter_mut().chain(&mut values.pose).chain(&mut values.own);
    let places = places.chain([&mut values.heave, &mut values.heave_above]);
    places.zip(numbers).for_each(|(place, number)| *place = *number);
}

#[cfg(test)]
mod tests;
