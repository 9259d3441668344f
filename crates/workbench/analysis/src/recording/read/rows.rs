//! The lines of a sheet, as numbers.

use std::ops::Range;

use csv::{Position, StringRecord};

use super::numbers::{Numbers, is_empty};
use super::preamble::reader;
use super::sheet::{Sheet, is_blank};
use super::time;
use crate::message::Message;
use crate::recording::conventions::{Conventions, EmptyFields};
use crate::recording::message::{RecordingError, quoted};
use crate::texts::text;

/// Numbers, a line a sample.
pub struct Samples {
    /// Times that are written out are in seconds.
    pub time: Vec<f64>,
    /// The columns with their places, in the order in which they were asked for, in the file's
    /// units; an empty field is not a number.
    pub columns: Vec<(usize, Vec<f64>)>,
    /// The line of the file from which each sample is.
    pub lines: Vec<u64>,
    /// Warnings, in whole sentences.
    pub warnings: Vec<Message>,
    /// First and last time at which all columns have values of their own; none without gaps at the
    /// ends.
    pub complete: Option<(f64, f64)>,
}

impl Samples {
    /// No samples of columns yet.
    fn new(places: &[usize]) -> Self {
        let columns = places.iter().map(|&place| (place, Vec::new())).collect();
        Samples { time: Vec::new(), columns, lines: Vec::new(), warnings: Vec::new(), complete: None }
    }

    /// Adds a sample, with a value for each column.
    fn push(&mut self, line: u64, time: f64, values: Vec<f64>) {
        self.time.push(time);
        self.lines.push(line);
        self.columns.iter_mut().zip(values).for_each(|((_, column), value)| column.push(value));
    }

    /// Leaves out all samples but those of a range.
    pub fn keep(&mut self, range: Range<usize>) {
        self.time = self.time[range.clone()].to_vec();
        self.lines = self.lines[range.clone()].to_vec();
        for (_, values) in &mut self.columns {
            *values = values[range.clone()].to_vec();
        }
    }
}

impl Sheet {
    /// Reads columns, and the time in its unit, in seconds where it is written out.
    ///
    /// # Errors
    /// A value is not a number, a line has too many fields, there are fewer than two lines.
    pub fn samples(&self, places: &[usize], conventions: &Conventions) -> Result<Samples, RecordingError> {
        let text = &self.body;
        let mut reader = reader(text, self.delimiter);
        let mut record = StringRecord::new();
        let mut advance =
            |record: &mut StringRecord| reader.read_record(record).map_err(|error| self.refused(error.to_string()));
        let may_be_empty = conventions.empty_fields == EmptyFields::Interpolate;
        let mut row = Row { sheet: self, places, may_be_empty, numbers: self.numbers(places) };
        let mut samples = Samples::new(places);
        while advance(&mut record)? {
            if self.is_passed_over(&record) {
                continue;
            }
            let line = self.first_line - 1 + record.position().map_or(0, |position| line_of_record(position, text));
            let parsed = match conventions.rate {
                Some(rate) => row.values(&record, line).map(|values| (samples.time.len() as f64 / rate, values)),
                None => row.parse(&record, line),
            };
            match parsed {
                Ok((time, values)) => samples.push(line, time, values),
                Err(error) => {
                    let is_cut = record.len() < self.header.width() || !text.ends_with('\n');
                    if !is_cut || advance(&mut record)? {
                        return Err(error);
                    }
                    samples.warnings.push(text!["last-line-cut", line]);
                }
            }
        }
        if samples.time.len() < 2 {
            return Err(self.refused("has fewer than two samples below its header"));
        }
        if self.is_cut {
            samples.warnings.push("The file ends with zero bytes in place of lines, which are left out.".into());
        }
        Ok(samples)
    }

    /// True for lines that are no samples: separators alone, comments, and the header once more, as
    /// loggers write it when they start again.
    fn is_passed_over(&self, record: &StringRecord) -> bool {
        let is_comment = || record.get(0).is_some_and(|field| field.starts_with('%') || field.starts_with("//"));
        let is_heading = |heading: &StringRecord| {
            let fields = |record: &StringRecord| record.iter().map(|field| field.trim().to_owned()).collect::<Vec<_>>();
            record.get(0) == heading.get(0) && fields(record) == fields(heading)
        };
        is_blank(record) || is_comment() || self.headings.iter().any(is_heading)
    }

    /// The way in which the first lines of columns are written. Between commas, a comma is no part
    /// of a number without quotation marks.
    fn numbers(&self, places: &[usize]) -> Numbers {
        // Lines that show how numbers are written.
        const SHOWN: usize = 5000;
        if self.delimiter == b',' && !self.body.contains('"') {
            return Numbers::default();
        }
        let times = self.time.iter().flatten().filter(|_| !self.has_written_times).map(|term| term.place);
        let places: Vec<usize> = times.chain(places.iter().copied()).collect();
        let records: Vec<StringRecord> =
            reader(&self.body, self.delimiter).into_records().take(SHOWN).filter_map(Result::ok).collect();
        Numbers::of(places.iter().map(|&place| records.iter().filter_map(move |record| record.get(place))))
    }
}

/// Parses lines in their order.
struct Row<'a> {
    sheet: &'a Sheet,
    places: &'a [usize],
    may_be_empty: bool,
    numbers: Numbers,
}

impl Row<'_> {
    /// The time and the values of a line.
    fn parse(&mut self, record: &StringRecord, line: u64) -> Result<(f64, Vec<f64>), RecordingError> {
        let sheet = self.sheet;
        let mut total = 0.0;
        let terms = sheet.time.iter().flatten();
        let is_sum = terms.clone().count() > 1;
        for term in terms {
            // Beside a time of day there may be a date, and a fraction of a second.
            let time = match record.get(term.place) {
                Some(field) if is_sum && sheet.has_written_times && time::is_date_alone(field) => Ok(0.0),
                Some(field) if sheet.has_written_times && (!is_sum || time::is_written_out(field)) => {
                    time::parse(field).map_err(Message::from)
                }
                field => self.numbers.parse(field).map(|time| term.factor * time),
            };
            let column = || Some(sheet.header.shown(term.place));
            total += time.map_err(|reason| {
                let field = record.get(term.place).unwrap_or_default();
                let reason = if field.contains(':') { unread_time(field) } else { reason };
                RecordingError::line(&sheet.file, line, column(), reason)
            })?;
        }
        Ok((total, self.values(record, line)?))
    }

    /// The values of a line.
    fn values(&mut self, record: &StringRecord, line: u64) -> Result<Vec<f64>, RecordingError> {
        let header = &self.sheet.header;
        let refused = |column, reason: Message| RecordingError::line(&self.sheet.file, line, column, reason);
        if record.iter().skip(header.width()).any(|field| !field.trim().is_empty()) {
            return Err(refused(None, text!["too-many-fields", fields = record.len(), columns = header.width()]));
        }
        let value = |&place: &usize| match record.get(place) {
            field if self.may_be_empty && is_empty(field) => Ok(f64::NAN),
            field => self.numbers.parse(field).map_err(|reason| refused(Some(header.shown(place)), reason)),
        };
        self.places.iter().map(value).collect()
    }
}

/// Line of a record. Its position is where the reader began, before the blank lines and
/// comments that it skipped.
fn line_of_record(position: &Position, text: &str) -> u64 {
    let rest = text.get(position.byte() as usize..).unwrap_or_default();
    let is_skipped = |line: &&str| line.trim_end_matches('\r').is_empty() || line.starts_with('#');
    position.line() + rest.split('\n').take_while(is_skipped).count() as u64
}

/// The reason for a time that is written in another way than those that are read.
fn unread_time(field: &str) -> Message {
    let reason =
        time::parse(field).err().unwrap_or_else(|| format!("is \"{}\", unlike times before it", quoted(field)));
    text!["unread-time", reason]
}
