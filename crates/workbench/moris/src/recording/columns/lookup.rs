//! The column of a name, and the columns of a sum of names.

use super::Header;
use crate::recording::message::{named, quoted};

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

    /// The place of a name: of the whole title, or of its part before the brackets, ignoring case.
    /// `name#2` is the second column with this name.
    ///
    /// # Errors
    /// Several columns have this name.
    pub fn place(&self, name: &str) -> Result<Option<usize>, String> {
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

    fn ambiguous(&self, name: &str, first: usize, second: usize) -> String {
        let (one, other) = (self.shown(first), self.shown(second));
        let remedy = if self.titles[first].file != self.titles[second].file {
            format!("give the file's name with it in {}", named("columns"))
        } else if self.titles[first].full == self.titles[second].full {
            format!("remove or rename one of them, or give its number with {}", named("columns"))
        } else {
            format!("give the whole name of one of them with {}, or rename one", named("columns"))
        };
        format!(
            "two columns are called {}: {one}{} and {other}{}; {remedy}",
            quoted(name),
            self.number(first),
            self.number(second)
        )
    }

    /// The column's place in its file, for messages: empty where there are several files.
    fn number(&self, place: usize) -> String {
        if self.titles[place].file.is_some() { String::new() } else { format!(" (column {})", place + 1) }
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
