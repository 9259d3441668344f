//! Logs whose lines begin with the kind of the line, as the CSV of one kind with the same lines.
//!
//! - FlySight 2: `$COL,IMU,time,wx`, `$UNIT,IMU,s,deg/s`, `$IMU,0.1,0.2`,
//!   <https://flysight.ca/wiki/index.php/File_formats>.
//! - ArduPilot: `FMT, 128, 89, IMU, QBffffff, TimeUS,I,GyrX` and `IMU, 1234, 0, 0.2`; of several
//!   sensors of one kind the first. <https://ardupilot.org/copter/docs/logmessages.html>

use crate::recording::columns::Header;
use crate::recording::conventions::Conventions;

/// A kind of lines.
struct Kind<'a> {
    tag: &'a str,
    names: &'a str,
}

/// The text as CSV of the kind that has the columns of a recording, or of the one with most lines;
/// none if it is no such log.
pub fn as_csv(text: &str, conventions: &Conventions) -> Option<String> {
    // Most lines in which kinds are described.
    const MOST_LINES: usize = 2000;
    let kinds: Vec<Kind> = text.lines().take(MOST_LINES).filter_map(described_kind).collect();
    let rows = |kind: &Kind| text.lines().filter(|line| tagged_fields(line, kind.tag).is_some()).count();
    let has_columns = |kind: &&Kind| Header::new(kind.names.split(',')).has_needed_columns(conventions);
    let kind = kinds.iter().find(has_columns).or_else(|| kinds.iter().max_by_key(|kind| rows(kind)))?;
    let sensor = kind.names.split(',').position(|name| name.trim() == "I");
    let number = |fields: &str| sensor.and_then(|place| fields.split(',').nth(place).map(str::trim).map(str::to_owned));
    let mut first = None;
    let mut csv = String::with_capacity(text.len());
    for line in text.lines() {
        if line.contains(kind.names) && self::described_kind(line).is_some_and(|other| other.tag == kind.tag) {
            csv += kind.names;
        } else if let Some(units) = line.strip_prefix("$UNIT,").and_then(|line| tagged_fields(line, kind.tag)) {
            csv += units;
        } else if let Some(fields) = tagged_fields(line.trim_start_matches('$'), kind.tag) {
            let number = number(fields);
            if *first.get_or_insert(number.clone()) == number {
                csv += fields;
            }
        }
        csv.push('\n');
    }
    Some(csv)
}

/// The kind that a line describes.
fn described_kind(line: &str) -> Option<Kind<'_>> {
    if let Some(rest) = line.strip_prefix("$COL,") {
        let (tag, names) = rest.split_once(',')?;
        return Some(Kind { tag, names });
    }
    let mut parts = line.strip_prefix("FMT,")?.splitn(5, ',').map(str::trim).skip(2);
    let (tag, _, names) = (parts.next()?, parts.next()?, parts.next()?);
    Some(Kind { tag, names })
}

/// The fields behind a tag.
fn tagged_fields<'a>(line: &'a str, tag: &str) -> Option<&'a str> {
    line.trim_start_matches('$').strip_prefix(tag)?.strip_prefix(',')
}
