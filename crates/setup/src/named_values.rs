//! Values by the names of variables, as read from files.

use moris_interface::{Group, Identity, Reader, Row, slots_of};

/// Names of variables with their values, encoded as in slots: enumerations counted from 1, booleans
/// as 0 and 1. A later value of the same name overrides an earlier one.
pub type NamedValues = Vec<(String, f64)>;

/// A group of variables overridden by these values. Names that are not the group's are ignored.
pub fn overlaid<G: Group>(group: &G, values: &[(String, f64)]) -> G {
    let mut slots = slots_of(group);
    for (slot, name) in variable_names(G::ROWS).enumerate() {
        if let Some((_, value)) = values.iter().rev().find(|(other, _)| *other == name) {
            slots[slot] = *value;
        }
    }
    G::read(&mut Reader::new(&slots))
}

/// The values of all of a group's variables.
pub fn all<G: Group>(group: &G) -> NamedValues {
    variable_names(G::ROWS).zip(slots_of(group)).collect()
}

/// The values of a group's variables that differ from the default.
pub fn changed<G: Group>(group: &G) -> NamedValues {
    differing(group, &G::default())
}

/// The values of a group's variables that differ from another's.
pub fn differing<G: Group>(group: &G, other: &G) -> NamedValues {
    all(group).into_iter().zip(slots_of(other)).filter(|(mine, other)| mine.1 != *other).map(|(mine, _)| mine).collect()
}

/// The values in a model's slots, by name.
pub fn values_of(identity: &Identity, slots: &[f64]) -> NamedValues {
    variable_names(identity.rows).zip(slots.iter().copied()).collect()
}

/// The names of all scalar variables of these rows, in the order of the slots.
pub(crate) fn variable_names(rows: &[Row]) -> impl Iterator<Item = String> {
    rows.iter().flat_map(|row| (0..row.slots()).map(|element| row.variable_name(element)))
}
