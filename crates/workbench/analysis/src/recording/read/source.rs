//! The files of a recording, and their names.

use std::fs;
use std::path::{Path, PathBuf};

use crate::recording::message::RecordingError;

/// The files of a recording: the file itself, those whose names are joined by +, or the CSV files
/// of a directory in the order of their names.
///
/// # Errors
/// The directory cannot be read, or holds no CSV file.
pub fn files(file: &Path) -> Result<Vec<PathBuf>, RecordingError> {
    if file.is_dir() {
        return files_in(file);
    }
    Ok(joined_files(file).unwrap_or_else(|| vec![file.to_owned()]))
}

/// The parts of a name that joins files; none if it is that of a file.
fn joined_files(file: &Path) -> Option<Vec<PathBuf>> {
    // Files of one recording are joined by this sign.
    const JOIN: char = '+';
    let text = file.to_str()?;
    (text.contains(JOIN) && !file.exists()).then(|| text.split(JOIN).map(PathBuf::from).collect())
}

/// The files of recordings in a directory, by name: CSV, also packed, and Racelogic's.
///
/// # Errors
/// The directory cannot be read, or holds no CSV file.
pub fn files_in(directory: &Path) -> Result<Vec<PathBuf>, RecordingError> {
    let unreadable = |reason| RecordingError::Read { file: directory.to_owned(), reason };
    let is_csv = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        path.is_file() && [".csv", ".csv.gz", ".vbo"].iter().any(|end| name.ends_with(end))
    };
    let entries: Result<Vec<PathBuf>, _> =
        fs::read_dir(directory).map_err(unreadable)?.map(|entry| entry.map(|entry| entry.path())).collect();
    let mut files: Vec<PathBuf> = entries.map_err(unreadable)?.into_iter().filter(is_csv).collect();
    files.sort();
    if files.is_empty() {
        return Err(RecordingError::whole(directory, "is a directory without CSV files (*.csv, *.csv.gz, *.vbo)"));
    }
    Ok(files)
}

/// The name of the recording in a file: without directory, `.csv` and `.gz`;
/// `stdin` for standard input.
pub fn name(file: &Path) -> String {
    if is_standard_input(file) {
        return "stdin".to_owned();
    }
    if let Some(files) = joined_files(file) {
        return files.iter().map(|file| name(file)).collect::<Vec<_>>().join("+");
    }
    if file.is_dir() {
        let directory = file.canonicalize().unwrap_or_else(|_| file.to_owned());
        return directory.file_name().unwrap_or_default().to_string_lossy().into_owned();
    }
    let is_packed = file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"));
    let unpacked = if is_packed { file.with_extension("") } else { file.to_owned() };
    unpacked.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The file as messages name it.
pub fn shown(file: &Path) -> PathBuf {
    if is_standard_input(file) { PathBuf::from("standard input") } else { file.to_owned() }
}

/// True for the argument that stands for standard input.
pub fn is_standard_input(file: &Path) -> bool {
    // The argument that stands for standard input.
    const STANDARD_INPUT: &str = "-";
    file.as_os_str() == STANDARD_INPUT
}
