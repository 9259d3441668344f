//! Files that are no CSV, by their first bytes.

use crate::recording::dialects::{DIALECTS, Foreign};

/// Part of a file in which a zero byte shows that it is no text \[bytes\].
pub const HEAD_SIZE: usize = 4096;

/// The remedy for a file that its first bytes show not to be CSV.
pub fn remedy(bytes: &[u8]) -> Option<&'static str> {
    const ZIP: &[u8] = b"PK\x03\x04";
    let head = &bytes[..bytes.len().min(HEAD_SIZE)];
    let contains = |part: &[u8]| head.windows(part.len()).any(|window| window == part);
    let text = head.trim_ascii_start();
    if head.starts_with(ZIP) {
        let is_of = |archive: &&Foreign| archive.is_marked(|name| name.is_empty() || contains(name));
        DIALECTS.archive.iter().find(is_of).map(|archive| archive.remedy.as_str())
    } else if let Some(found) = DIALECTS.binary.iter().find(|file| file.is_marked(|first| head.starts_with(first))) {
        Some(&found.remedy)
    } else if head.contains(&0) && utf_16(head).is_none() {
        Some("is no text but a binary file; export the recording as CSV from the program that wrote it")
    } else if text.starts_with(b"date ") && contains(b"base ") || text.starts_with(b"(") && contains(b") can") {
        Some(
            "is a log of CAN frames, which hold no signals by name; export the signals as CSV, in Python with cantools",
        )
    } else {
        let is_of = |file: &&Foreign| file.is_marked(|first| text.starts_with(first));
        DIALECTS.text.iter().find(is_of).map(|file| file.remedy.as_str())
    }
}

/// The order of the bytes of text in UTF-16, by its mark, or as every other byte of ASCII is zero.
pub fn utf_16(bytes: &[u8]) -> Option<fn([u8; 2]) -> u16> {
    let head = &bytes[..bytes.len().min(HEAD_SIZE) & !1];
    let zeros = |odd: usize| head.iter().skip(odd).step_by(2).filter(|&&byte| byte == 0).count();
    let is_zero = |many: usize, none: usize| head.len() >= 8 && none == 0 && many * 10 >= head.len() / 2 * 9;
    if head.starts_with(b"\xff\xfe") || is_zero(zeros(1), zeros(0)) {
        Some(u16::from_le_bytes)
    } else if head.starts_with(b"\xfe\xff") || is_zero(zeros(0), zeros(1)) {
        Some(u16::from_be_bytes)
    } else {
        None
    }
}
