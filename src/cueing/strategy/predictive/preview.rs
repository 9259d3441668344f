//! A previewed reference, which replaces a forecast.

use moris_interface::Group;
use nalgebra::SVector;
use serde::{Deserialize, Serialize};

use super::expected::{DECAY_RATES, Forecast};
use super::horizon::{BLOCKS, FORECAST_TIME, Horizon};
use crate::interface::{PREVIEW_SAMPLES, Preview};

/// Time constant with which the angular channel's part of the reference is expected to fade \[s\].
const ANGULAR_PART_TIME: f64 = 1.0;
/// Differences of time below this are rounding \[s\].
pub const TIME_ROUNDING: f64 = 1e-9;

/// The cue of one axis at points of time to come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PreviewedCue {
    /// Time from one value to the next; the first is one such time after the
    /// course was given \[s\].
    pub step: f64,
    /// Number of values in use.
    pub count: usize,
    /// Values of the cue \[m/s2\].
    pub values: [f64; PREVIEW_SAMPLES],
    /// Time since the course was given \[s\]; below 0 where the reference lags behind it.
    pub age: f64,
    /// True once time has passed since.
    pub begun: bool,
}

impl PreviewedCue {
    /// The courses in surge and sway of a preview whose forces \[m/s2\] `cue` conditions. A preview
    /// ends before its first element that is not a number.
    pub fn of(preview: &Preview, cue: impl Fn([f64; 2]) -> [f64; 2]) -> [Self; 2] {
        if preview.count <= 0 || preview.step.is_nan() {
            return [PreviewedCue::default(); 2];
        }
        let Preview { count, step, surge, sway } = preview.sanitized();
        let mut courses = [&preview.surge, &preview.sway].map(|forces| {
            let numbers = forces.iter().position(|force| force.is_nan()).unwrap_or(PREVIEW_SAMPLES);
            PreviewedCue { step, count: numbers.min(count as usize), ..PreviewedCue::default() }
        });
        for k in 0..PREVIEW_SAMPLES {
            [courses[0].values[k], courses[1].values[k]] = cue([surge[k], sway[k]]);
        }
        courses
    }

    /// Advances by `step` seconds.
    pub fn advance(&mut self, step: f64) {
        self.age += step;
        self.begun = true;
    }

    /// Delays a course that has just been given by the time for which its reference lags \[s\].
    pub fn delay(&mut self, lag: f64) {
        if !self.begun {
            self.age = -lag;
        }
    }

    /// Time from now to the last value; 0 once it is past \[s\].
    pub fn length(&self) -> f64 {
        (self.step * self.count as f64 - self.age).max(0.0)
    }
}

/// The latest course, and those given within one of its steps before.
///
/// Each preview's points lie between those of the others, so that within a step a host tells all of
/// a force that it knows at points of time. Together they have the means of a force that vibrates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PreviewedCues {
    latest: PreviewedCue,
    /// A ring, with the oldest at `next`.
    before: [PreviewedCue; KEPT_COURSES],
    next: u8,
}

/// Number of courses kept beside the latest.
const KEPT_COURSES: usize = 9;
/// Corners of all of them, and the reference now.
const CORNERS: usize = (KEPT_COURSES + 1) * PREVIEW_SAMPLES + 1;

impl PreviewedCues {
    /// Takes a new course. One without values, or with another step, removes those before.
    pub fn give(&mut self, course: &PreviewedCue) {
        if course.step != self.latest.step || course.count == 0 {
            // Most hosts give none, each step.
            if self.latest.count > 0 {
                *self = PreviewedCues::default();
            }
        } else if self.latest.begun && self.is_apart() {
            let next = usize::from(self.next) % KEPT_COURSES;
            self.before[next] = self.latest;
            self.next = ((next + 1) % KEPT_COURSES) as u8;
        }
        self.latest = *course;
    }

    /// True if the latest course is far enough from the one kept before for both to be kept.
    fn is_apart(&self) -> bool {
        let newest = &self.before[(usize::from(self.next) + KEPT_COURSES - 1) % KEPT_COURSES];
        let spacing = self.latest.step / (KEPT_COURSES + 1) as f64;
        newest.count == 0 || newest.age - self.latest.age >= spacing - TIME_ROUNDING
    }

    /// Advances by `step` seconds.
    pub fn advance(&mut self, step: f64) {
        if self.latest.count > 0 {
            self.latest.advance(step);
            for course in &mut self.before {
                course.age += step;
            }
        }
    }

    /// Delays a course that has just been given by the time for which its reference lags \[s\].
    pub fn delay(&mut self, lag: f64) {
        self.latest.delay(lag);
    }

    /// Time from now to the last value; 0 once it is past \[s\].
    pub fn length(&self) -> f64 {
        self.latest.length()
    }

    /// Times and values of all courses' points, by time. Of a course a step old, the latest gives
    /// the same points anew.
    fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        let next = usize::from(self.next) % KEPT_COURSES;
        let oldest_first = move || self.before[next..].iter().chain(&self.before[..next]).chain([&self.latest]);
        (0..self.latest.count).flat_map(move |k| {
            oldest_first()
                .filter(move |course| k < course.count && course.age < self.latest.step)
                .filter_map(move |course| Some(((k + 1) as f64 * course.step - course.age, *course.values.get(k)?)))
        })
    }
}

/// The effective reference from now to the end of a course: linear between its corners.
#[derive(Clone, Copy, Debug)]
pub struct Ahead {
    times: [f64; CORNERS],
    values: [f64; CORNERS],
    /// Number of corners, two at least.
    count: usize,
}

impl Default for Ahead {
    fn default() -> Self {
        Ahead { times: [0.0; CORNERS], values: [0.0; CORNERS], count: 1 }
    }
}

impl Ahead {
    /// Sets the course from now on. Its `angular_part` is the angular channel's share of the
    /// effective reference \[m/s2\]. False if the course is over.
    ///
    /// Now the reference is on the line from `low`, what it was about `lag` seconds ago without its
    /// vibration, to the course's next value.
    pub fn set(&mut self, courses: &PreviewedCues, (lag, low): (f64, f64), angular_part: f64) -> bool {
        (self.times[0], self.count) = (0.0, 1);
        for (time, value) in courses.points() {
            if time > self.times[self.count - 1] + TIME_ROUNDING {
                let fading =
                    if angular_part == 0.0 { 0.0 } else { angular_part * libm::exp(-time / ANGULAR_PART_TIME) };
                self.times[self.count] = time;
                self.values[self.count] = value + fading;
                self.count += 1;
            }
        }
        self.values[0] = low + (self.values[1] - low) * lag / (lag + self.times[1]);
        self.count > 1
    }

    /// Time from now to the end \[s\].
    pub fn length(&self) -> f64 {
        self.times[self.count - 1]
    }

    /// The reference at the end \[m/s2\].
    pub fn last(&self) -> f64 {
        self.values[self.count - 1]
    }

    /// A piece up to a time: duration, and the reference at the beginning and at the end. None if
    /// the piece begins after that time.
    #[inline(always)]
    fn piece(&self, piece: usize, until: f64) -> Option<(f64, f64, f64)> {
        let (start, end) = (self.times[piece - 1], self.times[piece]);
        let (from, to) = (self.values[piece - 1], self.values[piece]);
        let fraction = ((until - start) / (end - start)).min(1.0);
        (fraction > 0.0).then_some((fraction * (end - start), from, from + fraction * (to - from)))
    }

    /// Integrals of the reference from now to each of ascending times \[m/s\]; nothing is added
    /// after the end.
    fn integrals<const N: usize>(&self, until: [f64; N]) -> [f64; N] {
        let area = |(duration, from, to): (f64, f64, f64)| 0.5 * duration * (from + to);
        let (mut piece, mut whole) = (1, 0.0);
        until.map(|until| {
            while piece < self.count {
                let Some(part) = self.piece(piece, until).map(area) else { break };
                if until < self.times[piece] {
                    return whole + part;
                }
                (piece, whole) = (piece + 1, whole + part);
            }
            whole
        })
    }

    /// The reference at a time up to the end \[m/s2\].
    fn value(&self, time: f64) -> f64 {
        let piece = self.times[..self.count - 1].partition_point(|&start| start < time);
        if piece == 0 { self.values[0] } else { self.piece(piece, time).map_or(self.values[0], |(.., to)| to) }
    }

    /// First-order low-passes of the reference, `low` now, at a time up to the end.
    pub fn low_passes<const N: usize>(&self, mut low: [f64; N], time_constants: [f64; N], until: f64) -> [f64; N] {
        for (duration, from, to) in (1..self.count).map_while(|piece| self.piece(piece, until)) {
            let slope = (to - from) / duration;
            for (low, time_constant) in low.iter_mut().zip(time_constants) {
                let lag = slope * time_constant;
                *low = to - lag + (*low - from + lag) * libm::exp(-duration / time_constant);
            }
        }
        low
    }
}

/// A reference as previewed, and from the preview's end on as forecast there.
#[derive(Clone, Copy, Debug)]
pub struct PreviewedReference<'a> {
    pub ahead: &'a Ahead,
    /// The forecast as of the preview's end.
    pub after: Forecast,
    /// The slow part of the reference now \[m/s2\], and its time constant \[s\].
    pub slow: f64,
    pub slow_time: f64,
}

impl PreviewedReference<'_> {
    /// The reference's means over the blocks of a horizon, and its slow and its
    /// fast part at the end.
    pub fn over(&self, horizon: Horizon) -> Forecast {
        let (ends, durations) = (horizon.ends(), horizon.durations());
        let length = self.ahead.length();
        let previewed = self.ahead.integrals(ends);
        let mut before = 0.0;
        let means = SVector::from_fn(|k, _| {
            let to_end = previewed[k] + self.after.integral((ends[k] - length).max(0.0));
            (to_end - core::mem::replace(&mut before, to_end)) / durations[k]
        });
        Forecast { means, end: self.parts(ends[BLOCKS - 1]) }
    }

    /// The slow and the fast part of the reference at a time.
    fn parts(&self, time: f64) -> [f64; 2] {
        let length = self.ahead.length();
        let [mut slow] = self.ahead.low_passes([self.slow], [self.slow_time], time.min(length));
        if time <= length {
            return [slow, self.ahead.value(time) - slow];
        }
        if time >= length + FORECAST_TIME {
            let fading = time - length - FORECAST_TIME;
            return [0, 1].map(|part: usize| self.after.end[part] * libm::exp(-DECAY_RATES[part] * fading));
        }
        let mut value = self.ahead.last();
        let mut left = time - length;
        for (mean, duration) in self.after.means.iter().zip(Horizon::Near.durations()) {
            if left > 0.0 {
                slow = mean + (slow - mean) * libm::exp(-duration.min(left) / self.slow_time);
                value = *mean;
            }
            left -= duration;
        }
        [slow, value - slow]
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn ahead(courses: &PreviewedCues, past: (f64, f64), angular_part: f64) -> Option<Ahead> {
        let mut ahead = Ahead::default();
        ahead.set(courses, past, angular_part).then_some(ahead)
    }

    /// One and a half seconds of a course that was given 0.1 s ago.
    fn course() -> PreviewedCue {
        let mut values = [0.0; PREVIEW_SAMPLES];
        values[..8].copy_from_slice(&[1.0, 2.0, -1.0, 0.5, 0.5, 3.0, 0.0, -2.0]);
        PreviewedCue { step: 0.2, count: 8, values, age: 0.1, begun: true }
    }

    fn alone(course: PreviewedCue) -> PreviewedCues {
        PreviewedCues { latest: course, ..PreviewedCues::default() }
    }

    /// The reference of [`course`], which is 0.5 now.
    fn reference(time: f64) -> f64 {
        let corners = [
            (0.0, 0.5),
            (0.1, 1.0),
            (0.3, 2.0),
            (0.5, -1.0),
            (0.7, 0.5),
            (0.9, 0.5),
            (1.1, 3.0),
            (1.3, 0.0),
            (1.5, -2.0),
        ];
        let k = (1..corners.len()).find(|&k| time <= corners[k].0).unwrap_or(corners.len() - 1);
        let ((start, from), (end, to)) = (corners[k - 1], corners[k]);
        from + (to - from) * (time - start) / (end - start)
    }

    #[test]
    fn a_course_is_linear_between_its_values_and_starts_from_the_present_one() {
        let ahead = ahead(&alone(course()), (0.0, 0.5), 0.0).unwrap();
        assert!((ahead.length() - 1.5).abs() < 1e-12 && ahead.last() == -2.0);
        let (mut integral, mut low) = (0.0, 0.2);
        let step = 1e-5;
        for k in 0..150_000 {
            let middle = reference((f64::from(k) + 0.5) * step);
            integral += middle * step;
            low += (middle - low) * (1.0 - (-step / 0.3_f64).exp());
            if (k + 1) % 10_000 == 0 {
                let time = f64::from(k + 1) * step;
                assert!((ahead.integrals([time])[0] - integral).abs() < 1e-8);
                assert!((ahead.value(time) - reference(time)).abs() < 1e-9);
                assert!((ahead.low_passes([0.2], [0.3], time)[0] - low).abs() < 1e-7);
            }
        }
        assert!((ahead.integrals([9.0])[0] - integral).abs() < 1e-8, "nothing comes after the end");
    }

    #[test]
    fn a_course_that_is_over_is_none() {
        assert!(ahead(&alone(PreviewedCue { age: 1.6, ..course() }), (0.0, 0.5), 0.0).is_none());
        assert!(ahead(&PreviewedCues::default(), (0.0, 0.5), 0.0).is_none());
        assert_eq!(PreviewedCue { age: 1.7, ..course() }.length(), 0.0);
    }

    #[test]
    fn blocks_hold_the_preview_s_integral_and_then_the_forecast_s() {
        let after = Forecast { means: SVector::from_fn(|k, _| 0.3 - 0.1 * k as f64), end: [0.4, -0.2] };
        let ahead = ahead(&alone(course()), (0.0, 0.5), 0.0).unwrap();
        let previewed = PreviewedReference { ahead: &ahead, after, slow: 0.2, slow_time: 0.6 };
        for horizon in [Horizon::Near, Horizon::Far] {
            let forecast = previewed.over(horizon);
            let total = forecast.means.dot(&SVector::from(*horizon.durations()));
            let end = horizon.ends()[BLOCKS - 1];
            assert!((total - ahead.integrals([1.5])[0] - after.integral(end - 1.5)).abs() < 1e-12);
            let first = 0.5 + 0.5 * (reference(horizon.durations()[0]) - 0.5);
            assert!((forecast.means[0] - first).abs() < 1e-12);
        }
        let [slow, fast] = previewed.parts(6.0);
        assert!((slow - 0.4 * (-0.1 * 1.5_f64).exp()).abs() < 1e-12);
        assert!((fast + 0.2 * (-3.0 * 1.5_f64).exp()).abs() < 1e-12);
        let [slow, fast] = previewed.parts(0.8);
        assert!((slow + fast - reference(0.8)).abs() < 1e-12);
        assert!((slow - ahead.low_passes([0.2], [0.6], 0.8)[0]).abs() < 1e-12);
    }

    #[test]
    fn between_the_preview_s_end_and_the_forecast_s_the_low_pass_follows_the_forecast() {
        let after = Forecast { means: SVector::from_fn(|k, _| 0.3 - 0.1 * k as f64), end: [0.4, -0.2] };
        for count in [4, 8] {
            let ahead = ahead(&alone(PreviewedCue { count, ..course() }), (0.0, 0.5), 0.0).unwrap();
            let length = ahead.length();
            let previewed = PreviewedReference { ahead: &ahead, after, slow: 0.2, slow_time: 0.6 };
            let mut low = ahead.low_passes([0.2], [0.6], length)[0];
            let (ends, step) = (Horizon::Near.ends(), 1e-4);
            for k in 0..29_000 {
                let time = (f64::from(k) + 0.5) * step;
                let mean = after.means[ends.iter().position(|end| time < *end).unwrap()];
                low += (mean - low) * (1.0 - (-step / 0.6_f64).exp());
                if k % 1000 == 500 {
                    let [slow, fast] = previewed.parts(length + f64::from(k + 1) * step);
                    assert!((slow - low).abs() < 1e-9, "{slow} beside {low}");
                    assert!((slow + fast - mean).abs() < 1e-9, "{fast}");
                }
            }
        }
    }

    #[test]
    fn a_course_holds_the_cues_of_its_preview_up_to_what_is_not_a_number() {
        let mut preview = Preview { count: 3, step: 0.25, ..Preview::default() };
        (preview.surge[..4]).copy_from_slice(&[1.0, f64::NAN, 3.0, 4.0]);
        (preview.sway[..4]).copy_from_slice(&[-1.0, -2.0, -3.0, -4.0]);
        let cue = |[surge, sway]: [f64; 2]| [2.0 * surge, 3.0 * sway];
        let [surge, sway] = PreviewedCue::of(&preview, cue);
        assert_eq!((surge.count, surge.step, surge.values[0]), (1, 0.25, 2.0));
        assert_eq!((sway.count, sway.step, sway.values[..3].to_vec()), (3, 0.25, vec![-3.0, -6.0, -9.0]));
        for nothing in
            [Preview { count: 0, ..preview }, Preview { count: -1, ..preview }, Preview { step: f64::NAN, ..preview }]
        {
            assert_eq!(PreviewedCue::of(&nothing, cue), [PreviewedCue::default(); 2]);
        }
    }

    #[test]
    fn only_a_course_that_has_not_begun_is_delayed() {
        let mut course = PreviewedCue { age: 0.0, begun: false, ..course() };
        course.delay(0.05);
        assert_eq!((course.age, course.length()), (-0.05, 0.2 * 8.0 + 0.05));
        course.advance(0.15);
        course.delay(0.3);
        assert!((course.age - 0.1).abs() < 1e-15 && (course.length() - 1.5).abs() < 1e-12);
    }

    /// A force that vibrates much faster than a preview's points can show.
    fn vibrating(time: f64) -> f64 {
        0.4 * time + (TAU * 4.7 * time).sin()
    }

    /// Courses of 8 points, 0.2 s apart, given every `period` from 0 to `until`.
    fn given(period: f64, until: f64) -> PreviewedCues {
        let mut courses = PreviewedCues::default();
        let count = (until / period).round() as usize;
        for k in 0..=count {
            let now = k as f64 * period;
            let values = std::array::from_fn(|k| vibrating(now + 0.2 * (k + 1) as f64));
            courses.give(&PreviewedCue { step: 0.2, count: 8, values, ..PreviewedCue::default() });
            if k < count {
                courses.advance(period);
            }
        }
        courses
    }

    #[test]
    fn previews_given_often_together_tell_the_means_of_a_vibrating_force() {
        for period in [0.001, 0.005, 0.02] {
            let ahead = ahead(&given(period, 1.0), (0.0, vibrating(1.0)), 0.0).unwrap();
            assert!((ahead.length() - 1.6).abs() < 1e-9);
            for (from, to) in [(0.0, 0.2), (0.1, 0.4), (0.5, 1.4), (1.0, 1.3)] {
                let exact = |time: f64| 0.2 * time * time - (TAU * 4.7 * time).cos() / (TAU * 4.7);
                let expected = (exact(1.0 + to) - exact(1.0 + from)) / (to - from);
                let found = (ahead.integrals([to])[0] - ahead.integrals([from])[0]) / (to - from);
                assert!((found - expected).abs() < 0.03, "{period} s: {found} beside {expected}");
            }
        }
        let once = ahead(&given(0.3, 0.9), (0.0, vibrating(0.9)), 0.0).unwrap();
        assert_eq!(once.count, 9, "points older than a step are given anew");
    }

    #[test]
    fn courses_of_another_step_or_without_values_replace_all() {
        for next in [PreviewedCue { step: 0.25, ..course() }, PreviewedCue { count: 0, ..course() }] {
            let mut courses = given(0.01, 0.5);
            courses.give(&next);
            assert_eq!(courses, PreviewedCues { latest: next, ..PreviewedCues::default() });
        }
    }
}
