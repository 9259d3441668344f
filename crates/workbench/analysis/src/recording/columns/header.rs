//! The header of a recording: the titles of its columns.

use super::title::Title;
use super::units::any_spelled;
use crate::recording::message::quoted;
use crate::recording::read::is_number;

/// The header of a recording, of one file or of several.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    pub(super) titles: Vec<Title>,
}

impl Header {
    pub fn new<'a>(titles: impl IntoIterator<Item = &'a str>) -> Self {
        Header { titles: titles.into_iter().map(Title::new).collect() }
    }

    /// The header of several files, each with its name.
    pub fn of_files<'a>(files: impl IntoIterator<Item = (&'a str, &'a Header)>) -> Self {
        let with_file = |(file, header): (&'a str, &'a Header)| {
            header.titles.iter().map(move |title| Title { file: Some(file.to_owned()), ..title.clone() })
        };
        Header { titles: files.into_iter().flat_map(with_file).collect() }
    }

    /// Number of columns.
    pub fn width(&self) -> usize {
        self.titles.len()
    }

    /// A column's name as messages quote it.
    pub fn shown(&self, place: usize) -> String {
        self.titles.get(place).map_or_else(String::new, |title| quoted(&title.qualified(&title.full)))
    }

    /// The unit of a column, as its title has it.
    pub fn unit_text(&self, place: usize) -> Option<&str> {
        self.titles.get(place)?.unit.as_deref()
    }

    /// Reads a line of units below the names. In it no field is a number, and at least one is a
    /// unit. Returns false and does not change the header if the line is not a line of units.
    pub fn take_units<'a>(&mut self, fields: impl Iterator<Item = &'a str> + Clone) -> bool {
        let bare = |field: &'a str| field.trim().trim_matches(['[', ']', '(', ')']);
        let is_unit = |field| any_spelled(bare(field)).is_some();
        if fields.clone().any(is_number) || !fields.clone().any(is_unit) {
            return false;
        }
        for (title, field) in self.titles.iter_mut().zip(fields) {
            if title.unit.is_none() && !bare(field).is_empty() && bare(field) != "-" {
                title.unit = Some(bare(field).to_owned());
            }
        }
        true
    }
}
