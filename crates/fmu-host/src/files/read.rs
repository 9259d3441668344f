//! Whole files.

use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

use super::size::shown;

/// Largest text that a person writes, such as a rig or parameters \[bytes\].
pub const MAX_TEXT_SIZE: u64 = 16_000_000;

/// The text of a file of at most `largest` bytes.
///
/// # Errors
/// The file cannot be read, is no UTF-8, has zero bytes, or is larger, as one without an end.
pub fn text(file: &Path, largest: u64) -> io::Result<String> {
    let mut bytes = Vec::new();
    // A part at a time: a device of zeros is known by its first bytes.
    read_bounded(file, largest, &mut bytes, |part| {
        if part.contains(&0) { Some("it is no text: it has zero bytes") } else { None }
    })?;
    String::from_utf8(bytes).map_err(|_| refused("it is no text in UTF-8"))
}

/// The bytes of a file of at most `largest` bytes.
///
/// # Errors
/// The file cannot be read, or is larger.
pub fn bytes(file: &Path, largest: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    read_bounded(file, largest, &mut bytes, |_| None)?;
    Ok(bytes)
}

fn read_bounded(
    file: &Path,
    largest: u64,
    bytes: &mut Vec<u8>,
    fault: impl Fn(&[u8]) -> Option<&'static str>,
) -> io::Result<()> {
    // Part that is read at a time [bytes].
    const READ_CHUNK_SIZE: u64 = 1 << 20;
    let mut source = File::open(file)?.take(largest.saturating_add(1));
    loop {
        let before = bytes.len();
        source.by_ref().take(READ_CHUNK_SIZE).read_to_end(bytes)?;
        if let Some(reason) = fault(&bytes[before..]) {
            return Err(refused(reason));
        }
        if bytes.len() == before {
            return Ok(());
        }
        if bytes.len() as u64 > largest {
            return Err(refused(&format!("it is larger than {}", shown(largest))));
        }
    }
}

pub(crate) fn refused(reason: &str) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, reason)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_file_up_to_the_bound_is_read() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("a.toml");
        for size in [0, 1, 999, 1000] {
            fs::write(&file, vec![b'a'; size]).unwrap();
            assert_eq!(text(&file, 1000).unwrap().len(), size);
            assert_eq!(bytes(&file, 1000).unwrap().len(), size);
        }
        fs::write(&file, vec![b'a'; 1001]).unwrap();
        assert_eq!(text(&file, 1000).unwrap_err().to_string(), "it is larger than 1 kB");
        assert_eq!(bytes(&file, 1000).unwrap_err().to_string(), "it is larger than 1 kB");
        fs::write(&file, b"a\xff").unwrap();
        assert_eq!(text(&file, 1000).unwrap_err().to_string(), "it is no text in UTF-8");
        assert_eq!(bytes(&file, 1000).unwrap(), b"a\xff");
    }

    #[test]
    fn a_sparse_file_and_one_without_an_end_are_refused() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("sparse");
        File::create(&file).unwrap().set_len(1 << 40).unwrap();
        assert_eq!(text(&file, MAX_TEXT_SIZE).unwrap_err().to_string(), "it is no text: it has zero bytes");
        assert_eq!(bytes(&file, MAX_TEXT_SIZE).unwrap_err().to_string(), "it is larger than 16 MB");
        if cfg!(unix) {
            let zeros = Path::new("/dev/zero");
            assert_eq!(text(zeros, MAX_TEXT_SIZE).unwrap_err().to_string(), "it is no text: it has zero bytes");
            assert_eq!(bytes(zeros, MAX_TEXT_SIZE).unwrap_err().to_string(), "it is larger than 16 MB");
        }
    }
}
