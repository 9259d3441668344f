//! The column of a name.

use super::Header;
use crate::recording::message::{named, quoted};

impl Header {
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
