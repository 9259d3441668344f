//! Errors of recordings, and quotations of the file.

mod error;

pub use error::RecordingError;

/// Longest text of a file that a message quotes \[characters\].
const LONGEST_QUOTE: usize = 40;

/// Text of a file for a message: shortened, and without control characters.
pub fn quoted(text: &str) -> String {
    let visible = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let mut quoted: String = text.chars().take(LONGEST_QUOTE).map(visible).collect();
    if text.chars().nth(LONGEST_QUOTE).is_some() {
        quoted.push('…');
    }
    quoted
}
