//! The column of a name, and the columns of a sum of names.

use super::Header;
use crate::message::Message;
use crate::recording::message::quoted;
use crate::texts::text;

/// A column of the file, and the factor with which it counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    pub factor: f64,
    /// Place in the line, from 0; of several files, in the line of all their columns.
    pub place: usize,
}

impl Header {
    /// The columns of `name`, or of `-name`, or of terms with spaces around their signs. A term may
    /// be multiplied or divided by a number.
    pub fn terms(&self, text: &str) -> Result<Option<Vec<Term>>, Message> {
        if let Some(place) = self.place(text)? {
            return Ok(Some(vec![Term { factor: 1.0, place }]));
        }
        let term = |(sign, part): (f64, &str)| {
            let (factor, name) = if self.place(part)?.is_some() { (1.0, part) } else { scale_and_name(part) };
            Ok(self.place(name)?.map(|place| Term { factor: sign * factor, place }))
        };
        signed_parts(text).into_iter().map(term).collect()
    }

    /// The place of a name: of the whole title, or of its part before the brackets, ignoring case.
    /// `name#2` is the second column with this name.
    ///
    /// # Errors
    /// Several columns have this name.
    pub fn place(&self, name: &str) -> Result<Option<usize>, Message> {
        let likenesses: Vec<_> = self.titles.iter().map(|title| title.likeness(name)).collect();
        let Some(best) = likenesses.iter().flatten().min() else { return Ok(self.numbered(name)) };
        let mut found = (0..self.width()).filter(|&place| likenesses[place].as_ref() == Some(best));
        match (found.next(), found.next()) {
            (Some(first), Some(second)) => Err(self.ambiguous(name, first, second)),
            (found, _) => Ok(found),
        }
    }

    /// The place of `name#2`.
    fn numbered(&self, name: &str) -> Option<usize> {
        let (name, number) = name.rsplit_once('#')?;
        let index = number.parse::<usize>().ok()?.checked_sub(1)?;
        (0..self.width()).filter(|&place| self.titles[place].likeness(name).is_some()).nth(index)
    }

    fn ambiguous(&self, name: &str, first: usize, second: usize) -> Message {
        let (one, other) = (self.shown(first), self.shown(second));
        let remedy = if self.titles[first].file != self.titles[second].file {
            text!["name-the-file"]
        } else if self.titles[first].full == self.titles[second].full {
            text!["number-the-column"]
        } else {
            text!["give-the-whole-name"]
        };
        let (name, first, second) = (quoted(name), self.number(first), self.number(second));
        text!["two-columns", name, one, first, other, second, remedy]
    }

    /// The column's place in its file, for messages: empty where there are several files.
    fn number(&self, place: usize) -> String {
        if self.titles[place].file.is_some() { String::new() } else { format!(" (column {})", place + 1) }
    }
}

/// The factor and the name of `name * 2`, `2 * name` and `name / 2`.
fn scale_and_name(part: &str) -> (f64, &str) {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite() && *number != 0.0);
    if let Some((name, divisor)) = part.rsplit_once(" / ")
        && let Some(divisor) = number(divisor)
    {
        return (1.0 / divisor, name.trim());
    }
    match part.split_once(" * ").map(|(a, b)| (a, number(a), b, number(b))) {
        Some((_, Some(factor), name, _)) | Some((name, _, _, Some(factor))) => (factor, name.trim()),
        _ => (1.0, part),
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
