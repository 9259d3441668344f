//! The title of a column, taken apart.

use super::units::any_spelled;

/// The name of a column, and the unit in brackets behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct Title {
    /// The name of the file, where there are several.
    pub file: Option<String>,
    pub full: String,
    pub name: String,
    pub unit: Option<String>,
}

/// Likeness of a title and a name that is looked for, the best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Likeness {
    /// The name is the whole title.
    Whole,
    /// The name is the part before the brackets.
    BeforeUnit,
    /// The name is one of them in another case.
    OtherCase,
}

impl Title {
    /// Takes `ax [m/s2]` and `ax,m/s2` apart. Of several brackets, the first with a known unit
    /// counts, otherwise the last. The mark of a comment before the name is no part of it.
    pub fn new(full: &str) -> Self {
        let full = full.trim();
        let end = full.find(['[', '(']).filter(|&end| end > 0).unwrap_or(full.len());
        let behind = &full[end..];
        let (name, after_comma) = match full[..end].trim().split_once(',') {
            Some((name, unit)) => (name, Some(unit.trim())),
            None => (full[..end].trim(), None),
        };
        let bare = name.trim_start_matches(['#', '%']).trim();
        let name = if bare.is_empty() { name } else { bare };
        let brackets: Vec<&str> = behind
            .split(['[', '('])
            .skip(1)
            .filter_map(|part| Some(part[..part.find([']', ')'])?].trim()))
            // A number in brackets is an index.
            .filter(|unit| !unit.is_empty() && *unit != "-" && unit.parse::<usize>().is_err())
            .collect();
        let unit = brackets.iter().find(|unit| any_spelled(unit).is_some()).or(brackets.last()).copied();
        let unit = unit.or(after_comma.filter(|unit| any_spelled(unit).is_some()));
        Title { file: None, full: full.to_owned(), name: name.to_owned(), unit: unit.map(str::to_owned) }
    }

    /// The title with its file's name before it, where there are several files.
    pub fn qualified(&self, title: &str) -> String {
        self.file.as_ref().map_or_else(|| title.to_owned(), |file| format!("{file}.{title}"))
    }

    /// The likeness with a name, which may have the file's name before it; none if it is another
    /// column's.
    pub fn likeness(&self, name: &str) -> Option<Likeness> {
        let whole = [self.full.clone(), self.qualified(&self.full)];
        let short = [self.name.clone(), self.qualified(&self.name)];
        let in_other_case = |title: &String| title.to_lowercase() == name.to_lowercase();
        if whole.iter().any(|title| title == name) {
            Some(Likeness::Whole)
        } else if short.iter().any(|title| title == name) {
            Some(Likeness::BeforeUnit)
        } else {
            whole.iter().chain(&short).any(in_other_case).then_some(Likeness::OtherCase)
        }
    }
}
