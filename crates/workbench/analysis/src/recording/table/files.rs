//! Tables of files.

use std::path::{Path, PathBuf};

use super::clocks::Clock;
use super::join::{self, Part};
use super::{Table, gaps, placeholders};
use crate::recording::columns::{Column, Header, UnitSource, value_places};
use crate::recording::conventions::Conventions;
use crate::recording::message::RecordingError;
use crate::recording::read::{Samples, Sheet, source};

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
    let columns = sheet.header.columns(conventions, sheet.has_written_times || conventions.rate.is_some());
    let layout = columns.map_err(|mut reason| {
        sheet.form().into_iter().for_each(|form| reason.push(form));
        sheet.refused(reason)
    })?;
    let mut samples = file_samples(&sheet, &value_places(&layout), &layout, conventions)?;
    let warnings = placeholders::warnings(&sheet, &samples, &layout, conventions);
    samples.warnings.extend(warnings);
    Table::new(sheet.file, layout, samples, conventions)
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
    let columns = header.columns(conventions, true);
    let layout = columns.map_err(|reason| RecordingError::whole(&name, reason))?;
    let places = value_places(&layout);
    let mut parts = Vec::new();
    let mut first = 0;
    for (_, sheet) in &sheets {
        let end = first + sheet.header.width();
        let used = places.iter().filter(|place| (first..end).contains(place));
        let own: Vec<usize> = used.map(|place| place - first).collect();
        if !own.is_empty() {
            let own_layout = from_place(&layout, first);
            let mut samples = file_samples(sheet, &own, &own_layout, conventions)?;
            samples.columns.iter_mut().for_each(|(place, _)| *place += first);
            parts.push(Part { file: sheet.file.clone(), samples });
        } else if !is_directory {
            return Err(sheet.refused("holds no column of the recording; leave it out"));
        }
        first = end;
    }
    let samples = join::by_time(&name, parts, &layout, conventions.resample.is_some())?;
    Table::new(name, layout, samples, conventions)
}

/// The layout with the places in the file whose columns begin at one.
fn from_place(layout: &[Column], first: usize) -> Vec<Column> {
    let mut own = layout.to_vec();
    for term in own.iter_mut().flat_map(|column| &mut column.terms) {
        term.place = term.place.wrapping_sub(first);
    }
    own
}

/// The samples of a file without gaps, with the time in seconds.
fn file_samples(
    sheet: &Sheet,
    places: &[usize],
    layout: &[Column],
    conventions: &Conventions,
) -> Result<Samples, RecordingError> {
    let mut samples = sheet.samples(places, conventions)?;
    if conventions.rate.is_none() {
        let terms = sheet.time.clone().ok_or_else(|| sheet.without_time(conventions))?;
        let (unit, source) = sheet.time_unit(&terms, conventions)?;
        let clock = Clock {
            time: &mut samples.time,
            unit: unit.in_si,
            factor: if let [one] = &terms[..] { one.factor } else { 1.0 },
            is_open: source == UnitSource::Default,
            is_written: sheet.has_written_times,
        };
        samples.warnings.extend(clock.into_seconds());
    }
    gaps::fill(&mut samples, (&sheet.file, &sheet.header), layout, conventions)?;
    Ok(samples)
}
