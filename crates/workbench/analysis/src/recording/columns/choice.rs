//! The choice of columns for the quantities.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::units::{AngleUnit, TimeUnit, Unit};
use super::{Header, Quantity, Term};
use crate::message::Message;
use crate::recording::conventions::Conventions;
use crate::texts::text;

/// The source of a column's unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitSource {
    /// The column's name, or the line of units below it.
    Header,
    /// The end of the column's name, which an option overrides.
    Ending,
    /// An option, or the file of conventions.
    Option,
    /// The default, which neither a name nor an option gives.
    Default,
}

/// A quantity of the file: the sum of columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    pub quantity: Quantity,
    pub terms: Vec<Term>,
    pub unit: Unit,
    pub source: UnitSource,
}

/// The places of all columns in use but the time, each once.
pub fn value_places(layout: &[Column]) -> Vec<usize> {
    let used = layout.iter().filter(|column| column.quantity != Quantity::Time);
    used.flat_map(|column| column.terms.iter().map(|term| term.place)).collect()
}

/// The period of a column of angles, in the column's unit; none of other columns.
pub fn period(layout: &[Column], place: usize) -> Option<f64> {
    let column = layout.iter().find(|column| column.terms.iter().any(|term| term.place == place))?;
    column.quantity.is_angle().then_some(TAU / column.unit.in_si)
}

impl Header {
    /// The columns that are used. `skips_time` is set where each of several files has its own time.
    ///
    /// # Errors
    /// - Columns are missing. The message names all of them.
    /// - A name occurs twice, or a column is given for two quantities.
    /// - A unit is unknown, or contradicts an option.
    pub fn columns(&self, conventions: &Conventions, skips_time: bool) -> Result<Vec<Column>, Message> {
        let mut columns = Vec::new();
        for (quantity, mut terms) in self.terms_of_quantities(conventions, skips_time)? {
            if quantity == Quantity::Time && terms.len() > 1 {
                self.scale_to_seconds(&mut terms);
                let (unit, source) = (TimeUnit::Second.unit(), UnitSource::Header);
                columns.push(Column { quantity, terms, unit, source });
                continue;
            }
            let (mut unit, source) = self.unit_of_sum(&terms, quantity.dimension(), conventions)?;
            // An option for angles means those of the vehicle.
            if matches!(quantity, Quantity::Geographic(_)) && source != UnitSource::Header {
                unit = AngleUnit::Degree.unit();
            }
            if matches!(quantity, Quantity::Quaternion(_)) {
                unit = AngleUnit::Radian.unit();
            }
            columns.push(Column { quantity, terms, unit, source });
        }
        self.check_units_are_complete(&columns)?;
        Ok(columns)
    }

    fn terms_of_quantities(
        &self,
        conventions: &Conventions,
        skips_time: bool,
    ) -> Result<Vec<(Quantity, Vec<Term>)>, Message> {
        let (mut chosen, mut missing, mut ambiguous) = (Vec::new(), Vec::new(), None);
        let is_geographic = self.is_geographic(conventions);
        let is_read = |quantity: &Quantity| match quantity {
            Quantity::Time => !skips_time,
            Quantity::Position(_) => conventions.position && !is_geographic,
            Quantity::Geographic(_) => is_geographic,
            _ => conventions.needs(*quantity) || !conventions.column(*quantity).is_empty(),
        };
        for quantity in Quantity::all().filter(is_read) {
            match self.terms(conventions.column(quantity)) {
                Ok(Some(terms)) => chosen.push((quantity, terms)),
                Ok(None) if conventions.expects(quantity) => missing.push(quantity),
                Ok(None) => (),
                Err(reason) => ambiguous = ambiguous.or(Some(reason)),
            }
        }
        self.check_each_is_used_once(&chosen)?;
        match ambiguous {
            _ if !missing.is_empty() => Err(self.missing(&missing, conventions)),
            Some(reason) => Err(reason),
            None => Ok(chosen),
        }
    }

    /// True if a position is needed that only latitude and longitude give.
    pub(super) fn is_geographic(&self, conventions: &Conventions) -> bool {
        let has = |quantities: [Quantity; 2]| {
            quantities.iter().all(|&quantity| self.terms(conventions.column(quantity)) != Ok(None))
        };
        conventions.position
            && !has([Quantity::Position(0), Quantity::Position(1)])
            && has([Quantity::Geographic(0), Quantity::Geographic(1)])
    }

    fn check_each_is_used_once(&self, chosen: &[(Quantity, Vec<Term>)]) -> Result<(), Message> {
        let mut used = BTreeMap::new();
        for (quantity, terms) in chosen {
            for term in terms {
                if let Some(other) = used.insert(term.place, *quantity) {
                    let (title, one, other) = (self.shown(term.place), other.key(), quantity.key());
                    return Err(text!["column-given-twice", title, one, other]);
                }
            }
        }
        Ok(())
    }
}
