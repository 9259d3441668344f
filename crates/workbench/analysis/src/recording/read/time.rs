//! Times that are not plain numbers: dates with a time (ISO 8601), and times of day with or without
//! another date.
//!
//! Of dates as 01/05/2026 the order of day and month is not known, and month names are in any
//! language. Neither is needed: their times of day are used, also past midnight.

use jiff::civil::DateTime;
use jiff::tz::TimeZone;
use jiff::{SignedDuration, Timestamp};

use crate::recording::message::quoted;
use crate::texts::text;

/// True where a field is a date and time or a time of day, and no number.
pub fn is_written_out(field: &str) -> bool {
    seconds(field.trim()).is_some()
}

/// The time in seconds: since 1970 for a date in ISO 8601, otherwise since midnight, or since the
/// hour for minutes and seconds. Durations are read as `PT0.02S` and `0.02 sec`.
///
/// # Errors
/// The field is neither.
pub fn parse(field: &str) -> Result<f64, String> {
    let text = field.trim();
    seconds(text).ok_or_else(|| text!["no-time-of-day", text = quoted(text)].to_string())
}

fn seconds(text: &str) -> Option<f64> {
    parse_date(text).or_else(|| parse_compact(text)).or_else(|| time_of_day(text)).or_else(|| parse_duration(text))
}

/// A date with a time, in UTC unless it states its offset, as seconds since 1970.
fn parse_date(text: &str) -> Option<f64> {
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

/// A duration in ISO 8601, or a number with its unit of time.
fn parse_duration(text: &str) -> Option<f64> {
    let has_unit = text.ends_with(char::is_alphabetic) && text.contains(|c: char| c.is_ascii_digit());
    let duration: SignedDuration = has_unit.then(|| text.parse().ok()).flatten()?;
    Some(duration.as_secs_f64())
}

/// True for a date without a time.
pub fn is_date_alone(field: &str) -> bool {
    let text = field.trim();
    let parts: Vec<&str> = text.split(['-', '/', '.']).collect();
    parts.len() == 3 && parts.iter().all(|part| !part.is_empty() && part.len() <= 4) && is_date(text)
}

/// `20260501_123000250`, in seconds since midnight; a date that is none of ISO 8601.
fn parse_compact(text: &str) -> Option<f64> {
    let (date, time) = text.split_once(['_', 'T', 't', ' ', '-'])?;
    let time = time.trim_end_matches(['Z', 'z']);
    let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    if date.len() != 8 || !digits(date) || time.len() < 6 || !digits(time.get(..6)?) {
        return None;
    }
    let fraction = time[6..].trim_start_matches(['.', ',', '_', '-']);
    digits(fraction).then_some(())?;
    seconds_of_clock(&time[..2], &time[2..4], &format!("{}.{fraction}", &time[4..6]))
}

/// The time of day in a text with a date of any kind, in seconds since midnight.
fn time_of_day(text: &str) -> Option<f64> {
    let colon = text.find(':')?;
    let is_of_time = |c: char| c.is_ascii_digit() || ":.,".contains(c);
    let begin = text[..colon].trim_end_matches(|c: char| c.is_ascii_digit()).len();
    let end = text[colon..].find(|c| !is_of_time(c)).map_or(text.len(), |length| colon + length);
    // A minus is no time of day.
    let before = &text[..begin];
    if !(before.is_empty() || before.ends_with([' ', 'T', '_', '\u{a0}', '\u{202f}']) || before.ends_with("  ")) {
        return None;
    }
    let behind = text[end..].trim();
    let half = [("am", 0.0), ("pm", 12.0)].into_iter().find_map(|(word, hours)| {
        let letters = |c: &char| !['.', ' ', '\u{a0}', '\u{202f}'].contains(c);
        let plain: String = behind.to_lowercase().chars().filter(letters).take(3).collect();
        let is_word = plain.starts_with(word) && !plain.chars().nth(2).is_some_and(char::is_alphabetic);
        is_word.then_some(hours)
    });
    if !is_date(before) || !(half.is_some() || is_date(behind)) {
        return None;
    }
    let time = &text[begin..end];
    let parts: Vec<&str> = time.split(':').collect();
    let seconds = match parts[..] {
        [hours, minutes, seconds] => seconds_of_clock(hours, minutes, seconds),
        // The fraction of a second behind a colon.
        [hours, minutes, seconds, fraction] if fraction.len() >= 3 && seconds.len() == 2 => {
            seconds_of_clock(hours, minutes, &format!("{seconds}.{fraction}"))
        }
        [minutes, seconds] => seconds_of_clock("0", minutes, seconds),
        _ => None,
    }?;
    let Some(half) = half else { return Some(seconds) };
    (seconds < 13.0 * 3600.0).then(|| seconds % (12.0 * 3600.0) + 3600.0 * half)
}

/// True for words and numbers that may stand beside a time of day: a date, a time zone.
fn is_date(text: &str) -> bool {
    // Most words and numbers of a date beside its time of day.
    const MOST_WORDS: usize = 8;
    let is_joint = |c: char| c.is_whitespace() || "/.,-+:_()T".contains(c);
    let words: Vec<&str> = text.split(is_joint).filter(|word| !word.is_empty()).collect();
    let is_word = |word: &&str| {
        word.len() <= 4 && word.bytes().all(|b| b.is_ascii_digit()) || word.chars().all(char::is_alphabetic)
    };
    let letters: usize = words.iter().filter(|word| word.chars().all(char::is_alphabetic)).map(|word| word.len()).sum();
    words.len() <= MOST_WORDS && words.iter().all(is_word) && letters <= 30
}

/// Hours, minutes, and seconds with decimals, in seconds.
fn seconds_of_clock(hours: &str, minutes: &str, seconds: &str) -> Option<f64> {
    let whole = |text: &str| text.parse::<u32>().ok().map(f64::from);
    if !seconds.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let seconds: f64 = seconds.replacen(',', ".", 1).parse().ok()?;
    (seconds < 61.0).then_some(3600.0 * whole(hours)? + 60.0 * whole(minutes)? + seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DAY: f64 = 86_400.0;

    #[test]
    fn dates_and_times_of_day_are_seconds() {
        let parse = |text: &str| parse(text).unwrap();
        // 2026-05-01 is day 20574 of the epoch.
        let noon = 20_574.0 * DAY + 12.0 * 3600.0;
        for text in [
            "2026-05-01T12:00:00Z",
            "2026-05-01 12:00:00",
            "2026/05/01 12:00:00",
            "2026-05-01T14:00:00+02:00",
            "2026-05-01T12:00:00.000Z",
            "20260501T120000",
            "20260501 120000",
        ] {
            assert_eq!(parse(text), noon, "{text}");
            assert!(is_written_out(text), "{text}");
        }
        assert!((parse("2026-05-01T12:00:00.250Z") - noon - 0.25).abs() < 1e-6);
        assert_eq!(parse("01:02.5"), 62.5);
        for text in
            ["12.5", "1e3", "-1:2", "1:2:3:4", "12:xx", "2026-05-01", "", ":", "1:", "é:1", "12:30:00 13 PM x9y"]
        {
            assert!(!is_written_out(text), "{text}");
        }
    }

    #[test]
    fn the_time_of_day_is_found_beside_any_date() {
        for text in [
            "12:30:00.25",
            "12:30:00,25",
            "12:30:00:250",
            "12:30:00.25 PM",
            "12:30:00.25 p.m.",
            "05/01/2026 12:30:00.25",
            "01.05.2026 12:30:00,25",
            "01-May-2026 12:30:00.25",
            "01-may.-2026 12:30:00.25",
            "May 1, 2026 12:30:00.25 PM",
            "Fri May 01 12:30:00.25 GMT+01:00 2026",
            "Fri, 01 May 2026 12:30:00.25 +0100",
            "1. März 2026 12:30:00,25",
            "20260501_123000250",
        ] {
            assert_eq!(parse(text), Ok(45_000.25), "{text}");
        }
        assert_eq!((parse("12:00:01 AM"), parse("1:00:00 pm")), (Ok(1.0), Ok(46_800.0)));
        assert_eq!(parse("59:59.5"), Ok(3599.5));
        assert_eq!(["PT1M0.25S", "60.25 sec", "60250 ms"].map(parse), [Ok(60.25), Ok(60.25), Ok(60.25)]);
        assert!(is_date_alone("01.05.2026") && is_date_alone("2026-05-01") && !is_date_alone("1.5"));
    }
}
