//! Text files that people write: of conventions, votes, platforms, sessions.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Largest text file \[bytes\]. A session of a day is smaller.
const LARGEST: u64 = 200_000_000;
/// Part that is read at a time \[bytes\].
const PART: u64 = 1 << 20;

/// The text of a file.
///
/// # Errors
/// The file cannot be read, is no UTF-8, or is larger than 200 MB, as one without an end.
pub fn read(file: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    let mut source = File::open(file)?.take(LARGEST + 1);
    // A part at a time: a device of zeros is known by its first bytes.
    let refused = |reason| io::Error::new(io::ErrorKind::InvalidData, reason);
    loop {
        let before = bytes.len();
        source.by_ref().take(PART).read_to_end(&mut bytes)?;
        if bytes[before..].contains(&0) {
            return Err(refused("it is no text: it has zero bytes"));
        }
        if bytes.len() == before {
            break;
        }
    }
    if bytes.len() as u64 > LARGEST {
        return Err(refused("it is larger than 200 MB"));
    }
    String::from_utf8(bytes).map_err(|_| refused("it is no text in UTF-8"))
}
