//! Declaration of a model's variables: once, in Rust.
//!
//! [`interface!`] declares a plain struct and, from the same lines, one [`Row`] a field: the FMI
//! name, the unit, the range and the sentence that describes it. Everything else is derived from
//! those rows: value references, the XML, the documentation's tables and the start values. A model
//! is added by declaring its structs and implementing [`Model`].
//!
//! A model's values live in one flat array of `f64`, a *slot* for each scalar variable, in the
//! order of the rows. A value reference is a slot's index. Booleans are 0 and 1, enumerations and
//! integers whole numbers.

#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;
use alloc::{borrow::ToOwned, format};

extern crate self as moris_interface; // the macros name this crate so

mod declare;
mod field;
mod guid;
mod layout;
mod log_categories;
mod model;
mod nearest;
mod row;
mod shown;
mod slot_model;
mod slots;
mod start;
mod unit;

#[doc(hidden)] // for the macros
pub use serde;

pub use field::Field;
pub use guid::{guid, guid_of};
pub use layout::{Layout, Types};
pub use log_categories::{LOG_CATEGORIES, LOG_CATEGORIES_OF_FMI3, LogCategory};
pub use model::{Identity, MOST_INTERNAL_STEPS, Model, ParameterError, SHORTEST_STEP, Time, refuse};
pub use row::{
    Causality, Condition, Enumeration, Item, Kind, Row, Variability, bounds_of, concat_rows, four_decimals, row_count,
    with_tunable,
};
pub use shown::{Shown, shown};
pub use slot_model::SlotModel;
pub use slots::{Reader, Slot, Writer, slot_count, slot_of, slot_table, slots_of};
pub use start::start_values;
pub use unit::{BaseUnit, DisplayUnit, Unit, units};

use nearest::nearest_name;

/// Checks that only tunable variables differ. `rows` are the group's, and `N` is the
/// number of their slots.
///
/// # Errors
/// The first fixed variable that differs.
pub fn check_fixed<G: Group, const N: usize>(rows: &[Row], before: &G, after: &G) -> Result<(), ParameterError> {
    let slots = |group: &G| {
        let mut slots = [0.0; N];
        group.write(&mut Writer::new(&mut slots));
        slots
    };
    let (before, after) = (slots(before), slots(after));
    let mut first = 0;
    for row in rows {
        let mine = first..first + row.slots();
        first = mine.end;
        if row.variability == Variability::Fixed
            && let Some(element) = before[mine.clone()].iter().zip(&after[mine]).position(|(old, new)| old != new)
        {
            return refuse(
                row.variable_name(element),
                "is fixed after initialization; create a new instance to change it",
            );
        }
    }
    Ok(())
}

/// A struct whose fields are variables of the interface: made by [`interface!`]
/// and [`interface_tree!`].
pub trait Group: Default + 'static {
    /// The rows of the struct's fields, in the order of the fields.
    const ROWS: &'static [Row];
    /// The rows' slots.
    const SLOTS: &'static [Slot];
    /// The start values.
    const START: Self;
    /// Takes the struct's fields from the reader's next slots.
    fn read(reader: &mut Reader) -> Self;
    /// Puts the struct's fields into the writer's next slots.
    fn write(&self, writer: &mut Writer);

    /// Checks every value against the range of its row.
    ///
    /// # Errors
    /// The first variable that is not a finite number or outside its range.
    fn check_ranges(&self) -> Result<(), ParameterError>;

    /// The values forced into their ranges: a number outside counts as the nearest end, and what is
    /// not a number as the start value.
    fn sanitized(&self) -> Self;
    /// Sets the variable of this name, as the FMU has it: `scale.specificForce.x`, say. Booleans
    /// are 0 and 1, enumerations and integers whole numbers.
    ///
    /// # Errors
    /// There is no such variable, or it cannot have this value. Then nothing has changed.
    fn set(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        let Some((slot, row)) = slot_of(Self::ROWS, name) else {
            let otherwise = || "the names are those of the FMU's table".to_owned();
            let hint = nearest_name(Self::ROWS, name).map_or_else(otherwise, |near| format!("did you mean {near}?"));
            return refuse(name, format!("is no variable here; {hint}"));
        };
        let is_whole = matches!(row.kind, Kind::Real(_)) || value % 1.0 == 0.0;
        if !row.accepts(value) || !is_whole {
            return refuse(name, row.reason(value));
        }
        let mut slots = slots_of(self);
        slots[slot] = value;
        *self = Self::read(&mut Reader::new(&slots));
        Ok(())
    }

    /// The value of the variable of this name, as [`Group::set`] takes it; `None` if there is none.
    fn get(&self, name: &str) -> Option<f64> {
        slot_of(Self::ROWS, name).map(|(slot, _)| slots_of(self)[slot])
    }

    /// The values after `time` at these slopes. Booleans and whole numbers keep their values where
    /// their slopes are zero.
    fn extrapolated(&self, slope: &Self, time: f64) -> Self {
        // Largest number of slots of a group that is extrapolated.
        const MOST_EXTRAPOLATED: usize = 64;
        const { assert!(slot_count(Self::ROWS) <= MOST_EXTRAPOLATED) }
        let mut buffer = [[0.0; MOST_EXTRAPOLATED]; 2];
        let [values, slopes] = buffer.each_mut().map(|buffer| &mut buffer[..const { slot_count(Self::ROWS) }]);
        self.write(&mut Writer::new(values));
        slope.write(&mut Writer::new(slopes));
        for (value, slope) in values.iter_mut().zip(slopes) {
            *value += time * *slope;
        }
        Self::read(&mut Reader::new(values))
    }

    #[doc(hidden)] // the part of `sanitized` that is rarely needed
    fn forced_into_ranges(&self) -> Self;
}
