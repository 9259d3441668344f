//! One CSV file: its header, and the numbers of some of its columns.

use std::path::{Path, PathBuf};

use csv::{Reader, ReaderBuilder, StringRecord};

use super::numbers::{Numbers, is_empty, is_number};
use super::time::{Times, is_written_out};
use super::{source, vbox};
use crate::recording::columns::Header;
use crate::recording::conventions::{Conventions, EmptyFields, Quantity};
use crate::recording::message::RecordingError;

/// Most lines before the header.
const LONGEST_PREAMBLE: usize = 100;

/// A CSV file in memory.
pub struct Sheet {
    /// The file as messages name it.
    pub file: PathBuf,
    pub header: Header,
    /// The place of its time; none if it has no such column.
    pub time: Option<usize>,
    /// True where its times are dates or times of day.
    pub has_written_times: bool,
    text: String,
    /// Where the header begins in the text \[bytes\], and the number of lines before it.
    start: (usize, u64),
    delimiter: u8,
    /// Lines of units and sources below the header.
    below: usize,
}

/// Some columns of a sheet.
pub struct Samples {
    /// As the file has it, times that are written out in seconds.
    pub time: Vec<f64>,
    /// The columns in the order in which they were asked for, in the file's units; an empty
    /// field is not a number.
    pub columns: Vec<Vec<f64>>,
    /// The line of the file from which each sample is.
    pub lines: Vec<u64>,
    /// Warnings, in whole sentences.
    pub warnings: Vec<String>,
}

impl Sheet {
    /// Opens a file: a header of names, then lines of numbers, with commas, semicolons or
    /// tabulators between them. A line of units may follow the header, and a logger's preamble may
    /// precede it. Lines that begin with # are comments. Between semicolons or tabulators, numbers
    /// may have a decimal comma.
    ///
    /// # Errors
    /// The file cannot be read, is no CSV, or has no header.
    pub fn open(file: &Path, conventions: &Conventions) -> Result<Self, RecordingError> {
        let text = source::text(file)?;
        let text = vbox::as_csv(&text).unwrap_or(text);
        let file = source::shown(file);
        let whole = |reason: &str| RecordingError::Whole { file: file.clone(), reason: reason.to_owned() };
        let start = header_start(&text, conventions);
        let delimiter = delimiter(&text[start.0..]);
        let mut reader = reader(&text[start.0..], delimiter);
        let mut header = match reader.headers() {
            Ok(names) => Header::new(names),
            Err(error) => return Err(whole(&error.to_string())),
        };
        if header.is_blank() {
            return Err(whole("is empty; the first line must name the columns"));
        }
        if header.is_numbers() {
            return Err(whole("begins with numbers; the first line must name the columns: time,ax,ay,az,wx,wy,wz"));
        }
        let mut record = StringRecord::new();
        let mut advance = |record: &mut StringRecord| reader.read_record(record).map_err(|e| whole(&e.to_string()));
        let mut below = 0;
        if advance(&mut record)? && header.take_units(record.iter()) {
            below = 1;
            // Some loggers write the source of each column below its unit.
            let is_source =
                advance(&mut record)? && !record.iter().any(|field| is_number(field) || is_written_out(field));
            if is_source && record.iter().any(|field| !field.trim().is_empty()) {
                below = 2;
                advance(&mut record)?;
            }
        }
        let time = header.place(conventions.column(Quantity::Time)).map_err(|reason| whole(&reason))?;
        let has_written_times = time.and_then(|time| record.get(time)).is_some_and(is_written_out);
        Ok(Sheet { file, header, time, has_written_times, text, start, delimiter, below })
    }

    /// Reads columns.
    ///
    /// # Errors
    /// A value is not a number, a line has too many fields, there are fewer than two lines.
    pub fn samples(&self, places: &[usize], time: usize, conventions: &Conventions) -> Result<Samples, RecordingError> {
        let text = &self.text[self.start.0..];
        let mut reader = reader(text, self.delimiter);
        let mut record = StringRecord::new();
        let mut advance = |record: &mut StringRecord| {
            reader
                .read_record(record)
                .map_err(|error| RecordingError::Whole { file: self.file.clone(), reason: error.to_string() })
        };
        for _ in 0..self.below {
            advance(&mut record)?;
        }
        let mut samples = Samples {
            time: Vec::new(),
            columns: vec![Vec::new(); places.len()],
            lines: Vec::new(),
            warnings: Vec::new(),
        };
        let mut numbers = Numbers::default();
        let mut times = Times::default();
        while advance(&mut record)? {
            let line = self.start.1 + record.position().map_or(0, |position| line_of_record(position, text));
            let row = self.row(&record, line, (places, time), (&mut numbers, &mut times), conventions);
            let (at, values) = match row {
                Ok(row) => row,
                Err(error) => {
                    let is_cut = record.len() < self.header.width() || !text.ends_with('\n');
                    if is_cut && !advance(&mut record)? {
                        samples.warnings.push(format!("The last line, {line}, is cut off and left out."));
                        break;
                    }
                    return Err(error);
                }
            };
            samples.time.push(at);
            samples.columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
            samples.lines.push(line);
        }
        if samples.time.len() < 2 {
            let reason = "has fewer than two samples below its header".to_owned();
            return Err(RecordingError::Whole { file: self.file.clone(), reason });
        }
        Ok(samples)
    }

    /// The time and the values of a line.
    fn row(
        &self,
        record: &StringRecord,
        line: u64,
        (places, time): (&[usize], usize),
        (numbers, times): (&mut Numbers, &mut Times),
        conventions: &Conventions,
    ) -> Result<(f64, Vec<f64>), RecordingError> {
        let refused = |place: Option<usize>, reason| {
            let column = place.map(|place| self.header.shown(place));
            RecordingError::Line { file: self.file.clone(), line, column, reason }
        };
        if record.iter().skip(self.header.width()).any(|field| !field.trim().is_empty()) {
            return Err(refused(None, too_many_fields(record.len(), self.header.width())));
        }
        let at = match record.get(time) {
            Some(field) if self.has_written_times => times.parse(field),
            field => numbers.parse(field),
        };
        let at = at.map_err(|reason| refused(Some(time), reason))?;
        let may_be_empty = conventions.empty_fields == EmptyFields::Interpolate;
        let value = |&place: &usize| match record.get(place) {
            field if may_be_empty && is_empty(field) => Ok(f64::NAN),
            field => numbers.parse(field).map_err(|reason| refused(Some(place), reason)),
        };
        Ok((at, places.iter().map(value).collect::<Result<_, _>>()?))
    }
}

fn reader(text: &str, delimiter: u8) -> Reader<&[u8]> {
    ReaderBuilder::new().delimiter(delimiter).comment(Some(b'#')).flexible(true).from_reader(text.as_bytes())
}

/// The place of the header in the text, and the number of lines before it.
///
/// The header is the first line with all columns that a recording needs. Where there is none, it is
/// the first of the lines with the most names, so that an error lists those.
fn header_start(text: &str, conventions: &Conventions) -> (usize, u64) {
    let begin = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    let mut start = begin;
    let mut widest = (0, (begin, 0));
    let mut read = 0;
    for (number, line) in (0..).zip(text[begin..].split_inclusive('\n')) {
        let here = (start, number);
        start += line.len();
        if line.starts_with('#') || line.trim().is_empty() {
            continue;
        }
        read += 1;
        if read > LONGEST_PREAMBLE {
            break;
        }
        let mut reader =
            ReaderBuilder::new().delimiter(delimiter(line)).has_headers(false).from_reader(line.as_bytes());
        let mut record = StringRecord::new();
        if !reader.read_record(&mut record).unwrap_or(false) {
            continue;
        }
        let header = Header::new(record.iter());
        if header.has_needed_columns(conventions) {
            return here;
        }
        if record.len() > widest.0 && !record.iter().any(is_number) {
            widest = (record.len(), here);
        }
    }
    widest.1
}

/// Line of a record. Its position is where the reader began, before the blank lines and
/// comments that it skipped.
fn line_of_record(position: &csv::Position, text: &str) -> u64 {
    let rest = text.get(position.byte() as usize..).unwrap_or_default();
    let is_skipped = |line: &&str| line.trim_end_matches('\r').is_empty() || line.starts_with('#');
    position.line() + rest.split('\n').take_while(is_skipped).count() as u64
}

fn too_many_fields(fields: usize, columns: usize) -> String {
    format!(
        "has {fields} fields below a header of {columns}; if its numbers have decimal commas, separate the columns with \
         semicolons"
    )
}

/// Which of comma, semicolon and tabulator there are most of in the first line that is no comment.
fn delimiter(text: &str) -> u8 {
    let header = text.lines().find(|line| !line.starts_with('#') && !line.trim().is_empty()).unwrap_or_default();
    let count = |delimiter: u8| header.bytes().filter(|&byte| byte == delimiter).count();
    [b',', b';', b'\t'].into_iter().rev().max_by_key(|&delimiter| count(delimiter)).unwrap_or(b',')
}
