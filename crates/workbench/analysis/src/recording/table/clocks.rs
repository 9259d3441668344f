//! Clocks that begin again, and times that are other numbers than seconds: HHMMSS, and days.

use super::times::median_step;
use crate::message::Message;
use crate::texts::text;

/// A day \[s\].
const SECONDS_PER_DAY: f64 = 86_400.0;

/// Times in a unit, in the file's order.
pub struct Clock<'a> {
    pub time: &'a mut Vec<f64>,
    /// The unit \[s\].
    pub unit: f64,
    /// Factor by which the times of a counter are multiplied already.
    pub factor: f64,
    /// True where neither the file nor an option gives the unit.
    pub is_open: bool,
    /// True for dates and times of day.
    pub is_written: bool,
}

impl Clock<'_> {
    /// Brings the times to seconds that go on. Returns warnings.
    pub fn into_seconds(self) -> Vec<Message> {
        // Periods of clocks in seconds: minutes and seconds, twelve hours, a day, a week of
        // satellites.
        const PERIODS: [f64; 4] = [3600.0, 43_200.0, SECONDS_PER_DAY, 7.0 * SECONDS_PER_DAY];
        // Bits of counters.
        const BITS: [i32; 5] = [16, 24, 30, 31, 32];
        const SHORT_BITS: [i32; 3] = [8, 10, 12];
        let Clock { time, unit, factor, is_open, is_written } = self;
        let mut warnings = Vec::new();
        if is_open && is_serial_days(time) {
            let first = time[0].floor();
            time.iter_mut().for_each(|time| *time = (*time - first) * SECONDS_PER_DAY);
            warnings.push(text!["times-read-as-days"]);
        } else if !is_written && let Some(seconds) = of_digits(time, unit) {
            *time = seconds;
            warnings.push("The times are read as HHMMSS: they leave out the seconds from 60 to 99.".into());
            add_period(time, &PERIODS);
        } else {
            let counter = |bits: i32| factor.abs() * 2f64.powi(bits);
            // Short counters are those that a factor shows to be some.
            let short = SHORT_BITS.into_iter().filter(|_| factor != 1.0);
            let counters: Vec<f64> = BITS.into_iter().chain(short).map(counter).collect();
            let micros = [32, 31].map(|bits| 1e-6 * 2f64.powi(bits) / unit);
            let millis = [32, 31].map(|bits| 1e-3 * 2f64.powi(bits) / unit);
            let periods: Vec<f64> =
                PERIODS.map(|period| period / unit).into_iter().chain(micros).chain(millis).collect();
            let counted: &[f64] = if is_written { &[] } else { &counters };
            if let Some(sample) = add_period(time, &[&periods, counted].concat()).filter(|_| !is_written) {
                warnings.push(text!["clock-begins-again", sample = sample + 1]);
            }
            time.iter_mut().for_each(|time| *time *= unit);
        }
        warnings
    }
}

/// Adds a period wherever the clock begins again: where a step back is a usual step with the period
/// added, or half a day back. Returns the first such sample.
fn add_period(time: &mut [f64], periods: &[f64]) -> Option<usize> {
    // Longest step over a clock's end [usual steps].
    const LONGEST: f64 = 20.0;
    let usual = median_step(time);
    let (mut added, mut first) = (0.0, None);
    let mut before = *time.first()?;
    for (sample, time) in time.iter_mut().enumerate().skip(1) {
        let step = *time - before;
        before = *time;
        if step < 0.0 && usual > 0.0 {
            let fits = |period: &&f64| step + **period > 0.0 && step + **period <= LONGEST * usual;
            if let Some(period) = periods.iter().find(fits) {
                added += period;
                first = first.or(Some(sample));
            }
        }
        *time += added;
    }
    first
}

/// True for days since a date: as seconds they would come at more than 100 kHz.
fn is_serial_days(time: &[f64]) -> bool {
    // Serial numbers of days: since 1970, since 1899 as spreadsheets count, and Julian [d].
    const SERIAL: [f64; 2] = [10_000.0, 3e6];
    // Steps that are those of recordings [s].
    const STEPS: [f64; 2] = [1e-4, 0.25];
    let step = median_step(time) * SECONDS_PER_DAY;
    time.iter().all(|time| (SERIAL[0]..SERIAL[1]).contains(time)) && (STEPS[0]..=STEPS[1]).contains(&step)
}

/// The seconds of times of day HHMMSS, also with a date before or milliseconds behind; none where
/// they may be plain numbers, as those that leave out nothing.
fn of_digits(time: &[f64], unit: f64) -> Option<Vec<f64>> {
    if unit != 1.0 && unit != 1e-3 {
        return None;
    }
    [1.0, 1e-3].into_iter().find_map(|scale| {
        let seconds: Vec<f64> = time.iter().map(|time| seconds_of_digits(time * scale)).collect::<Option<_>>()?;
        let usual = median_step(&seconds);
        let leaves_out = |k: usize| {
            let (step, written) = (seconds[k] - seconds[k - 1], scale * (time[k] - time[k - 1]));
            let is_usual = step > 0.0 && step <= 3.0 * usual;
            is_usual && (written - step > 39.0)
        };
        (1..time.len()).any(leaves_out).then_some(seconds)
    })
}

/// The seconds since midnight of HHMMSS; none if it is no time of day.
fn seconds_of_digits(digits: f64) -> Option<f64> {
    let time = digits % 1e6;
    let (hours, minutes, seconds) = ((time / 1e4).floor(), (time % 1e4 / 100.0).floor(), time % 100.0);
    (digits >= 0.0 && hours < 24.0 && minutes < 60.0 && seconds < 60.0)
        .then_some(3600.0 * hours + 60.0 * minutes + seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The times in seconds of 50 samples a second, written by a function.
    fn read(unit: f64, is_written: bool, write: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut time: Vec<f64> = (0..1500).map(|k| write(0.02 * f64::from(k))).collect();
        Clock { time: &mut time, unit, factor: 1.0, is_open: !is_written, is_written }.into_seconds();
        let first = time[0];
        time.into_iter().map(|time| time - first).collect()
    }

    fn assert_goes_on(time: &[f64], name: &str) {
        assert_within(1e-4, time, name);
    }

    fn assert_within(tolerance: f64, time: &[f64], name: &str) {
        for (k, time) in time.iter().enumerate() {
            assert!((time - 0.02 * k as f64).abs() < tolerance, "{name}: {k}: {time}");
        }
    }

    #[test]
    fn clocks_that_begin_again_are_continued() {
        let counter =
            |bits: i32, ticks: f64| move |t: f64| (2f64.powi(bits) + (t - 12.0) * ticks).round() % 2f64.powi(bits);
        assert_goes_on(&read(1e-6, false, counter(32, 1e6)), "microseconds");
        assert_goes_on(&read(1e-3, false, counter(16, 1e3)), "milliseconds");
        assert_goes_on(&read(1.0, false, |t| (604_788.0 + t) % 604_800.0), "week");
        assert_goes_on(&read(1e-3, false, |t| 1e3 * ((604_788.0 + t) % 604_800.0)), "week in ms");
        assert_goes_on(&read(1.0, true, |t| (86_390.0 + t) % 86_400.0), "midnight");
        assert_goes_on(&read(1.0, true, |t| (3590.0 + t) % 3600.0), "minutes");
        assert_goes_on(&read(1.0, true, |t| 3600.0 + (43_190.0 + t) % 43_200.0), "twelve hours");
        // Laps begin again at no clock's end.
        let laps = read(1.0, false, |t| t % 15.0);
        assert!((laps[750] - 0.0).abs() < 1e-9, "{}", laps[750]);
    }

    #[test]
    fn digits_and_days_are_seconds() {
        let digits = |t: f64| {
            let s = 45_590.0 + t;
            1e4 * (s / 3600.0).floor() + 100.0 * (s % 3600.0 / 60.0).floor() + (s % 60.0 * 1e3).round() / 1e3
        };
        assert_goes_on(&read(1.0, false, digits), "HHMMSS");
        assert_goes_on(&read(1.0, false, |t| 1e3 * digits(t)), "HHMMSSmmm");
        // Numbers of this size are 4 ms apart.
        assert_within(4e-3, &read(1.0, false, |t| 20_260_501e6 + digits(t)), "YYYYMMDDHHMMSS");
        for day in [20_574.0, 46_143.0, 740_102.0] {
            assert_goes_on(&read(1.0, false, |t| day + 0.5 + t / SECONDS_PER_DAY), "days");
        }
        assert_goes_on(&read(1.0, false, |t| 20_574.0 + t), "seconds");
    }
}
