//! The bytes of a recording: from a file or standard input, decompressed, and recognised as text.

use std::fs::{self, File};
use std::io::{self, Read, stdin};
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;

use crate::recording::message::RecordingError;

/// The argument that stands for standard input.
const STANDARD_INPUT: &str = "-";
/// Largest recording \[bytes\]. A day at 1 kHz with ten columns is 8 GB; an hour is 0.3 GB.
const LARGEST: u64 = 2_000_000_000;
/// Part of a file in which a zero byte shows that it is no text \[bytes\].
const HEAD: usize = 4096;

/// Files of one recording are joined by this sign.
const JOIN: char = '+';

/// The files of a recording: the file itself, those whose names are joined by +, or the CSV files
/// of a directory in the order of their names.
///
/// # Errors
/// The directory cannot be read, or holds no CSV file.
pub fn files(file: &Path) -> Result<Vec<PathBuf>, RecordingError> {
    if file.is_dir() {
        return files_in(file);
    }
    Ok(joined(file).unwrap_or_else(|| vec![file.to_owned()]))
}

/// The parts of a name that joins files; none if it is that of a file.
fn joined(file: &Path) -> Option<Vec<PathBuf>> {
    let text = file.to_str()?;
    (text.contains(JOIN) && !file.exists()).then(|| text.split(JOIN).map(PathBuf::from).collect())
}

fn files_in(directory: &Path) -> Result<Vec<PathBuf>, RecordingError> {
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
        let reason = "is a directory without CSV files".to_owned();
        return Err(RecordingError::Whole { file: directory.to_owned(), reason });
    }
    Ok(files)
}

/// The name of the recording in a file: without directory, `.csv` and `.gz`;
/// `stdin` for standard input.
pub fn name(file: &Path) -> String {
    if is_standard_input(file) {
        return "stdin".to_owned();
    }
    if let Some(files) = joined(file) {
        return files.iter().map(|file| name(file)).collect::<Vec<_>>().join("+");
    }
    if file.is_dir() {
        let directory = file.canonicalize().unwrap_or_else(|_| file.to_owned());
        return directory.file_name().unwrap_or_default().to_string_lossy().into_owned();
    }
    let is_packed = file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"));
    let stem = file.file_stem().map(PathBuf::from).unwrap_or_default();
    let stem = if is_packed { stem.file_stem().map(PathBuf::from).unwrap_or_default() } else { stem };
    stem.to_string_lossy().into_owned()
}

/// The file as messages name it.
pub fn shown(file: &Path) -> PathBuf {
    if is_standard_input(file) { PathBuf::from("standard input") } else { file.to_owned() }
}

fn is_standard_input(file: &Path) -> bool {
    file.as_os_str() == STANDARD_INPUT
}

/// The text of a recording, unpacked if it is compressed with gzip.
///
/// # Errors
/// The file cannot be read or unpacked, is too large, or is of a known format that is not
/// CSV: what to do about it.
pub fn text(file: &Path) -> Result<String, RecordingError> {
    let unreadable = |reason| RecordingError::Read { file: shown(file), reason };
    let refused = |reason: &str| RecordingError::Whole { file: shown(file), reason: reason.to_owned() };
    let content = |read: io::Result<Content>| match read.map_err(unreadable)? {
        Content::Bytes(bytes) => Ok(bytes),
        Content::Other(reason) => Err(refused(reason)),
        Content::TooLarge => Err(refused("is larger than 2 GB; cut it into parts")),
    };
    let mut bytes = content(if is_standard_input(file) {
        read_up_to(stdin().lock(), LARGEST)
    } else {
        File::open(file).and_then(|file| read_up_to(file, LARGEST))
    })?;
    if bytes.starts_with(GZIP) {
        bytes = content(read_up_to(MultiGzDecoder::new(&bytes[..]), LARGEST))?;
        if let Some(reason) = other_format(&bytes) {
            return Err(refused(reason));
        }
    }
    // Loggers that do not write UTF-8 write Latin-1, of which headers use ° and ².
    Ok(String::from_utf8(bytes).unwrap_or_else(|error| error.as_bytes().iter().map(|&byte| byte as char).collect()))
}

/// Contents of a source.
#[derive(Debug, PartialEq)]
enum Content {
    Bytes(Vec<u8>),
    /// The first bytes are those of a format that is not CSV; the reason says what to do.
    Other(&'static str),
    TooLarge,
}

/// First bytes of a file that is compressed with gzip.
const GZIP: &[u8] = &[0x1f, 0x8b];

/// Reads to the end, unless the first bytes or the size rule the source out. So a source without
/// an end fails.
fn read_up_to(mut source: impl Read, largest: u64) -> io::Result<Content> {
    let mut bytes = Vec::new();
    source.by_ref().take(HEAD as u64).read_to_end(&mut bytes)?;
    // A packed file is judged by what is in it.
    if let Some(reason) = other_format(&bytes).filter(|_| !bytes.starts_with(GZIP)) {
        return Ok(Content::Other(reason));
    }
    source.take((largest + 1).saturating_sub(bytes.len() as u64)).read_to_end(&mut bytes)?;
    Ok(if bytes.len() as u64 > largest { Content::TooLarge } else { Content::Bytes(bytes) })
}

/// The remedy for a file that its first bytes show not to be CSV.
fn other_format(bytes: &[u8]) -> Option<&'static str> {
    let head = &bytes[..bytes.len().min(HEAD)];
    let contains = |part: &[u8]| head.windows(part.len()).any(|window| window == part);
    let first = |magic: &[u8]| head.starts_with(magic);
    let text = head.trim_ascii_start();
    Some(if first(b"PK\x03\x04") && (contains(b"[Content_Types].xml") || contains(b"xl/")) {
        "is an Excel workbook; save the sheet as CSV"
    } else if first(b"PK\x03\x04") {
        "is a zip archive; unpack it and pass the CSV file in it"
    } else if first(b"\xd0\xcf\x11\xe0") {
        "is an old Excel workbook; save the sheet as CSV"
    } else if first(b"PAR1") {
        "is a Parquet file; convert it to CSV, in Python: pandas.read_parquet(FILE).to_csv(\"ride.csv\", index=False)"
    } else if first(b"MATLAB") {
        "is a MATLAB file; write its signals as CSV, in MATLAB: writetable(table(time, ax, ay, az, wx, wy, wz), 'ride.csv')"
    } else if first(b"\x89HDF") {
        "is an HDF5 file; write its signals as CSV, in Python with h5py"
    } else if first(b"MDF     ") || first(b"UnFinMF ") {
        "is an MDF measurement (MF4); export it as CSV, in Python: asammdf.MDF(FILE).export(\"csv\", \"ride\")"
    } else if first(b"SQLite format 3") {
        "is an SQLite database; export the table as CSV"
    } else if first(b"\xff\xfe") || first(b"\xfe\xff") || is_utf_16(head) {
        "is text in UTF-16; save it as UTF-8: iconv -f UTF-16 -t UTF-8 FILE > ride.csv"
    } else if first(b"\x28\xb5\x2f\xfd") || first(b"BZh") || first(b"\xfd7zXZ") || first(b"7z\xbc\xaf") {
        "is compressed; unpack it first, or compress it with gzip, which is read as it is"
    } else if head.contains(&0) {
        "is no text but a binary file; export the recording as CSV from the program that wrote it"
    } else if text.starts_with(b"<") {
        "is XML or HTML; export the recording as CSV"
    } else if text.starts_with(b"{") || text.starts_with(b"[{") {
        "is JSON; export the recording as CSV"
    } else {
        return None;
    })
}

/// Text in UTF-16 without a byte order mark: every other byte of ASCII is zero.
fn is_utf_16(head: &[u8]) -> bool {
    let head = &head[..head.len() & !1];
    let zeros = |odd: usize| head.iter().skip(odd).step_by(2).filter(|&&byte| byte == 0).count();
    head.len() >= 8
        && [(zeros(0), zeros(1)), (zeros(1), zeros(0))]
            .iter()
            .any(|&(many, none)| none == 0 && many * 10 >= head.len() / 2 * 9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_source_without_an_end_fails_at_a_size() {
        assert_eq!(read_up_to(io::repeat(b'1'), 1_000_000).unwrap(), Content::TooLarge);
        assert!(matches!(read_up_to(io::repeat(0), u64::MAX - 1).unwrap(), Content::Other(_)));
        for size in [0, HEAD - 1, HEAD, HEAD + 1, 10_000] {
            let text = vec![b'1'; size];
            assert_eq!(read_up_to(&text[..], 10_000).unwrap(), Content::Bytes(text));
        }
        assert_eq!(read_up_to(&[b'1'; 10_001][..], 10_000).unwrap(), Content::TooLarge);
    }
}
