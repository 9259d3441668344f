//! The text of a file or of standard input, decompressed.

use std::fs::File;
use std::io::{self, Read, stdin};
use std::path::Path;

use flate2::read::MultiGzDecoder;

use super::foreign;
use super::source::{is_standard_input, shown};
use crate::recording::message::RecordingError;

/// Largest recording \[bytes\]: an hour at 1 kHz with ten columns is 0.3 GB.
const MAX_RECORDING_SIZE: u64 = 400_000_000;
const TOO_LARGE: &str = "is larger than 400 MB; cut it into parts";
/// First bytes of a file that is compressed with gzip.
const GZIP_MAGIC: &[u8] = &[0x1f, 0x8b];

/// Bytes, or the reason why they are no text.
type Bytes = Result<Vec<u8>, &'static str>;

/// The text of a recording.
#[derive(Debug)]
pub struct Text {
    pub text: String,
    /// True where zero bytes follow, as loggers leave them that lose power, and sparse files.
    pub is_cut: bool,
}

/// The text of a recording, unpacked if it is compressed with gzip.
///
/// # Errors
/// The file cannot be read or unpacked, is too large, or is of a known format that is not
/// CSV: what to do about it.
pub fn text(file: &Path) -> Result<Text, RecordingError> {
    let refused = |reason| RecordingError::whole(&shown(file), reason);
    let usable = |read: io::Result<Bytes>| {
        read.map_err(|reason| RecordingError::Read { file: shown(file), reason })?.map_err(refused)
    };
    let mut bytes = usable(if is_standard_input(file) {
        read_up_to(stdin().lock(), MAX_RECORDING_SIZE)
    } else {
        File::open(file).and_then(|file| read_up_to(file, MAX_RECORDING_SIZE))
    })?;
    if bytes.starts_with(GZIP_MAGIC) {
        bytes = usable(read_up_to(MultiGzDecoder::new(&bytes[..]), MAX_RECORDING_SIZE))?;
        foreign::remedy(&bytes).map_or(Ok(()), |reason| Err(refused(reason)))?;
    }
    if let Some(order) = foreign::utf_16(&bytes) {
        let units = bytes.chunks_exact(2).map(|pair| order([pair[0], pair[1]]));
        bytes = char::decode_utf16(units).map(|c| c.unwrap_or('\u{fffd}')).collect::<String>().into_bytes();
    }
    let end = bytes.iter().position(|&byte| byte == 0);
    bytes.truncate(end.unwrap_or(bytes.len()));
    // Loggers that do not write UTF-8 write Latin-1, of which headers use ° and ².
    let text = String::from_utf8(bytes);
    let mut text = text.unwrap_or_else(|error| error.as_bytes().iter().map(|&byte| byte as char).collect());
    // Lines that end as on old computers, perhaps but for the last.
    if text.matches('\r').count() > 1 && text.matches('\n').count() <= 1 {
        text = text.replace("\r\n", "\n").replace('\r', "\n");
    }
    Ok(Text { text, is_cut: end.is_some() })
}

/// Reads to the end, or to the first zero byte of what is text before it. So a source
/// without an end fails.
fn read_up_to(mut source: impl Read, largest: u64) -> io::Result<Bytes> {
    // Bytes that are read at a time.
    const PART: u64 = 1 << 20;
    let mut bytes = Vec::new();
    source.by_ref().take(foreign::HEAD_SIZE as u64).read_to_end(&mut bytes)?;
    // A packed file is judged by what is in it.
    let is_packed = bytes.starts_with(GZIP_MAGIC) || foreign::utf_16(&bytes).is_some();
    if let Some(reason) = foreign::remedy(&bytes).filter(|_| !is_packed) {
        return Ok(Err(reason));
    }
    let mut source = source.take((largest + 1).saturating_sub(bytes.len() as u64));
    loop {
        let before = bytes.len();
        source.by_ref().take(PART).read_to_end(&mut bytes)?;
        if bytes.len() == before || !is_packed && bytes[before..].contains(&0) {
            break;
        }
    }
    Ok(if bytes.len() as u64 > largest { Err(TOO_LARGE) } else { Ok(bytes) })
}

#[cfg(test)]
mod tests {
    use super::foreign::HEAD_SIZE;
    use super::*;

    #[test]
    fn a_source_without_an_end_fails_at_a_size() {
        assert_eq!(read_up_to(io::repeat(b'1'), 1_000_000).unwrap(), Err(TOO_LARGE));
        assert!(read_up_to(io::repeat(0), u64::MAX - 1).unwrap().is_err());
        // Text before zeros without an end.
        let text = vec![b'1'; HEAD_SIZE];
        assert!(read_up_to(text.as_slice().chain(io::repeat(0)), u64::MAX - 1).unwrap().is_ok());
        for size in [0, HEAD_SIZE - 1, HEAD_SIZE, HEAD_SIZE + 1, 10_000] {
            let text = vec![b'1'; size];
            assert_eq!(read_up_to(&text[..], 10_000).unwrap(), Ok(text));
        }
        assert_eq!(read_up_to(&[b'1'; 10_001][..], 10_000).unwrap(), Err(TOO_LARGE));
    }
}
