//! The numbers of a recording, column by column, in SI units.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use csv::{ReaderBuilder, StringRecord};

use super::RideError;
use super::conventions::{Conventions, Quantity};
use super::header::{Column, Header, quoted};
use super::source;

/// Most lines before the header.
const LONGEST_PREAMBLE: usize = 100;

/// A recording's columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Where it is from.
    pub file: PathBuf,
    /// The time column \[s\].
    pub time: Vec<f64>,
    /// All others, in SI units and the file's axes.
    pub columns: BTreeMap<Quantity, Vec<f64>>,
    /// The columns of the file, with their units.
    pub layout: Vec<Column>,
    /// The line of the file from which each sample is.
    pub lines: Vec<u64>,
}

impl Table {
    /// Mean time between samples \[s\].
    pub fn step(&self) -> f64 {
        match self.time.as_slice() {
            [first, .., last] => (last - first) / (self.time.len() - 1) as f64,
            _ => 0.0,
        }
    }

    /// True where the recording holds the vehicle's orientation: its roll and pitch at least.
    pub fn has_orientation(&self) -> bool {
        self.columns.contains_key(&Quantity::Angle(0)) && self.columns.contains_key(&Quantity::Angle(1))
    }

    /// The column of a quantity in the file.
    pub fn column(&self, quantity: Quantity) -> Option<&Column> {
        self.layout.iter().find(|column| column.quantity == quantity)
    }
}

/// Reads a recording: a header of names, then lines of numbers, with commas, semicolons or
/// tabulators between them. A line of units may follow the header, and a logger's preamble may
/// precede it. Lines that begin with # are comments. Between semicolons or tabulators, numbers may
/// have a decimal comma.
///
/// # Errors
/// The file cannot be read or holds no samples, columns are missing, a unit contradicts an option,
/// a value is not a number.
pub fn read(file: &Path, conventions: &Conventions) -> Result<Table, RideError> {
    let text = source::text(file)?;
    let text = text.trim_start_matches('\u{feff}');
    let file = source::shown(file);
    let whole = |reason: &str| RideError::Whole { file: file.clone(), reason: reason.to_owned() };
    let (preamble, text) = without_preamble(text, conventions);
    let delimiter = delimiter(text);
    let mut reader =
        ReaderBuilder::new().delimiter(delimiter).comment(Some(b'#')).flexible(true).from_reader(text.as_bytes());
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
    let mut advance = |record: &mut StringRecord| reader.read_record(record).map_err(|error| whole(&error.to_string()));
    let mut is_sample = advance(&mut record)?;
    if is_sample && header.take_units(record.iter()) {
        is_sample = advance(&mut record)?;
        // Some loggers write the source of each column below its unit.
        if is_sample && record.iter().all(|field| !field.trim().is_empty() && !is_number(field)) {
            is_sample = advance(&mut record)?;
        }
    }
    let layout = header.columns(&file, conventions)?;
    let mut table = Table { file: file.clone(), time: Vec::new(), columns: BTreeMap::new(), layout, lines: Vec::new() };
    let mut numbers = Numbers::default();
    while is_sample {
        let line = preamble + record.position().map_or(0, |position| line_of_record(position, text));
        let refused = |column, reason| RideError::Line { file: file.clone(), line, column, reason };
        if record.iter().skip(header.width()).any(|field| !field.trim().is_empty()) {
            return Err(refused(None, too_many_fields(record.len(), header.width())));
        }
        for Column { quantity, place, unit, .. } in &table.layout {
            let value =
                numbers.parse(record.get(*place)).map_err(|reason| refused(Some(header.shown(*place)), reason))?;
            match quantity {
                Quantity::Time => table.time.push(value * unit.in_si),
                _ => table.columns.entry(*quantity).or_default().push(value * unit.in_si),
            }
        }
        table.lines.push(line);
        is_sample = advance(&mut record)?;
    }
    if table.time.len() < 2 {
        return Err(whole("has fewer than two samples below its header"));
    }
    Ok(table)
}

/// The recording in columns that are in memory already, by the rules for a file's: names, and units
/// in their brackets. `name` is what messages call it.
///
/// # Errors
/// As [`read`]; columns of different lengths.
pub fn of_columns(name: &str, columns: &[(String, Vec<f64>)], conventions: &Conventions) -> Result<Table, RideError> {
    let file = PathBuf::from(name);
    let whole = |reason: String| RideError::Whole { file: file.clone(), reason };
    let header = Header::new(columns.iter().map(|(title, _)| title.as_str()));
    let layout = header.columns(&file, conventions)?;
    let samples = layout.first().map_or(0, |column| columns[column.place].1.len());
    if samples < 2 {
        return Err(whole("has fewer than two samples".to_owned()));
    }
    let mut table = Table {
        file: file.clone(),
        time: Vec::new(),
        columns: BTreeMap::new(),
        layout,
        lines: (1..=samples as u64).collect(),
    };
    for Column { quantity, place, unit, .. } in &table.layout {
        let (title, values) = &columns[*place];
        if values.len() != samples {
            return Err(whole(format!("column {} has {} values, others have {samples}", quoted(title), values.len())));
        }
        if let Some(sample) = values.iter().position(|value| !value.is_finite()) {
            let reason = format!("is {}; cut this part off, or fill the gap with plausible values", values[sample]);
            let column = Some(quoted(title));
            return Err(RideError::Line { file: file.clone(), line: sample as u64 + 1, column, reason });
        }
        let in_si = values.iter().map(|value| value * unit.in_si).collect();
        match quantity {
            Quantity::Time => table.time = in_si,
            _ => {
                table.columns.insert(*quantity, in_si);
            }
        }
    }
    Ok(table)
}

/// The number of lines before the header, and the text from the header on.
///
/// The header is the first line with all columns that a recording needs. Where there is none, it is
/// the first of the lines with the most names, so that an error lists those.
fn without_preamble<'a>(text: &'a str, conventions: &Conventions) -> (u64, &'a str) {
    let mut start = 0;
    let mut widest = (0, 0, text);
    for (number, line) in (0..).zip(text.split_inclusive('\n').take(LONGEST_PREAMBLE)) {
        let rest = &text[start..];
        start += line.len();
        if line.starts_with('#') || line.trim().is_empty() {
            continue;
        }
        let mut reader =
            ReaderBuilder::new().delimiter(delimiter(line)).has_headers(false).from_reader(line.as_bytes());
        let mut record = StringRecord::new();
        if !reader.read_record(&mut record).unwrap_or(false) {
            continue;
        }
        let header = Header::new(record.iter());
        if header.has_needed_columns(conventions) {
            return (number, rest);
        }
        if record.len() > widest.0 && !record.iter().any(is_number) {
            widest = (record.len(), number, rest);
        }
    }
    (widest.1, widest.2)
}

/// Line of a record. Its position is where the reader began, before the blank lines and
/// comments that it skipped.
fn line_of_record(position: &csv::Position, text: &str) -> u64 {
    let rest = text.get(position.byte() as usize..).unwrap_or_default();
    let is_skipped = |line: &&str| line.trim_end_matches('\r').is_empty() || line.starts_with('#');
    position.line() + rest.split('\n').take_while(is_skipped).count() as u64
}

fn is_number(field: &str) -> bool {
    field.trim().replace(',', ".").parse::<f64>().is_ok()
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

/// Parses numbers that all have the same decimal mark.
#[derive(Default)]
struct Numbers {
    mark: Option<char>,
}

impl Numbers {
    /// A field's number, or the reason why it is none.
    fn parse(&mut self, field: Option<&str>) -> Result<f64, String> {
        let text = field.ok_or("is missing: the line has too few fields")?.trim();
        let number = match text.find([',', '.']).map(|place| text.as_bytes()[place] as char) {
            None => text.parse::<f64>(),
            Some(mark) => {
                let number = if mark == ',' { text.replacen(',', ".", 1).parse::<f64>() } else { text.parse::<f64>() };
                if number.is_ok() && *self.mark.get_or_insert(mark) != mark {
                    return Err(format!(
                        "is {}, but numbers before it have a decimal {}; write all with the same",
                        quoted(text),
                        if mark == ',' { "point" } else { "comma" }
                    ));
                }
                number
            }
        };
        match number {
            Ok(number) if number.is_finite() => Ok(number),
            Ok(_) => Err(format!("is {}; cut this part off, or fill the gap with plausible values", quoted(text))),
            Err(_) if text.is_empty() => {
                Err("is empty; cut this part off, or fill the gap with plausible values".to_owned())
            }
            Err(_) => Err(format!("is \"{}\", which is not a number", quoted(text))),
        }
    }
}
