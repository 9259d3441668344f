//! The lines of a sheet, as numbers.

use csv::{Position, StringRecord};

use super::numbers::{Numbers, is_empty};
use super::preamble::reader;
use super::samples::Samples;
use super::sheet::Sheet;
use super::time::Times;
use crate::recording::conventions::{Conventions, EmptyFields};
use crate::recording::message::RecordingError;

impl Sheet {
    /// Reads columns.
    ///
    /// # Errors
    /// A value is not a number, a line has too many fields, there are fewer than two lines.
    pub fn samples(&self, places: &[usize], time: usize, conventions: &Conventions) -> Result<Samples, RecordingError> {
        let text = self.body();
        let mut reader = reader(text, self.delimiter);
        let mut record = StringRecord::new();
        let mut advance =
            |record: &mut StringRecord| reader.read_record(record).map_err(|error| self.refused(error.to_string()));
        for _ in 0..self.below {
            advance(&mut record)?;
        }
        let may_be_empty = conventions.empty_fields == EmptyFields::Interpolate;
        let mut row =
            Row { sheet: self, places, time, may_be_empty, numbers: Numbers::default(), times: Times::default() };
        let mut samples = Samples::new(places);
        while advance(&mut record)? {
            let line = self.start.1 + record.position().map_or(0, |position| line_of_record(position, text));
            match row.parse(&record, line) {
                Ok((time, values)) => samples.push(line, time, values),
                Err(error) => {
                    let is_cut = record.len() < self.header.width() || !text.ends_with('\n');
                    if !is_cut || advance(&mut record)? {
                        return Err(error);
                    }
                    samples.warnings.push(format!("The last line, {line}, is cut off and left out."));
                }
            }
        }
        if samples.time.len() < 2 {
            return Err(self.refused("has fewer than two samples below its header"));
        }
        Ok(samples)
    }
}

/// Parses lines in their order.
struct Row<'a> {
    sheet: &'a Sheet,
    places: &'a [usize],
    time: usize,
    may_be_empty: bool,
    numbers: Numbers,
    times: Times,
}

impl Row<'_> {
    /// The time and the values of a line.
    fn parse(&mut self, record: &StringRecord, line: u64) -> Result<(f64, Vec<f64>), RecordingError> {
        let header = &self.sheet.header;
        let refused = |column, reason| RecordingError::line(&self.sheet.file, line, column, reason);
        if record.iter().skip(header.width()).any(|field| !field.trim().is_empty()) {
            return Err(refused(None, too_many_fields(record.len(), header.width())));
        }
        let time = match record.get(self.time) {
            Some(field) if self.sheet.has_written_times => self.times.parse(field),
            field => self.numbers.parse(field),
        };
        let time = time.map_err(|reason| refused(Some(header.shown(self.time)), reason))?;
        let value = |&place: &usize| match record.get(place) {
            field if self.may_be_empty && is_empty(field) => Ok(f64::NAN),
            field => self.numbers.parse(field).map_err(|reason| refused(Some(header.shown(place)), reason)),
        };
        Ok((time, self.places.iter().map(value).collect::<Result<_, _>>()?))
    }
}

/// Line of a record. Its position is where the reader began, before the blank lines and
/// comments that it skipped.
fn line_of_record(position: &Position, text: &str) -> u64 {
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
