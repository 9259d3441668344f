//! The columns of a recording: which is which quantity, and in which unit.

use std::collections::BTreeMap;
use std::path::Path;

use moris_setup::nearest;

use super::RideError;
use super::conventions::{Conventions, Quantity};
use super::units::{Dimension, Unit, any_spelled};

/// Longest text of a file that a message quotes \[characters\].
const LONGEST_QUOTE: usize = 40;
/// Most columns that a message lists.
const MOST_LISTED: usize = 30;

/// The source of a column's unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitSource {
    /// The column's name, or the line of units below it.
    Header,
    /// An option, or the file of conventions.
    Option,
    /// Neither.
    Default,
}

/// A column that is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    pub quantity: Quantity,
    /// Place in the line, from 0.
    pub place: usize,
    pub unit: Unit,
    pub source: UnitSource,
}

/// The header of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    titles: Vec<Title>,
}

/// The name of a column, and the unit in brackets behind it.
#[derive(Clone, Debug, PartialEq)]
struct Title {
    full: String,
    name: String,
    unit: Option<String>,
}

impl Title {
    /// Takes `ax [m/s2]` apart. Of several brackets, the first with a known unit
    /// counts, otherwise the last.
    fn new(full: &str) -> Self {
        let full = full.trim();
        let name = match full.find(['[', '(']) {
            Some(end) if end > 0 => full[..end].trim(),
            _ => full,
        };
        let brackets: Vec<&str> = full[name.len()..]
            .split(['[', '('])
            .skip(1)
            .filter_map(|part| Some(part[..part.find([']', ')'])?].trim()))
            .filter(|unit| !unit.is_empty() && *unit != "-")
            .collect();
        let unit = brackets.iter().find(|unit| any_spelled(unit).is_some()).or(brackets.last());
        Title { full: full.to_owned(), name: name.to_owned(), unit: unit.map(|&unit| unit.to_owned()) }
    }
}

impl Header {
    pub fn new<'a>(titles: impl IntoIterator<Item = &'a str>) -> Self {
        Header { titles: titles.into_iter().map(Title::new).collect() }
    }

    /// Number of columns.
    pub fn width(&self) -> usize {
        self.titles.len()
    }

    /// True where no column has a name.
    pub fn is_blank(&self) -> bool {
        self.titles.iter().all(|title| title.full.is_empty())
    }

    /// True where numbers stand in place of names.
    pub fn is_numbers(&self) -> bool {
        self.titles.iter().all(|title| title.full.is_empty() || title.full.parse::<f64>().is_ok())
    }

    /// A column's name as messages quote it.
    pub fn shown(&self, place: usize) -> String {
        self.titles.get(place).map_or_else(String::new, |title| quoted(&title.full))
    }

    /// Takes a line of units below the names: no field is a number, and one at least is a unit.
    /// Returns false and leaves the header alone if the line is none.
    pub fn take_units<'a>(&mut self, fields: impl Iterator<Item = &'a str> + Clone) -> bool {
        let bare = |field: &'a str| field.trim().trim_matches(['[', ']', '(', ')']);
        if fields.clone().any(|field| field.trim().replace(',', ".").parse::<f64>().is_ok())
            || !fields.clone().any(|field| any_spelled(bare(field)).is_some())
        {
            return false;
        }
        for (title, field) in self.titles.iter_mut().zip(fields) {
            if title.unit.is_none() && !bare(field).is_empty() && bare(field) != "-" {
                title.unit = Some(bare(field).to_owned());
            }
        }
        true
    }

    /// True where every column is there that a recording needs.
    pub fn has_needed_columns(&self, conventions: &Conventions) -> bool {
        let mut needed = Quantity::ALL.iter().filter(|(quantity, _)| quantity.is_required());
        needed.all(|&(quantity, _)| !matches!(self.place(conventions.column(quantity)), Ok(None)))
    }

    /// The columns that are used.
    ///
    /// # Errors
    /// Columns are missing, all of which are named; a name stands twice; a column is given for two
    /// quantities; a unit is unknown, or contradicts an option.
    pub fn columns(&self, file: &Path, conventions: &Conventions) -> Result<Vec<Column>, RideError> {
        let refused = |reason: String| RideError::Whole { file: file.to_owned(), reason };
        let places = self.places(file, conventions)?;
        let mut columns = Vec::new();
        for (quantity, place) in places {
            let (unit, source) = self.unit(place, quantity.dimension(), conventions).map_err(refused)?;
            columns.push(Column { quantity, place, unit, source });
        }
        self.check_units_are_complete(&columns).map_err(refused)?;
        Ok(columns)
    }

    fn places(&self, file: &Path, conventions: &Conventions) -> Result<Vec<(Quantity, usize)>, RideError> {
        let mut used: BTreeMap<usize, Quantity> = BTreeMap::new();
        let mut places = Vec::new();
        let mut missing = Vec::new();
        for (quantity, key) in Quantity::ALL {
            let name = conventions.column(quantity);
            let place = self.place(name).map_err(|reason| RideError::Whole { file: file.to_owned(), reason })?;
            let is_needed = quantity.is_required() || conventions.columns.contains_key(&quantity);
            match place {
                Some(place) => {
                    if let Some(other) = used.insert(place, quantity) {
                        let reason = format!(
                            "column {} is given for both {} and {key}; give each a column of its own with --columns",
                            self.shown(place),
                            other.key()
                        );
                        return Err(RideError::Whole { file: file.to_owned(), reason });
                    }
                    places.push((quantity, place));
                }
                None if is_needed => missing.push((key, name)),
                None => (),
            }
        }
        if missing.is_empty() { Ok(places) } else { Err(self.missing(file, &missing)) }
    }

    /// The place of a name: of the whole title, or of what stands before its brackets, in any case.
    fn place(&self, name: &str) -> Result<Option<usize>, String> {
        let matches: [&dyn Fn(&Title) -> bool; 4] = [
            &|title| title.full == name,
            &|title| title.name == name,
            &|title| title.full.to_lowercase() == name.to_lowercase(),
            &|title| title.name.to_lowercase() == name.to_lowercase(),
        ];
        for is_match in matches {
            let found: Vec<usize> = (0..self.width()).filter(|&place| is_match(&self.titles[place])).collect();
            match found[..] {
                [] => (),
                [place] => return Ok(Some(place)),
                [first, second, ..] => {
                    let (one, other) = (self.shown(first), self.shown(second));
                    let remedy = if self.titles[first].full == self.titles[second].full {
                        "remove or rename one of them"
                    } else {
                        "give the whole name of one of them with --columns, or rename one"
                    };
                    return Err(format!(
                        "two columns are called {}: {one} (column {}) and {other} (column {}); {remedy}",
                        quoted(name),
                        first + 1,
                        second + 1
                    ));
                }
            }
        }
        Ok(None)
    }

    fn missing(&self, file: &Path, missing: &[(&str, &str)]) -> RideError {
        let names = || self.titles.iter().map(|title| title.name.as_str());
        let like = |name: &str| {
            let like = nearest(name, names()).first().map(|&like| format!(" (is it {}?)", quoted(like)));
            format!("{}{}", quoted(name), like.unwrap_or_default())
        };
        let wanted: Vec<String> = missing.iter().map(|(_, name)| like(name)).collect();
        let mut present: Vec<String> = (0..self.width()).take(MOST_LISTED).map(|place| self.shown(place)).collect();
        if self.width() > MOST_LISTED {
            present.push(format!("{} more", self.width() - MOST_LISTED));
        }
        let keys: Vec<String> = missing.iter().map(|(key, _)| format!("{key}=NAME")).collect();
        let reason = format!(
            "there {} no column{} {}; there are {}; name what is called otherwise with --columns {}",
            if wanted.len() == 1 { "is" } else { "are" },
            if wanted.len() == 1 { "" } else { "s" },
            wanted.join(", "),
            present.join(", "),
            keys.join(",")
        );
        RideError::Whole { file: file.to_owned(), reason }
    }

    /// The unit of a column: the header's, the option's, or the default, in this order.
    fn unit(
        &self,
        place: usize,
        dimension: Dimension,
        conventions: &Conventions,
    ) -> Result<(Unit, UnitSource), String> {
        let given = conventions.unit(dimension);
        let option = dimension.option();
        let title = self.shown(place);
        let Some(text) = &self.titles[place].unit else {
            return Ok(match given {
                Some(unit) => (unit, UnitSource::Option),
                None => (dimension.default_unit(), UnitSource::Default),
            });
        };
        match (dimension.spelled(text), given) {
            (Some(unit), Some(given)) if unit != given => Err(format!(
                "column {title} is in {} by its header, but {option} gives {}; leave {option} out, or correct the header",
                unit.word, given.word
            )),
            (Some(unit), _) => Ok((unit, UnitSource::Header)),
            (None, _) if any_spelled(text).is_some() => Err(format!(
                "column {title} is in {} by its header, which is no unit of {}; is it another quantity? \
                 Name the right column with --columns",
                quoted(text),
                dimension.name()
            )),
            (None, Some(given)) => Ok((given, UnitSource::Option)),
            (None, None) => Err(format!(
                "column {title} has the unit {}, which is not known; known are {}; convert the column, or give its unit \
                 with {option}",
                quoted(text),
                dimension.words().join(", ")
            )),
        }
    }

    /// Columns of one dimension state their units all or not at all: what the header leaves open
    /// beside a unit that is not the default is not guessed.
    fn check_units_are_complete(&self, columns: &[Column]) -> Result<(), String> {
        for dimension in Dimension::ALL {
            let of = |source| {
                columns.iter().filter(move |column| column.quantity.dimension() == dimension && column.source == source)
            };
            let open: Vec<String> = of(UnitSource::Default).map(|column| self.shown(column.place)).collect();
            let stated = of(UnitSource::Header).find(|column| column.unit != dimension.default_unit());
            if let Some(stated) = stated.filter(|_| !open.is_empty()) {
                return Err(format!(
                    "column {} is in {} by its header, but {} without a unit; write the unit into the header of each",
                    self.shown(stated.place),
                    stated.unit.word,
                    match &open[..] {
                        [one] => format!("{one} is"),
                        many => format!("{} are", many.join(", ")),
                    }
                ));
            }
        }
        Ok(())
    }
}

/// Text of a file for a message: short, and without anything that a terminal would obey.
pub fn quoted(text: &str) -> String {
    let visible = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let mut quoted: String = text.chars().take(LONGEST_QUOTE).map(visible).collect();
    if text.chars().nth(LONGEST_QUOTE).is_some() {
        quoted.push('…');
    }
    quoted
}
