//! One CSV file, with its header.

use std::path::{Path, PathBuf};

use csv::{Reader, StringRecord};

use super::numbers::is_number;
use super::preamble::{delimiter, header_start, reader};
use super::text::text;
use super::time::is_written_out;
use super::{source, vbox};
use crate::recording::columns::Header;
use crate::recording::conventions::{Conventions, Quantity};
use crate::recording::message::RecordingError;

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
    pub(super) start: (usize, u64),
    pub(super) delimiter: u8,
    /// Lines of units and sources below the header.
    pub(super) below: usize,
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
        let text = text(file)?;
        let text = vbox::as_csv(&text).unwrap_or(text);
        let file = source::shown(file);
        let whole = |reason: &str| RecordingError::whole(&file, reason);
        let start = header_start(&text, conventions);
        let delimiter = delimiter(&text[start.0..]);
        let mut reader = reader(&text[start.0..], delimiter);
        let mut header = Header::new(reader.headers().map_err(|error| whole(&error.to_string()))?);
        if header.is_blank() {
            return Err(whole("is empty; the first line must name the columns"));
        }
        if header.is_numbers() {
            return Err(whole("begins with numbers; the first line must name the columns: time,ax,ay,az,wx,wy,wz"));
        }
        let mut record = StringRecord::new();
        let below = descriptions(&mut reader, &mut record, &mut header).map_err(|error| whole(&error.to_string()))?;
        let time = header.place(conventions.column(Quantity::Time)).map_err(|reason| whole(&reason))?;
        let has_written_times = time.and_then(|time| record.get(time)).is_some_and(is_written_out);
        Ok(Sheet { file, header, time, has_written_times, text, start, delimiter, below })
    }

    /// The text from the header on.
    pub(super) fn body(&self) -> &str {
        &self.text[self.start.0..]
    }

    /// An error of the file as a whole.
    pub fn refused(&self, reason: impl Into<String>) -> RecordingError {
        RecordingError::whole(&self.file, reason)
    }
}

/// Reads the lines of units and sources below the header, and the first line of numbers after them
/// into `record`. Returns how many there are.
fn descriptions(reader: &mut Reader<&[u8]>, record: &mut StringRecord, header: &mut Header) -> csv::Result<usize> {
    if !reader.read_record(record)? || !header.take_units(record.iter()) {
        return Ok(0);
    }
    // Some loggers write the source of each column below its unit.
    let is_source = reader.read_record(record)?
        && !record.iter().any(|field| is_number(field) || is_written_out(field))
        && record.iter().any(|field| !field.trim().is_empty());
    if is_source {
        reader.read_record(record)?;
    }
    Ok(if is_source { 2 } else { 1 })
}
