//! The columns of a recording, with their quantities and units.

use std::collections::BTreeMap;
use std::path::Path;

use clap::ValueEnum;
use moris_setup::nearest;

use super::units::{Dimension, TimeUnit, Unit, any_spelled};
use crate::recording::conventions::{Conventions, Format, Missing, Mounting, Quantity};
use crate::recording::message::{RecordingError, given, named};

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

/// A column of the file, and the sign with which it counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    pub sign: f64,
    /// Place in the line, from 0; of several files, in the line of all their columns.
    pub place: usize,
}

/// A quantity of the file: the sum of columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    pub quantity: Quantity,
    pub terms: Vec<Term>,
    pub unit: Unit,
    pub source: UnitSource,
}

/// The header of a recording, of one file or of several.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    titles: Vec<Title>,
}

/// The name of a column, and the unit in brackets behind it.
#[derive(Clone, Debug, PartialEq)]
struct Title {
    /// The name of the file, where there are several.
    file: Option<String>,
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
            // A number in brackets is an index.
            .filter(|unit| !unit.is_empty() && *unit != "-" && unit.parse::<usize>().is_err())
            .collect();
        let unit = brackets.iter().find(|unit| any_spelled(unit).is_some()).or(brackets.last());
        Title { file: None, full: full.to_owned(), name: name.to_owned(), unit: unit.map(|&unit| unit.to_owned()) }
    }

    /// The title with its file's name before it, where there are several files.
    fn qualified(&self, title: &str) -> String {
        self.file.as_ref().map_or_else(|| title.to_owned(), |file| format!("{file}.{title}"))
    }

    /// True if the name is this title or its part before the brackets, with or
    /// without its file's name.
    fn is_called(&self, name: &str, is_same: fn(&str, &str) -> bool) -> bool {
        let titles = [&self.full, &self.name];
        titles.into_iter().any(|title| is_same(title, name) || is_same(&self.qualified(title), name))
    }
}

impl Header {
    pub fn new<'a>(titles: impl IntoIterator<Item = &'a str>) -> Self {
        Header { titles: titles.into_iter().map(Title::new).collect() }
    }

    /// The header of several files, each with its name.
    pub fn of_files<'a>(files: impl IntoIterator<Item = (&'a str, &'a Header)>) -> Self {
        let named = |file: &'a str, header: &'a Header| {
            header.titles.iter().map(move |title| Title { file: Some(file.to_owned()), ..title.clone() })
        };
        Header { titles: files.into_iter().flat_map(|(file, header)| named(file, header)).collect() }
    }

    /// Number of columns.
    pub fn width(&self) -> usize {
        self.titles.len()
    }

    /// True where no column has a name.
    pub fn is_blank(&self) -> bool {
        self.titles.iter().all(|title| title.full.is_empty())
    }

    /// True if the header has numbers in place of names.
    pub fn is_numbers(&self) -> bool {
        self.titles.iter().all(|title| title.full.is_empty() || title.full.parse::<f64>().is_ok())
    }

    /// A column's name as messages quote it.
    pub fn shown(&self, place: usize) -> String {
        self.titles.get(place).map_or_else(String::new, |title| quoted(&title.qualified(&title.full)))
    }

    /// The column's place in its file, for messages: empty where there are several files.
    fn number(&self, place: usize) -> String {
        if self.titles[place].file.is_some() { String::new() } else { format!(" (column {})", place + 1) }
    }

    /// Reads a line of units below the names. In it no field is a number, and at least one is a
    /// unit. Returns false and does not change the header if the line is not a line of units.
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

    /// True if all required columns exist.
    pub fn has_needed_columns(&self, conventions: &Conventions) -> bool {
        let is_needed = |quantity: Quantity| quantity.is_required() && !is_at_rest(quantity, conventions);
        let mut needed = Quantity::ALL.iter().filter(|(quantity, _)| is_needed(*quantity));
        needed.all(|&(quantity, _)| !matches!(self.terms(conventions.column(quantity)), Ok(None)))
    }

    /// The columns that are used. `skips_time` is set where each of several files has its own time.
    ///
    /// # Errors
    /// - Columns are missing. The message names all of them.
    /// - A name occurs twice, or a column is given for two quantities.
    /// - A unit is unknown, or contradicts an option.
    pub fn columns(
        &self,
        file: &Path,
        conventions: &Conventions,
        skips_time: bool,
    ) -> Result<Vec<Column>, RecordingError> {
        let refused = |reason: String| RecordingError::Whole { file: file.to_owned(), reason };
        let mut columns = Vec::new();
        for (quantity, terms) in self.places(file, conventions, skips_time)? {
            let (unit, source) = self.unit_of_sum(&terms, quantity.dimension(), conventions).map_err(refused)?;
            columns.push(Column { quantity, terms, unit, source });
        }
        self.check_units_are_complete(&columns).map_err(refused)?;
        Ok(columns)
    }

    fn places(
        &self,
        file: &Path,
        conventions: &Conventions,
        skips_time: bool,
    ) -> Result<Vec<(Quantity, Vec<Term>)>, RecordingError> {
        let refused = |reason: String| RecordingError::Whole { file: file.to_owned(), reason };
        let mut used: BTreeMap<usize, Quantity> = BTreeMap::new();
        let mut places = Vec::new();
        let mut missing = Vec::new();
        let mut ambiguous = None;
        for (quantity, key) in Quantity::ALL {
            if quantity == Quantity::Time && skips_time {
                continue;
            }
            let name = conventions.column(quantity);
            let is_needed = quantity.is_required() || conventions.columns.contains_key(&quantity);
            let terms = self.terms(name).unwrap_or_else(|reason| {
                ambiguous.get_or_insert(reason);
                Some(Vec::new())
            });
            match terms {
                Some(terms) => {
                    for term in &terms {
                        if let Some(other) = used.insert(term.place, quantity) {
                            return Err(refused(format!(
                                "column {} is given for both {} and {key}; give each a column of its own with {}",
                                self.shown(term.place),
                                other.key(),
                                named("columns")
                            )));
                        }
                    }
                    places.push((quantity, terms));
                }
                // Speed helps formats that have it, and no format needs it.
                None if is_at_rest(quantity, conventions) => (),
                None if is_needed && (quantity != Quantity::Speed || conventions.format.is_none()) => {
                    missing.push((key, name));
                }
                None => (),
            }
        }
        match (&missing[..], ambiguous) {
            ([], None) => Ok(places),
            ([], Some(reason)) => Err(refused(reason)),
            (missing, _) => Err(self.missing(file, missing)),
        }
    }

    /// The columns of `name`, or of `-name`, or of terms with spaces around their signs.
    fn terms(&self, text: &str) -> Result<Option<Vec<Term>>, String> {
        if let Some(place) = self.place(text)? {
            return Ok(Some(vec![Term { sign: 1.0, place }]));
        }
        let parts = signed_parts(text);
        if parts.len() == 1 && parts[0].1 == text {
            return Ok(None);
        }
        let term = |(sign, name): (f64, &str)| Ok(self.place(name)?.map(|place| Term { sign, place }));
        parts.into_iter().map(term).collect()
    }

    /// The index of a name: of the whole title, or of its part before the brackets, ignoring case.
    /// `name#2` is the second column with this name.
    ///
    /// # Errors
    /// Several columns have this name.
    pub fn place(&self, name: &str) -> Result<Option<usize>, String> {
        let matches: [&dyn Fn(&Title) -> bool; 3] = [
            &|title| title.full == name || title.qualified(&title.full) == name,
            &|title| title.is_called(name, |title, name| title == name),
            &|title| title.is_called(name, |title, name| title.to_lowercase() == name.to_lowercase()),
        ];
        for is_match in matches {
            let found: Vec<usize> = (0..self.width()).filter(|&place| is_match(&self.titles[place])).collect();
            match found[..] {
                [] => (),
                [place] => return Ok(Some(place)),
                [first, second, ..] => return Err(self.ambiguous(name, first, second)),
            }
        }
        let numbered = name.rsplit_once('#').and_then(|(name, number)| Some((name, number.parse::<usize>().ok()?)));
        Ok(numbered.and_then(|(name, number)| {
            let is_same = |title: &str, name: &str| title.to_lowercase() == name.to_lowercase();
            (0..self.width()).filter(|&place| self.titles[place].is_called(name, is_same)).nth(number.checked_sub(1)?)
        }))
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

    fn missing(&self, file: &Path, missing: &[(&str, &str)]) -> RecordingError {
        let names = || self.titles.iter().map(|title| title.name.as_str());
        let format = Format::value_variants().iter().find(|format| self.is_of(**format));
        if let Some(format) = format {
            let names = missing.iter().map(|(_, name)| quoted(name)).collect::<Vec<_>>().join(", ");
            let (title, remedy) = (format.title(), given("format", format.word()));
            let reason = format!("this looks like a recording of {title}; use {remedy} (there is no column {names})");
            return RecordingError::Whole { file: file.to_owned(), reason };
        }
        let like = |name: &str| {
            let like = nearest(name, names()).first().map(|&like| format!(" (is it {}?)", quoted(like)));
            format!("{}{}", quoted(name), like.unwrap_or_default())
        };
        let expected: Vec<String> = missing.iter().map(|(_, name)| like(name)).collect();
        let mut present: Vec<String> = (0..self.width()).take(MOST_LISTED).map(|place| self.shown(place)).collect();
        if self.width() > MOST_LISTED {
            present.push(format!("{} more", self.width() - MOST_LISTED));
        }
        let is_left_out = |key: &str| ["ay", "az", "wx", "wy", "wz"].contains(&key);
        let rest = match missing.iter().all(|(key, _)| is_left_out(key)) {
            true => format!(", or use {} if nothing measured them", given("missing", "rest")),
            false => String::new(),
        };
        let keys: Vec<String> = missing.iter().map(|(key, _)| format!("{key}=NAME")).collect();
        let reason = format!(
            "there {} no column{} {}; there are {}; name what is called otherwise with {}{}",
            if expected.len() == 1 { "is" } else { "are" },
            if expected.len() == 1 { "" } else { "s" },
            expected.join(", "),
            present.join(", "),
            given("columns", keys.join(",")),
            rest
        );
        RecordingError::Whole { file: file.to_owned(), reason }
    }

    /// True if the columns of a logger's format exist.
    fn is_of(&self, format: Format) -> bool {
        let conventions = format.options().load();
        conventions.is_ok_and(|conventions| {
            let is_needed = |quantity: Quantity| quantity.is_required() && !is_at_rest(quantity, &conventions);
            let mut needed = Quantity::ALL.iter().filter(|(quantity, _)| is_needed(*quantity));
            // Each of several files has a time.
            needed.all(|&(quantity, _)| match self.terms(conventions.column(quantity)) {
                Ok(found) => found.is_some(),
                Err(_) => quantity == Quantity::Time,
            })
        })
    }

    /// The unit of columns that are added, which must be one.
    fn unit_of_sum(
        &self,
        terms: &[Term],
        dimension: Dimension,
        conventions: &Conventions,
    ) -> Result<(Unit, UnitSource), String> {
        let (unit, source) = self.unit(terms[0].place, dimension, conventions)?;
        for term in &terms[1..] {
            let (other, _) = self.unit(term.place, dimension, conventions)?;
            if other != unit {
                return Err(format!(
                    "columns {} and {} are added, but are in {} and {}; convert one of them",
                    self.shown(terms[0].place),
                    self.shown(term.place),
                    unit.word,
                    other.word
                ));
            }
        }
        Ok((unit, source))
    }

    /// The time's unit: seconds where it is written out as dates or times of day.
    ///
    /// # Errors
    /// As [`Header::columns`].
    pub fn time_unit(&self, place: usize, is_written_out: bool, conventions: &Conventions) -> Result<Unit, String> {
        if is_written_out {
            return Ok(TimeUnit::Second.unit());
        }
        self.unit(place, Dimension::Time, conventions).map(|(unit, _)| unit)
    }

    /// The unit of a column: the header's, the option's, or the default, in this order.
    fn unit(
        &self,
        place: usize,
        dimension: Dimension,
        conventions: &Conventions,
    ) -> Result<(Unit, UnitSource), String> {
        let given = conventions.unit(dimension);
        let option = named(dimension.option());
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
                 Name the right column with {}",
                quoted(text),
                dimension.name(),
                named("columns")
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

    /// Checks that the columns of one dimension all have units, or none has. A unit missing beside
    /// one that is not the default is not guessed.
    fn check_units_are_complete(&self, columns: &[Column]) -> Result<(), String> {
        for dimension in Dimension::ALL {
            let of = |source| {
                columns.iter().filter(move |column| column.quantity.dimension() == dimension && column.source == source)
            };
            let open: Vec<String> = of(UnitSource::Default).map(|column| self.shown(column.terms[0].place)).collect();
            let stated = of(UnitSource::Header).find(|column| column.unit != dimension.default_unit());
            if let Some(stated) = stated.filter(|_| !open.is_empty()) {
                return Err(format!(
                    "column {} is in {} by its header, but {} without a unit; write the unit into the header of each",
                    self.shown(stated.terms[0].place),
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

/// True for a quantity that is as at rest where a recording lacks it. A turned
/// sensor's is not known.
fn is_at_rest(quantity: Quantity, conventions: &Conventions) -> bool {
    let is_known = match quantity {
        Quantity::Rate(_) => conventions.mounting != Some(Mounting::Auto),
        Quantity::Force(axis) => axis > 0 && conventions.mounting.is_none(),
        _ => false,
    };
    is_known && conventions.missing == Missing::Rest
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

/// Text of a file for a message: shortened, and without control characters.
pub fn quoted(text: &str) -> String {
    let visible = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let mut quoted: String = text.chars().take(LONGEST_QUOTE).map(visible).collect();
    if text.chars().nth(LONGEST_QUOTE).is_some() {
        quoted.push('…');
    }
    quoted
}
