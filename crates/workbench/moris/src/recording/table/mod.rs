//! The numbers of a recording, column by column, in SI units.

pub mod join;
pub mod laps;
pub mod sampling;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use moris_washout::interface::STANDARD_GRAVITY;

use crate::recording::columns::{Column, Header};
use crate::recording::conventions::{Conventions, Gravity, Quantity};
use crate::recording::message::{RecordingError, quoted};
use crate::recording::read::sheet::Sheet;
use crate::recording::read::source;
use join::Part;

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
    /// Warnings, in whole sentences.
    pub warnings: Vec<String>,
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

    /// A table of columns of numbers in the file's units, `values` by their places.
    fn new(
        file: PathBuf,
        layout: Vec<Column>,
        (time, lines): (Vec<f64>, Vec<u64>),
        values: &BTreeMap<usize, Vec<f64>>,
        warnings: Vec<String>,
    ) -> Self {
        let sum = |column: &Column| -> Vec<f64> {
            let term = |place: usize, sample: usize| values.get(&place).map_or(0.0, |column| column[sample]);
            let at =
                |sample| column.terms.iter().map(|t| t.sign * term(t.place, sample)).sum::<f64>() * column.unit.in_si;
            (0..time.len()).map(at).collect()
        };
        let columns = layout
            .iter()
            .filter(|column| column.quantity != Quantity::Time)
            .map(|column| (column.quantity, sum(column)))
            .collect();
        Table { file, time, columns, layout, lines, warnings }
    }

    /// Adds the quantities that the recording lacks as at rest, with a warning.
    fn at_rest(mut self, conventions: &Conventions) -> Self {
        let is_missing = |quantity: &Quantity| {
            quantity.is_required() && *quantity != Quantity::Time && !self.columns.contains_key(quantity)
        };
        let missing: Vec<Quantity> = Quantity::ALL.into_iter().filter(is_missing).collect();
        for &quantity in &missing {
            let is_vertical = quantity == Quantity::Force(2) && conventions.gravity == Gravity::Included;
            let rest = if is_vertical { STANDARD_GRAVITY * conventions.axes.signs()[2] } else { 0.0 };
            self.columns.insert(quantity, vec![rest; self.time.len()]);
        }
        if !missing.is_empty() {
            let names = missing.iter().map(|quantity| quantity.key()).collect::<Vec<_>>().join(", ");
            self.warnings.push(format!("The recording has no {names}: they are taken as at rest."));
        }
        self
    }
}

/// Reads a recording of one file, of several joined by `+`, or of those in a directory.
///
/// # Errors
/// A file cannot be read or holds no samples, columns are missing, a unit contradicts an option, a
/// value is not a number, files do not overlap in time.
pub fn read(file: &Path, conventions: &Conventions) -> Result<Table, RecordingError> {
    let files = source::files(file)?;
    match &files[..] {
        [one] => of_file(one, conventions),
        _ => of_files(source::shown(file), &files, file.is_dir(), conventions),
    }
}

/// The recordings in files and directories. A directory in which several files have all columns is
/// so many recordings; any other is one.
pub fn recordings(paths: &[PathBuf], conventions: &Conventions) -> Vec<PathBuf> {
    let is_whole =
        |file: &PathBuf| Sheet::open(file, conventions).is_ok_and(|sheet| sheet.header.has_needed_columns(conventions));
    let of_path = |path: &PathBuf| {
        let files = if path.is_dir() { source::files(path).unwrap_or_default() } else { Vec::new() };
        let whole: Vec<PathBuf> = files.into_iter().filter(is_whole).collect();
        if whole.len() > 1 { whole } else { vec![path.clone()] }
    };
    paths.iter().flat_map(of_path).collect()
}

fn of_file(file: &Path, conventions: &Conventions) -> Result<Table, RecordingError> {
    let sheet = Sheet::open(file, conventions)?;
    let whole = |reason| RecordingError::Whole { file: sheet.file.clone(), reason };
    let mut layout = sheet.header.columns(conventions, sheet.has_written_times).map_err(whole)?;
    let time = sheet.time.ok_or_else(|| whole(format!("there is no column {}", conventions.column(Quantity::Time))))?;
    let unit = sheet.header.time_unit(time, sheet.has_written_times, conventions).map_err(whole)?;
    if sheet.has_written_times {
        layout.insert(0, join::time_column(time, unit));
    }
    let places = value_places(&layout);
    let samples = sheet.samples(&places, time, conventions)?;
    let mut part = Part::new(&sheet, samples, unit);
    let gaps = part.fill_gaps(&places)?;
    part.warnings.extend(gaps);
    let values = places.into_iter().zip(part.columns).collect();
    Ok(Table::new(sheet.file.clone(), layout, (part.time, part.lines), &values, part.warnings).at_rest(conventions))
}

/// Reads several files. Files of a directory that hold no column in use are passed over.
fn of_files(
    name: PathBuf,
    files: &[PathBuf],
    is_directory: bool,
    conventions: &Conventions,
) -> Result<Table, RecordingError> {
    let mut sheets = Vec::new();
    for file in files {
        match Sheet::open(file, conventions) {
            // A directory holds other files, too.
            Err(_) if is_directory => (),
            sheet => sheets.push((source::name(file), sheet?)),
        }
    }
    let header = Header::of_files(sheets.iter().map(|(name, sheet)| (name.as_str(), &sheet.header)));
    let layout =
        header.columns(conventions, true).map_err(|reason| RecordingError::Whole { file: name.clone(), reason })?;
    let mut parts = Vec::new();
    let mut first_place = 0;
    for (_, sheet) in &sheets {
        let width = sheet.header.width();
        let used = |place: &usize| (first_place..first_place + width).contains(place);
        let places: Vec<usize> = value_places(&layout).into_iter().filter(used).collect();
        let refused = |reason| RecordingError::Whole { file: sheet.file.clone(), reason };
        if !places.is_empty() {
            let time_name = conventions.column(Quantity::Time);
            let time = sheet.time.ok_or_else(|| refused(format!("there is no column {time_name}")))?;
            let unit = sheet.header.time_unit(time, sheet.has_written_times, conventions).map_err(refused)?;
            let own: Vec<usize> = places.iter().map(|place| place - first_place).collect();
            let mut part = Part::new(sheet, sheet.samples(&own, time, conventions)?, unit);
            let gaps = part.fill_gaps(&own)?;
            part.warnings.extend(gaps);
            parts.push((places, part));
        } else if !is_directory {
            return Err(refused("holds no column of the recording; leave it out".to_owned()));
        }
        first_place += width;
    }
    let base = layout.iter().find(|column| column.quantity == Quantity::Force(0)).map_or(0, |c| c.terms[0].place);
    let is_required = |place: usize| {
        layout.iter().any(|c| c.quantity.is_required() && c.terms.iter().any(|term| term.place == place))
    };
    let joined = join::by_time(&name, parts, base, conventions.resample.is_some(), is_required)?;
    Ok(Table::new(name, layout, (joined.time, joined.lines), &joined.values, joined.warnings).at_rest(conventions))
}

/// The places of all columns in use but the time, each once.
fn value_places(layout: &[Column]) -> Vec<usize> {
    let used = layout.iter().filter(|column| column.quantity != Quantity::Time);
    used.flat_map(|column| column.terms.iter().map(|term| term.place)).collect()
}

/// The recording in columns that are in memory already, by the rules for a file's: names, and units
/// in their brackets. `name` is what messages call it.
///
/// # Errors
/// As [`read`]; columns of different lengths.
pub fn of_columns(
    name: &str,
    columns: &[(String, Vec<f64>)],
    conventions: &Conventions,
) -> Result<Table, RecordingError> {
    let file = PathBuf::from(name);
    let whole = |reason: String| RecordingError::Whole { file: file.clone(), reason };
    let header = Header::new(columns.iter().map(|(title, _)| title.as_str()));
    let layout = header.columns(conventions, false).map_err(whole)?;
    let samples = layout.first().map_or(0, |column| columns[column.terms[0].place].1.len());
    if samples < 2 {
        return Err(whole("has fewer than two samples".to_owned()));
    }
    for term in layout.iter().flat_map(|column| &column.terms) {
        let (title, values) = &columns[term.place];
        if values.len() != samples {
            return Err(whole(format!("column {} has {} values, others have {samples}", quoted(title), values.len())));
        }
        if let Some(sample) = values.iter().position(|value| !value.is_finite()) {
            let reason = format!("is {}; cut this part off, or fill the gap with plausible values", values[sample]);
            let column = Some(quoted(title));
            return Err(RecordingError::Line { file: file.clone(), line: sample as u64 + 1, column, reason });
        }
    }
    let value = |place: usize| (place, columns[place].1.clone());
    let values = value_places(&layout).into_iter().map(value).collect();
    let time = layout.first().map_or_else(Vec::new, |column| {
        columns[column.terms[0].place].1.iter().map(|time| time * column.unit.in_si).collect()
    });
    let lines = (1..=samples as u64).collect();
    Ok(Table::new(file, layout, (time, lines), &values, Vec::new()).at_rest(conventions))
}
