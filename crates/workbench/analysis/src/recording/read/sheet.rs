//! One CSV file, with its header.

use std::path::{Path, PathBuf};

use csv::StringRecord;

use super::numbers::{is_empty, is_number};
use super::preamble::{self, Found, Separator, reader, separator_below, tabulated};
use super::text::{Text, text};
use super::time::is_written_out;
use super::{serial, source, tagged, vbox};
use crate::message::Message;
use crate::recording::columns::{Header, Term, UnitSource};
use crate::recording::conventions::{Conventions, Quantity, TimeUnit, Unit};
use crate::recording::message::RecordingError;
use crate::texts::text;

/// Lines that show a form.
const FORM_LINES: usize = 3;

/// True for fields of the lines below a header that are of a form.
type IsOfForm = fn(&[Vec<String>]) -> bool;

/// Forms of files in which columns are not found, and how to convert them.
const UNREADABLE_FORMS: [(IsOfForm, fn() -> Message); 3] = [
    (
        |lines| lines.iter().flatten().any(|field| field.starts_with(['[', '(']) && field.contains([',', ' '])),
        || text!["lists-in-fields"],
    ),
    (|lines| lines.iter().filter(|line| is_word(line.first())).count() * 2 > lines.len(), || text!["lines-of-kinds"]),
    (
        |lines| lines.first().is_some_and(|line| line.iter().skip(1).all(|field| is_word(Some(field)))),
        || text!["header-of-several-lines"],
    ),
];

fn is_word(field: Option<&String>) -> bool {
    field.is_some_and(|field| field.starts_with(char::is_alphabetic))
}

/// A CSV file in memory.
pub struct Sheet {
    /// The file as messages name it.
    pub file: PathBuf,
    pub header: Header,
    /// The columns of its time; none if it has none.
    pub time: Option<Vec<Term>>,
    /// True where its times are dates or times of day.
    pub has_written_times: bool,
    /// The lines below the header.
    pub(super) body: String,
    /// The number of the first of them.
    pub(super) first_line: u64,
    pub(super) delimiter: u8,
    /// The header, and the lines of units and sources below it, which may come again.
    pub(super) headings: Vec<StringRecord>,
    /// True where the file ends with bytes that are no text.
    pub(super) is_cut: bool,
}

impl Sheet {
    /// Opens a file: a header of names, then lines of numbers, with commas, semicolons, tabulators,
    /// bars or blanks between them. A line of units may follow the header, and a logger's preamble
    /// may precede it. Lines that begin with # or % are comments, of which one may be the header.
    ///
    /// # Errors
    /// The file cannot be read, is no CSV, or has no header.
    pub fn open(file: &Path, conventions: &Conventions) -> Result<Self, RecordingError> {
        let Text { text, is_cut } = text(file)?;
        let text = if has_quoted_lines(&text) { text.replace('"', "") } else { text };
        let other = vbox::as_csv(&text).or_else(|| tagged::as_csv(&text, conventions));
        let mut text = other.or_else(|| serial::as_csv(&text)).unwrap_or(text);
        let file = source::shown(file);
        let whole = |reason: Message| RecordingError::whole(&file, reason);
        let found = preamble::find(&text, conventions);
        let Found { mut titles, separator, end, line } = found.ok_or_else(|| whole(without_header(&text).into()))?;
        let separator = separator_below(&text[end..], separator, titles.len());
        // Some programs write the units above the names.
        let above = text[..end].lines().rev().nth(1).map(|line| preamble::fields(line, separator));
        text.drain(..end);
        let (body, delimiter) = match separator {
            Separator::Sign(sign) => (text, sign),
            Separator::Blanks => (tabulated(&text), b'\t'),
        };
        // R names the rows, but not their column.
        if has_row_names(&body, separator, titles.len()) {
            titles.insert(0, String::new());
        }
        let mut header = Header::new(titles.iter().map(String::as_str));
        if let Some(units) = above.filter(|units| units.len() == titles.len()) {
            header.take_units(units.iter().map(String::as_str));
        }
        let mut headings = vec![StringRecord::from(titles)];
        let first = read_descriptions(&body, delimiter, &mut header, &mut headings);
        let first = first.map_err(|error| whole(error.to_string().into()))?;
        let time = header.terms(conventions.column(Quantity::Time)).map_err(whole)?;
        let mut time = time.filter(|_| conventions.rate.is_none());
        if let Some(terms) = time.as_mut().filter(|terms| terms.len() > 1) {
            header.scale_to_seconds(terms);
        }
        let is_written = |term: &Term| first.get(term.place).is_some_and(is_written_out);
        let has_written_times = time.as_deref().is_some_and(|terms| terms.iter().any(is_written));
        Ok(Sheet { file, header, time, has_written_times, body, first_line: line, delimiter, headings, is_cut })
    }

    /// An error of the file as a whole.
    pub fn refused(&self, reason: impl Into<Message>) -> RecordingError {
        RecordingError::whole(&self.file, reason)
    }

    /// The way to convert the file, where its columns are not found because of its form.
    pub fn form(&self) -> Option<Message> {
        // Lines in which a form is looked for.
        const LINES_OF_FORM: usize = 20;
        let records = reader(&self.body, self.delimiter).into_records().filter_map(Result::ok).take(LINES_OF_FORM);
        let lines: Vec<Vec<String>> = records.map(|record| record.iter().map(str::to_owned).collect()).collect();
        UNREADABLE_FORMS.iter().find(|(is_of, _)| is_of(&lines)).map(|(_, remedy)| remedy())
    }

    /// The reason why the file has no time.
    pub fn without_time(&self, conventions: &Conventions) -> RecordingError {
        let time = conventions.column(Quantity::Time);
        self.refused(text!["no-column-of-time", time])
    }

    /// The unit of its samples' times and its source: seconds where they are written out.
    pub fn time_unit(&self, terms: &[Term], conventions: &Conventions) -> Result<(Unit, UnitSource), RecordingError> {
        if self.has_written_times {
            return Ok((TimeUnit::Second.unit(), UnitSource::Header));
        }
        self.header.time_unit(terms, conventions).map_err(|reason| self.refused(reason))
    }
}

/// True where each line stands in quotation marks as a whole.
fn has_quoted_lines(text: &str) -> bool {
    let is_quoted = |line: &str| {
        let inner = line.trim().strip_prefix('"').and_then(|line| line.strip_suffix('"'));
        inner.is_some_and(|line| !line.contains('"') && line.contains([',', ';', '\t']))
    };
    let mut lines = text.lines().filter(|line| !line.trim().is_empty()).take(FORM_LINES).peekable();
    lines.peek().is_some() && lines.all(is_quoted)
}

/// True where the first lines have one field more than the header, and begin with their number.
fn has_row_names(body: &str, separator: Separator, width: usize) -> bool {
    let is_numbered = |(number, line): (usize, &str)| {
        let fields = preamble::fields(line, separator);
        fields.len() == width + 1 && (fields[0] == number.to_string() || line.starts_with('"'))
    };
    let mut lines = (1..).zip(body.lines().take(FORM_LINES)).peekable();
    lines.peek().is_some() && lines.all(is_numbered)
}

/// The reason why a text has no header.
fn without_header(text: &str) -> &'static str {
    if text.trim().is_empty() {
        "is empty; the first line must name the columns"
    } else {
        "begins with numbers; the first line must name the columns: time,ax,ay,az,wx,wy,wz"
    }
}

/// Reads the lines of units and of sources below the header into the header and the headings.
/// Returns the first line of numbers.
fn read_descriptions(
    body: &str,
    delimiter: u8,
    header: &mut Header,
    headings: &mut Vec<StringRecord>,
) -> csv::Result<StringRecord> {
    let mut records = reader(body, delimiter).into_records();
    let mut next = || records.by_ref().find(|record| !record.as_ref().is_ok_and(is_blank)).transpose();
    let mut record = next()?.unwrap_or_default();
    let has_number = |record: &StringRecord| record.iter().any(|field| is_number(field) || is_written_out(field));
    // A line that describes the columns, between their names and their units.
    let is_description =
        record.len() == header.width() && !has_number(&record) && !record.iter().all(|field| is_empty(Some(field)));
    if !header.take_units(record.iter()) {
        let units = if is_description { next()?.unwrap_or_default() } else { return Ok(record) };
        if !header.take_units(units.iter()) {
            return Ok(record);
        }
        headings.push(record);
        record = units;
    }
    headings.push(record);
    record = next()?.unwrap_or_default();
    // Some loggers write the source of each column below its unit.
    if !record.is_empty() && !has_number(&record) {
        headings.push(record);
        record = next()?.unwrap_or_default();
    }
    Ok(record)
}

/// True for a line without any text, also one of separators alone, and for one that underlines.
pub(super) fn is_blank(record: &StringRecord) -> bool {
    record.iter().flat_map(str::chars).all(|c| c.is_whitespace() || "-=+:".contains(c))
}
