//! Sums of columns.

use super::Header;

/// A column of the file, and the sign with which it counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    pub sign: f64,
    /// Place in the line, from 0; of several files, in the line of all their columns.
    pub place: usize,
}

impl Header {
    /// The columns of `name`, or of `-name`, or of terms with spaces around their signs.
    pub(super) fn terms(&self, text: &str) -> Result<Option<Vec<Term>>, String> {
        if let Some(place) = self.place(text)? {
            return Ok(Some(vec![Term { sign: 1.0, place }]));
        }
        let term = |(sign, name): (f64, &str)| Ok(self.place(name)?.map(|place| Term { sign, place }));
        signed_parts(text).into_iter().map(term).collect()
    }
}

/// The names in a sum, each with its sign: `-a + b`, with spaces around the signs between names.
fn signed_parts(text: &str) -> Vec<(f64, &str)> {
    let mut parts = Vec::new();
    let (mut sign, mut rest) = match text.trim().strip_prefix(['-', '+']) {
        Some(rest) => (if text.trim().starts_with('-') { -1.0 } else { 1.0 }, rest),
        None => (1.0, text),
    };
    while let Some(end) = [" + ", " - "].iter().filter_map(|mark| rest.find(mark)).min() {
        parts.push((sign, rest[..end].trim()));
        sign = if rest[end..].starts_with(" - ") { -1.0 } else { 1.0 };
        rest = &rest[end + 3..];
    }
    parts.push((sign, rest.trim()));
    parts
}
