//! The numbers of a recording, column by column, in the recording's own units.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use csv::{ByteRecord, ReaderBuilder};
use moris_setup::nearest;

use super::RideError;
use super::conventions::{Conventions, Quantity};

/// A recording's columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Where it is from.
    pub file: PathBuf,
    /// The time column \[s\].
    pub time: Vec<f64>,
    /// All others, as they are in the file.
    pub columns: BTreeMap<Quantity, Vec<f64>>,
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

    /// True if the recording has the vehicle's orientation: roll and pitch at least.
    pub fn has_orientation(&self) -> bool {
        self.columns.contains_key(&Quantity::Angle(0)) && self.columns.contains_key(&Quantity::Angle(1))
    }
}

/// Reads a recording: a header of names, then lines of numbers, with commas, semicolons or tabulators between them. Lines
/// that begin with # are comments.
///
/// # Errors
/// The file cannot be read or holds no samples, a column is missing, a value is not a number.
pub fn read(file: &Path, conventions: &Conventions) -> Result<Table, RideError> {
    let bytes = fs::read(file).map_err(|reason| RideError::Read { file: file.to_owned(), reason })?;
    let whole = |reason: &str| RideError::Whole { file: file.to_owned(), reason: reason.to_owned() };
    let delimiter = delimiter(&bytes);
    let mut reader =
        ReaderBuilder::new().delimiter(delimiter).comment(Some(b'#')).flexible(true).from_reader(&bytes[..]);
    let header: Vec<String> = match reader.byte_headers() {
        Ok(names) => names.iter().map(|name| bare(&String::from_utf8_lossy(name))).collect(),
        Err(error) => return Err(whole(&error.to_string())),
    };
    if header.iter().all(String::is_empty) {
        return Err(whole("is empty; the first line must name the columns"));
    }
    if header.iter().all(|name| name.parse::<f64>().is_ok()) {
        return Err(whole("begins with numbers; the first line must name the columns: time,ax,ay,az,wx,wy,wz"));
    }
    let places = places(file, &header, conventions)?;

    let mut table = Table { file: file.to_owned(), time: Vec::new(), columns: BTreeMap::new(), lines: Vec::new() };
    let mut record = ByteRecord::new();
    while reader.read_byte_record(&mut record).map_err(|error| whole(&error.to_string()))? {
        let line = record.position().map_or(0, csv::Position::line);
        for &(quantity, place) in &places {
            let value = number(record.get(place)).map_err(|reason| RideError::Line {
                file: file.to_owned(),
                line,
                column: Some(header[place].clone()),
                reason,
            })?;
            match quantity {
                Quantity::Time => table.time.push(value * conventions.time_unit.in_si()),
                _ => table.columns.entry(quantity).or_default().push(value),
            }
        }
        table.lines.push(line);
    }
    if table.time.len() < 2 {
        return Err(whole("has fewer than two samples below its header"));
    }
    Ok(table)
}

/// Which of comma, semicolon and tabulator there are most of in the first line that is no comment.
fn delimiter(bytes: &[u8]) -> u8 {
    let header = bytes.split(|&byte| byte == b'\n').find(|line| !line.starts_with(b"#")).unwrap_or_default();
    let count = |delimiter: u8| header.iter().filter(|&&byte| byte == delimiter).count();
    [b',', b';', b'\t'].into_iter().rev().max_by_key(|&delimiter| count(delimiter)).unwrap_or(b',')
}

/// A column's name without spaces around it and without a unit in brackets behind it.
fn bare(name: &str) -> String {
    let name = name.trim_start_matches('\u{feff}');
    let end = name.find(['[', '(']).filter(|&end| end > 0).unwrap_or(name.len());
    name[..end].trim().to_owned()
}

/// Where the columns are that the recording has.
fn places(file: &Path, header: &[String], conventions: &Conventions) -> Result<Vec<(Quantity, usize)>, RideError> {
    let mut places = Vec::new();
    for (quantity, key) in Quantity::ALL {
        let name = conventions.column(quantity);
        match header.iter().position(|present| present == name) {
            Some(place) => places.push((quantity, place)),
            None if quantity.is_required() || conventions.columns.contains_key(&quantity) => {
                return Err(RideError::NoColumn {
                    file: file.to_owned(),
                    key,
                    column: name.to_owned(),
                    present: header.to_vec(),
                    nearest: nearest(name, header.iter().map(String::as_str)).first().map(|&name| name.to_owned()),
                });
            }
            None => {}
        }
    }
    Ok(places)
}

/// A field's number, or what is wrong with it.
fn number(field: Option<&[u8]>) -> Result<f64, String> {
    let Some(field) = field else { return Err("is missing: the line has too few fields".to_owned()) };
    let text = String::from_utf8_lossy(field);
    let text = text.trim();
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err(format!("is {text}; cut this part off, or fill the gap with what was really felt")),
        Err(_) if text.is_empty() => {
            Err("is empty; cut this part off, or fill the gap with what was really felt".to_owned())
        }
        Err(_) if text.replace(',', ".").parse::<f64>().is_ok() => {
            Err(format!("is {text}; write numbers with a decimal point, not a comma"))
        }
        Err(_) => Err(format!("is \"{text}\", which is not a number")),
    }
}
