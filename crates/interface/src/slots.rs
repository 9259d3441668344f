//! The flat array of a model's values: which slot belongs to which row, and reading and
//! writing structs in it.

use alloc::{vec, vec::Vec};

use crate::{Field, Group, Row};

/// Where a slot comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// Index into the rows.
    pub row: u16,
    /// Which of the row's scalar variables, from 0.
    pub element: u16,
}

/// Total number of slots of the rows.
pub const fn slot_count(rows: &[Row]) -> usize {
    let mut count = 0;
    let mut r = 0;
    while r < rows.len() {
        count += rows[r].slots();
        r += 1;
    }
    count
}

/// The rows' slots in order. `N` is [`slot_count`] of them.
pub const fn slot_table<const N: usize>(rows: &[Row]) -> [Slot; N] {
    let mut slots = [Slot { row: 0, element: 0 }; N];
    let (mut r, mut n) = (0, 0);
    while r < rows.len() {
        let mut element = 0;
        while element < rows[r].slots() {
            slots[n] = Slot { row: r as u16, element: element as u16 };
            n += 1;
            element += 1;
        }
        r += 1;
    }
    slots
}

/// The slot of the variable of this name among the slots of these rows, and its row.
pub fn slot_of(rows: &'static [Row], name: &str) -> Option<(usize, &'static Row)> {
    let mut first = 0;
    rows.iter().find_map(|row| {
        let begin = first;
        first += row.slots();
        // Names of elements are made one by one: only where they can be the one.
        let stem = row.name.split_once(['#', '@']).map_or(row.name, |(stem, _)| stem);
        if !name.starts_with(stem) {
            return None;
        }
        let element = (0..row.slots()).find(|&element| row.variable_name(element) == name)?;
        Some((begin + element, row))
    })
}

/// The values of a group's variables, in the order of its rows.
pub fn slots_of<G: Group>(group: &G) -> Vec<f64> {
    let mut slots = vec![0.0; slot_count(G::ROWS)];
    group.write(&mut Writer::new(&mut slots));
    slots
}

/// Takes fields from slots, one after another.
pub struct Reader<'a> {
    slots: &'a [f64],
}

impl<'a> Reader<'a> {
    #[inline]
    pub fn new(slots: &'a [f64]) -> Self {
        Reader { slots }
    }

    /// A reader of the next `count` slots. A struct that reads its fields from a reader of its own
    /// has the number of slots checked once and not for each field.
    #[inline]
    pub fn part(&mut self, count: usize) -> Self {
        let (mine, rest) = self.slots.split_at(count);
        self.slots = rest;
        Reader::new(mine)
    }

    #[inline]
    pub fn take<F: Field>(&mut self) -> F {
        F::read(self.part(F::COUNT * F::COMPONENTS.len()).slots)
    }
}

/// Puts fields into slots, one after another.
pub struct Writer<'a> {
    slots: &'a mut [f64],
}

impl<'a> Writer<'a> {
    #[inline]
    pub fn new(slots: &'a mut [f64]) -> Self {
        Writer { slots }
    }

    /// A writer of the next `count` slots; see [`Reader::part`].
    #[inline]
    pub fn part(&mut self, count: usize) -> Self {
        let (mine, rest) = core::mem::take(&mut self.slots).split_at_mut(count);
        self.slots = rest;
        Writer::new(mine)
    }

    #[inline]
    pub fn put<F: Field>(&mut self, field: F) {
        field.write(self.part(F::COUNT * F::COMPONENTS.len()).slots);
    }
}
