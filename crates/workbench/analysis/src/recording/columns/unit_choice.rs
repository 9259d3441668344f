//! The units of columns: those of the header, of options, or by default.

use super::units::{Dimension, TimeUnit, Unit, any_spelled};
use super::{Column, Header, Term, UnitSource};
use crate::message::{Message, named};
use crate::recording::conventions::Conventions;
use crate::recording::message::quoted;
use crate::texts::text;

impl Header {
    /// The unit of columns that are added, which must be one.
    pub(super) fn unit_of_sum(
        &self,
        terms: &[Term],
        dimension: Dimension,
        conventions: &Conventions,
    ) -> Result<(Unit, UnitSource), Message> {
        let (unit, source) = self.unit(terms[0].place, dimension, conventions)?;
        for term in &terms[1..] {
            let (other, _) = self.unit(term.place, dimension, conventions)?;
            if other != unit {
                let [one, two] = [&terms[0], term].map(|term| self.shown(term.place));
                let (unit, other) = (unit.word, other.word);
                return Err(text!["added-in-two-units", one, two, unit, other]);
            }
        }
        Ok((unit, source))
    }

    /// The time's unit and its source: seconds where it is a sum, which is scaled already.
    ///
    /// # Errors
    /// As [`Header::columns`].
    pub fn time_unit(&self, terms: &[Term], conventions: &Conventions) -> Result<(Unit, UnitSource), Message> {
        match terms {
            [one] => self.unit(one.place, Dimension::Time, conventions),
            _ => Ok((TimeUnit::Second.unit(), UnitSource::Header)),
        }
    }

    /// Scales columns of time that are added, as `sec + nanosec`, to seconds, each by the unit
    /// behind its name, or by the one that its name is.
    pub fn scale_to_seconds(&self, terms: &mut [Term]) {
        for term in terms {
            let title = &self.titles[term.place];
            let word = title.name.rsplit(['.', '_', ' ', '/']).next().unwrap_or_default();
            let mut spellings = title.unit.as_deref().into_iter().chain([word]);
            let unit = spellings.find_map(|text| Dimension::Time.spelled(text));
            term.factor *= unit.map_or(1.0, |unit| unit.in_si);
        }
    }

    /// The unit of a column: the header's, the option's, or the default, in this order.
    fn unit(
        &self,
        place: usize,
        dimension: Dimension,
        conventions: &Conventions,
    ) -> Result<(Unit, UnitSource), Message> {
        let given = conventions.unit(dimension);
        let of_option = given.map(|unit| (unit, UnitSource::Option));
        let Some(text) = &self.titles[place].unit else {
            let ending = || self.titles[place].endings.iter().find_map(|ending| dimension.spelled(ending));
            let of_name = || ending().map(|unit| (unit, UnitSource::Ending));
            return Ok(of_option.or_else(of_name).unwrap_or((dimension.default_unit(), UnitSource::Default)));
        };
        let (title, option) = (self.shown(place), named(dimension.option()));
        match (dimension.spelled(text), given) {
            (Some(unit), Some(given)) if unit != given => {
                Err(text!["header-against-option", title, unit = unit.word, option, given = given.word])
            }
            (Some(unit), _) => Ok((unit, UnitSource::Header)),
            (None, _) if any_spelled(text).is_some() => {
                Err(text!["unit-of-another-quantity", title, unit = quoted(text), quantity = dimension.name()])
            }
            (None, Some(given)) => Ok((given, UnitSource::Option)),
            (None, None) => {
                let known = dimension.units().map(|unit| unit.word).collect::<Vec<_>>().join(", ");
                Err(text!["unit-not-known", title, unit = quoted(text), known, option])
            }
        }
    }

    /// Checks that the columns of one dimension all have units, or none has. A unit missing beside
    /// one that is not the default is not guessed.
    pub(super) fn check_units_are_complete(&self, columns: &[Column]) -> Result<(), Message> {
        for dimension in Dimension::ALL {
            let of = |source| {
                columns.iter().filter(move |column| column.quantity.dimension() == dimension && column.source == source)
            };
            let open: Vec<String> = of(UnitSource::Default).map(|column| self.shown(column.terms[0].place)).collect();
            let stated = of(UnitSource::Header)
                .chain(of(UnitSource::Ending))
                .find(|column| column.unit != dimension.default_unit());
            if let Some(stated) = stated.filter(|_| !open.is_empty()) {
                let (title, unit) = (self.shown(stated.terms[0].place), stated.unit.word);
                let (verb, open) = (if open.len() == 1 { "is" } else { "are" }, open.join(", "));
                return Err(text!["unit-missing-beside", title, unit, open, verb]);
            }
        }
        Ok(())
    }
}
