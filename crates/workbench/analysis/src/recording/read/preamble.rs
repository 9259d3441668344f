//! The header among a file's first lines, and what separates its fields.

use csv::{Reader, ReaderBuilder};

use super::is_number;
use crate::recording::columns::Header;
use crate::recording::columns::units::any_spelled;
use crate::recording::conventions::Conventions;

/// Most lines before the header.
const LONGEST_PREAMBLE: usize = 100;
/// Longest line that may be the header \[bytes\].
const LONGEST_HEADER: usize = 1 << 20;

/// Separator of the fields of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Separator {
    /// A comma, semicolon, tabulator or bar.
    Sign(u8),
    /// Any number of blanks.
    Blanks,
}

/// A header that was found.
pub struct Found {
    pub titles: Vec<String>,
    pub separator: Separator,
    /// Where the lines below it begin in the text \[bytes\].
    pub end: usize,
    /// The number of the line below it, from 1.
    pub line: u64,
}

/// A reader of lines without a header. Lines that begin with # are comments.
pub fn reader(text: &str, delimiter: u8) -> Reader<&[u8]> {
    line_reader(text, delimiter, Some(b'#'))
}

fn line_reader(text: &str, delimiter: u8, comment: Option<u8>) -> Reader<&[u8]> {
    let mut builder = ReaderBuilder::new();
    builder.has_headers(false).delimiter(delimiter).comment(comment).flexible(true).from_reader(text.as_bytes())
}

/// The header: the first line with all columns that a recording needs, also behind the mark of a
/// comment. Where there is none, it is the first of the lines with the most names, so that an error
/// lists those. None where no line can be one.
pub fn find(text: &str, conventions: &Conventions) -> Option<Found> {
    let mut widest: Option<((bool, bool, usize), Found)> = None;
    let begin = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    let mut end = begin;
    let lines = (2..).zip(text[begin..].split_inclusive('\n')).map(|(number, line)| {
        end += line.len();
        (line, end, number)
    });
    let may_be = |line: &str| !line.trim().is_empty() && line.len() < LONGEST_HEADER;
    for (line, end, number) in lines.filter(|(line, ..)| may_be(line)).take(LONGEST_PREAMBLE) {
        let (bare, is_comment) = without_mark(line);
        for separator in likely_separators(bare) {
            let titles = fields(bare, separator);
            let found = |titles| Found { titles, separator, end, line: number };
            if Header::new(titles.iter().map(String::as_str)).has_needed_columns(conventions) {
                return Some(found(titles));
            }
            // Words between blanks, and comments, are names only above as many numbers.
            let is_plain = separator != Separator::Blanks && !is_comment;
            let is_above = is_above_numbers(&text[end..], separator, titles.len());
            let written = titles.iter().filter(|title| !title.trim().is_empty()).count();
            let rank = (is_plain || is_above, is_above, written);
            if is_names(&titles, is_above) && widest.as_ref().is_none_or(|(other, _)| rank > *other) {
                widest = Some((rank, found(titles)));
            }
        }
    }
    widest.map(|(_, found)| found)
}

/// The separator of the lines below a header, where it is not the header's own.
pub fn separator_below(text: &str, header: Separator, width: usize) -> Separator {
    let Some(line) = first_data_line(text) else { return header };
    if width < 2 || fields(line, header).len() > 1 {
        return header;
    }
    likely_separators(line).into_iter().find(|&other| fields(line, other).len() == width).unwrap_or(header)
}

/// The fields of a line.
pub fn fields(line: &str, separator: Separator) -> Vec<String> {
    let tabbed;
    let (line, sign) = match separator {
        Separator::Sign(sign) => (line, sign),
        Separator::Blanks => {
            tabbed = tabulated(line);
            (tabbed.as_str(), b'\t')
        }
    };
    let record = line_reader(line, sign, None).into_records().next();
    record.and_then(Result::ok).map(|record| record.iter().map(str::to_owned).collect()).unwrap_or_default()
}

/// The lines with a tabulator in place of blanks, but for those in quotation marks.
pub fn tabulated(text: &str) -> String {
    let mut tabbed = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let (mut is_quoted, mut is_due) = (false, false);
        for c in line.trim().chars() {
            is_quoted ^= c == '"';
            if c.is_whitespace() && !is_quoted {
                is_due = true;
                continue;
            }
            if std::mem::take(&mut is_due) {
                tabbed.push('\t');
            }
            tabbed.push(c);
        }
        tabbed.extend(line.ends_with('\n').then_some('\n'));
    }
    tabbed
}

/// The line without the mark of a comment that stands apart before it.
fn without_mark(line: &str) -> (&str, bool) {
    let bare = line.trim_start_matches(['#', '%', '!', '/']);
    let is_comment = bare.len() < line.len();
    if is_comment && bare.starts_with(char::is_whitespace) { (bare.trim_start(), true) } else { (line, is_comment) }
}

/// The separators that a line may have, the likeliest first.
fn likely_separators(line: &str) -> Vec<Separator> {
    let count = |sign: u8| line.bytes().filter(|&byte| byte == sign).count();
    // Of as many, the last: tabulators may stand beside others.
    let signs = [b'\t', b'|', b';', b','].into_iter().filter(|&sign| count(sign) > 0);
    let sign = signs.max_by_key(|&sign| count(sign)).map(Separator::Sign);
    let has_blanks = line.trim().contains([' ', '\t']);
    let alone = Separator::Sign(b',');
    let blanks = has_blanks.then_some(Separator::Blanks);
    if sign.is_none() && blanks.is_none() { vec![alone] } else { sign.into_iter().chain(blanks).collect() }
}

/// The first line below the header that has numbers.
fn first_data_line(text: &str) -> Option<&str> {
    let is_data = |line: &&str| line.trim_start().starts_with(|c: char| c.is_ascii_digit() || "+-.\"|".contains(c));
    text.lines().take(LONGEST_PREAMBLE).filter(|line| line.len() < LONGEST_HEADER).find(is_data)
}

/// True for fields that may be names: no numbers but a few above others, not mostly units, and no
/// bars between others.
fn is_names(titles: &[String], is_above_numbers: bool) -> bool {
    let written = titles.iter().filter(|title| !title.trim().is_empty());
    let units = written.clone().filter(|title| any_spelled(title).is_some()).count();
    let numbers = titles.iter().filter(|title| is_number(title)).count();
    let is_parted = titles.iter().any(|title| title == "|");
    let may_be = numbers == 0 || is_above_numbers && !is_number(&titles[0]) && numbers * 2 <= written.clone().count();
    may_be && !is_parted && units * 2 <= written.clone().count() && written.count() > 0
}

/// True where one of the next lines, behind those of units and sources, has as many fields, and the
/// first is a number.
fn is_above_numbers(text: &str, separator: Separator, width: usize) -> bool {
    let mut next = text.lines().filter(|line| !line.trim().is_empty() && line.len() < LONGEST_HEADER).take(3);
    let is_above = |line: &str| {
        let fields = fields(line, separator);
        fields.len() == width && fields.first().is_some_and(is_number)
    };
    width > 1 && next.any(is_above)
}
