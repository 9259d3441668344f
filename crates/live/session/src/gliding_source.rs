//! The washout's source of motion, which changes without a jump.
//!
//! While a source is followed, its motion passes as it is. When the source changes or jumps, the
//! difference to what has passed so far is added, and goes to zero: a glide. Value and slope of
//! what passes are continuous there.

use crate::motion::{ANGLE_CHANNELS, CHANNEL_COUNT, Channels, Motion, SMALLEST_FELT_SIZES, turns};

/// Change of the source at a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// The source goes on.
    None,
    /// Another source, or another place: a glide of 1 to 5 s, the longer the more it changes.
    Source,
    /// The same source after a gap: a glide of this time \[s\], or longer for a large change.
    Gap(f64),
}

/// The source, with what a glide adds to it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GlidingSource {
    output: Motion,
    slope: Channels,
    glide: Option<Glide>,
}

/// A difference that goes to zero.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Glide {
    difference: Channels,
    slope: Channels,
    elapsed: f64,
    duration: f64,
}

impl Glide {
    /// The difference at a time since its beginning; its slope fades within its own time.
    fn value(&self, elapsed: f64) -> Channels {
        // Longest time for which the slope before a change goes on to fade [s].
        const SLOPE_TIME: f64 = 0.2;
        // Largest change that a slope may still cause, in felt sizes; a steeper one fades earlier.
        const SLOPE_CHANGE: f64 = 3.0;
        let part = elapsed / self.duration;
        let left = 1.0 - part * part * (3.0 - 2.0 * part);
        Channels::from_fn(|k, _| {
            let slope = self.slope[k];
            let time = SLOPE_TIME.min(self.duration).min(SLOPE_CHANGE * SMALLEST_FELT_SIZES[k] / slope.abs());
            let passed = if elapsed < time { 1.0 - elapsed / time } else { 0.0 };
            self.difference[k] * left + slope * elapsed * passed * passed
        })
    }
}

impl GlidingSource {
    /// The motion that has passed last.
    pub fn output(&self) -> &Motion {
        &self.output
    }

    /// True if the source passes as it is.
    pub fn is_settled(&self) -> bool {
        self.glide.is_none()
    }

    /// Difference that will still be added to the source's motion in so many seconds.
    pub fn difference(&self, ahead: f64) -> Channels {
        match self.glide.as_ref().map(|glide| (glide, glide.elapsed + ahead)) {
            Some((glide, elapsed)) if elapsed < glide.duration => glide.value(elapsed),
            _ => Channels::zeros(),
        }
    }

    /// Advances by a step to the source's motion at its end, which changes with this slope. Returns
    /// what passes at the step's start and end.
    pub fn advance(&mut self, source: &Motion, slope: &Channels, change: Change, step: f64) -> [Motion; 2] {
        if change != Change::None {
            self.begin(source, slope, change, step);
        }
        let mut end = source.0;
        if let Some(glide) = &mut self.glide {
            glide.elapsed += step;
            if glide.elapsed < glide.duration {
                end += glide.value(glide.elapsed);
            } else {
                self.glide = None;
            }
        }
        // An angle that has gone on by a turn is the same angle.
        let mut start = self.output.0;
        for k in ANGLE_CHANNELS {
            start[k] += turns(end[k] - start[k]);
        }
        self.slope = (end - start) / step;
        self.output = Motion(end);
        [Motion(start), Motion(end)]
    }

    fn begin(&mut self, source: &Motion, slope: &Channels, change: Change, step: f64) {
        // Shortest and longest glide after a change of the source [s].
        const GLIDE_DURATIONS: [f64; 2] = [1.0, 5.0];
        // Time for which a felt difference takes to glide [s].
        const PER_FELT: f64 = 0.5;
        // Least time for which a felt difference takes to glide after a gap [s].
        const PER_GAP: f64 = 0.1;
        // Both at the step's start.
        let mut difference = self.output.0 - (source.0 - slope * step);
        for k in ANGLE_CHANNELS {
            difference[k] -= turns(difference[k]);
        }
        let felt = (0..CHANNEL_COUNT).map(|k| difference[k].abs() / SMALLEST_FELT_SIZES[k]).fold(0.0, f64::max);
        let left = self.glide.map_or(0.0, |glide| glide.duration - glide.elapsed);
        let duration = match change {
            Change::None | Change::Source => (PER_FELT * felt).clamp(GLIDE_DURATIONS[0], GLIDE_DURATIONS[1]),
            Change::Gap(time) => time.max(PER_GAP * felt).max(left).min(GLIDE_DURATIONS[1]),
        };
        self.glide = Some(Glide { difference, slope: self.slope - slope, elapsed: 0.0, duration });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 1e-3;

    fn surge(value: f64) -> Motion {
        let mut motion = Motion::at_rest();
        motion.0[0] = value;
        motion
    }

    fn sine(t: f64) -> (Motion, Channels) {
        let mut slope = Channels::zeros();
        slope[0] = 6.0 * (2.0 * t).cos();
        (surge(3.0 * (2.0 * t).sin()), slope)
    }

    #[test]
    fn a_source_passes_as_it_is() {
        let mut source_glide = GlidingSource::default();
        for k in 1..1000 {
            let (source, slope) = sine(f64::from(k) * STEP);
            assert_eq!(source_glide.advance(&source, &slope, Change::None, STEP)[1], source);
        }
    }

    #[test]
    fn changes_at_any_time_are_continuous_in_value_and_slope() {
        let mut source_glide = GlidingSource::default();
        let mut passed = Vec::new();
        for k in 0..40_000 {
            let rests = k / 1_300 % 2 == 0;
            let change = if k % 1_300 == 0 { Change::Source } else { Change::None };
            let (source, slope) = sine(f64::from(k) * STEP);
            let (source, slope) = if rests { (Motion::at_rest(), Channels::zeros()) } else { (source, slope) };
            passed.push(source_glide.advance(&source, &slope, change, STEP)[1].0[0]);
        }
        let slopes: Vec<f64> = passed.windows(2).map(|pair| (pair[1] - pair[0]) / STEP).collect();
        assert!(slopes.iter().all(|slope| slope.abs() < 12.0));
        // A jump of the slope would be 6 m/s3 in one step; of the value, thousands.
        let kinks = slopes.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        assert!(kinks < 0.3, "{kinks} m/s3");
        assert!(passed.iter().all(|value| value.abs() < 4.5));
    }

    #[test]
    fn a_glide_ends_after_one_to_five_seconds() {
        for (size, expected) in [(0.5, 1.0), (6.0, 3.0), (50.0, 5.0)] {
            let mut source_glide = GlidingSource::default();
            let zero = Channels::zeros();
            source_glide.advance(&surge(0.0), &zero, Change::None, STEP);
            source_glide.advance(&surge(size), &zero, Change::Source, STEP);
            let mut time = STEP;
            while !source_glide.is_settled() {
                source_glide.advance(&surge(size), &zero, Change::None, STEP);
                time += STEP;
            }
            assert!((time - expected).abs() < 2.0 * STEP, "{size}: {time} s");
            assert_eq!(source_glide.output().0[0], size);
        }
    }

    #[test]
    fn an_angle_takes_the_shorter_way() {
        let turned = |yaw: f64| {
            let mut motion = Motion::at_rest();
            motion.0[8] = yaw;
            motion
        };
        let mut source_glide = GlidingSource::default();
        let zero = Channels::zeros();
        for _ in 0..100 {
            source_glide.advance(&turned(3.0), &zero, Change::None, STEP);
        }
        let [mut start, mut end] = source_glide.advance(&turned(-3.0), &zero, Change::Source, STEP);
        for _ in 0..2000 {
            assert!((end.0[8] - start.0[8]).abs() < 1e-3);
            assert!((-3.29..-2.99).contains(&end.0[8]), "{}", end.0[8]);
            [start, end] = source_glide.advance(&turned(-3.0), &zero, Change::None, STEP);
        }
    }
}
