//! The place of the header among a file's first lines, and the sign between its fields.

use csv::{Reader, ReaderBuilder};

use super::is_number;
use crate::recording::columns::Header;
use crate::recording::conventions::Conventions;

/// Most lines before the header.
const LONGEST_PREAMBLE: usize = 100;

/// A reader of lines, of which the first is the header.
pub fn reader(text: &str, delimiter: u8) -> Reader<&[u8]> {
    ReaderBuilder::new().delimiter(delimiter).comment(Some(b'#')).flexible(true).from_reader(text.as_bytes())
}

/// The place of the header in the text, and the number of lines before it.
///
/// The header is the first line with all columns that a recording needs. Where there is none, it is
/// the first of the lines with the most names, so that an error lists those.
pub fn header_start(text: &str, conventions: &Conventions) -> (usize, u64) {
    let begin = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    let mut start = begin;
    let lines = (0..).zip(text[begin..].split_inclusive('\n')).map(|(number, line)| {
        let here = (start, number);
        start += line.len();
        (here, line)
    });
    let mut widest = (0, (begin, 0));
    for (here, line) in lines.filter(|(_, line)| !is_skipped(line)).take(LONGEST_PREAMBLE) {
        let mut reader = reader(line, delimiter(line));
        let Ok(titles) = reader.headers() else { continue };
        if Header::new(titles).has_needed_columns(conventions) {
            return here;
        }
        if titles.len() > widest.0 && !titles.iter().any(is_number) {
            widest = (titles.len(), here);
        }
    }
    widest.1
}

/// The one of comma, semicolon and tabulator that is most often in the first
/// line that is no comment.
pub fn delimiter(text: &str) -> u8 {
    let header = text.lines().find(|line| !is_skipped(line)).unwrap_or_default();
    let count = |delimiter: u8| header.bytes().filter(|&byte| byte == delimiter).count();
    [b',', b';', b'\t'].into_iter().rev().max_by_key(|&delimiter| count(delimiter)).unwrap_or(b',')
}

/// True for a comment, and for a blank line.
fn is_skipped(line: &str) -> bool {
    line.starts_with('#') || line.trim().is_empty()
}
