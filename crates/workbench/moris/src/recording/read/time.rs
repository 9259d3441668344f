//! Times that are not plain numbers: dates with a time (ISO 8601), and times of day.
//!
//! Of dates as 01/05/2026 the order of day and month is not known, and not needed: their times of
//! day are used, also past midnight.

use jiff::Timestamp;
use jiff::civil::DateTime;
use jiff::tz::TimeZone;

use crate::recording::message::quoted;

/// A day \[s\].
const DAY: f64 = 86_400.0;

/// True where a field is a date and time or a time of day, and no number.
pub fn is_written_out(field: &str) -> bool {
    date(field.trim()).or_else(|| time_of_day(field.trim())).is_some()
}

/// Reads the times of a column in order. A time of day that restarts at midnight
/// continues with the next day.
#[derive(Default)]
pub struct Times {
    midnights: f64,
    last: f64,
}

impl Times {
    /// The time in seconds: since 1970 for a date, since the first midnight for a time of day.
    ///
    /// # Errors
    /// The field is neither.
    pub fn parse(&mut self, field: &str) -> Result<f64, String> {
        let text = field.trim();
        if let Some(time) = date(text) {
            return Ok(time);
        }
        let Some(time) = time_of_day(text) else {
            return Err(format!(
                "is \"{}\", which is no time; write seconds, 2026-05-01T12:30:00.25Z or 12:30:00.25",
                quoted(text)
            ));
        };
        if time + self.midnights < self.last - DAY / 2.0 {
            self.midnights += DAY;
        }
        self.last = time + self.midnights;
        Ok(self.last)
    }
}

/// A date with a time, in UTC unless it states its offset, as seconds since 1970.
fn date(text: &str) -> Option<f64> {
    let is_dated = text.len() > 10 && text.as_bytes()[..4].iter().all(u8::is_ascii_digit);
    if !is_dated {
        return None;
    }
    let text = text.replace('/', "-");
    let timestamp: Timestamp = text.parse().ok().or_else(|| {
        let local: DateTime = text.parse().ok()?;
        Some(local.to_zoned(TimeZone::UTC).ok()?.timestamp())
    })?;
    Some(timestamp.as_nanosecond() as f64 * 1e-9)
}

/// The text after a date with the year at its end.
fn without_date(text: &str) -> &str {
    let is_date = |date: &str| {
        let parts: Vec<&str> = date.split(['/', '.', '-']).collect();
        let is_part = |part: &&str, digits: std::ops::RangeInclusive<usize>| {
            digits.contains(&part.len()) && part.bytes().all(|byte| byte.is_ascii_digit())
        };
        matches!(&parts[..], [a, b, year] if is_part(a, 1..=2) && is_part(b, 1..=2) && is_part(year, 4..=4))
    };
    match text.split_once([' ', 'T']) {
        Some((date, time)) if is_date(date) => time.trim_start(),
        _ => text,
    }
}

/// `h:m:s` or `m:s`, with decimals of a second, in seconds.
fn time_of_day(text: &str) -> Option<f64> {
    let parts: Vec<&str> = without_date(text).split(':').collect();
    let (hours, minutes, seconds) = match parts[..] {
        [hours, minutes, seconds] => (whole(hours)?, whole(minutes)?, seconds),
        [minutes, seconds] => (0.0, whole(minutes)?, seconds),
        _ => return None,
    };
    if !seconds.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let seconds: f64 = seconds.replacen(',', ".", 1).parse().ok()?;
    (seconds < 61.0).then_some(3600.0 * hours + 60.0 * minutes + seconds)
}

fn whole(text: &str) -> Option<f64> {
    text.trim().parse::<u32>().ok().map(f64::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_and_times_of_day_are_seconds() {
        let parse = |text: &str| Times::default().parse(text).unwrap();
        // 2026-05-01 is day 20574 of the epoch.
        let noon = 20_574.0 * DAY + 12.0 * 3600.0;
        for text in [
            "2026-05-01T12:00:00Z",
            "2026-05-01 12:00:00",
            "2026/05/01 12:00:00",
            "2026-05-01T14:00:00+02:00",
            "2026-05-01T12:00:00.000Z",
        ] {
            assert_eq!(parse(text), noon, "{text}");
            assert!(is_written_out(text), "{text}");
        }
        assert!((parse("2026-05-01T12:00:00.250Z") - noon - 0.25).abs() < 1e-6);
        assert_eq!(parse("12:30:00.25"), 45_000.25);
        assert_eq!(parse("12:30:00,25"), 45_000.25);
        assert_eq!(parse("01:02.5"), 62.5);
        for text in ["12.5", "1e3", "-1:2", "1:2:3:4", "12:xx", "2026-05-01", ""] {
            assert!(!is_written_out(text), "{text}");
        }
    }

    #[test]
    fn midnight_is_passed() {
        let mut times = Times::default();
        let parsed: Vec<f64> =
            ["23:59:59.5", "00:00:00.0", "00:00:00.5"].iter().map(|text| times.parse(text).unwrap()).collect();
        assert_eq!(parsed, [86_399.5, 86_400.0, 86_400.5]);
        // A time that merely goes back is left to the check of the order.
        let mut times = Times::default();
        assert_eq!((times.parse("10:00:00"), times.parse("09:59:59")), (Ok(36_000.0), Ok(35_999.0)));
    }
}
