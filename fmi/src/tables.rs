//! What all instances of a model share, in the library's static memory, so that unloading the library leaks nothing.

use std::sync::OnceLock;

use model_interface::{Model, guid};

use crate::variable_check::{Role, VariableCheck, variable_checks};

/// A GUID in braces, in ASCII.
pub type Guid = [u8; 38];

/// What all instances of a model share. The export macro makes one static of it.
pub struct SharedTables<const N: usize> {
    checks: [VariableCheck; N],
    time_slot: Option<usize>,
    start: OnceLock<[f64; N]>,
    guid: OnceLock<Guid>,
}

impl<const N: usize> SharedTables<N> {
    /// The tables of the model `M`, which has `N` slots.
    pub const fn new<M: Model>() -> Self {
        assert!(M::IDENTITY.slots.len() == N);
        let checks = variable_checks(&M::IDENTITY);
        SharedTables { checks, time_slot: time_slot(&checks), start: OnceLock::new(), guid: OnceLock::new() }
    }

    /// The tables, filled on the first call. `M` is the model that they were made for.
    pub fn get<M: Model>(&'static self) -> Tables {
        let start = self.start.get_or_init(|| {
            let mut start = [0.0; N];
            M::start(&mut start);
            start
        });
        let guid = self.guid.get_or_init(|| guid::<M>().as_bytes().try_into().expect("a GUID has 38 characters"));
        Tables { checks: &self.checks, time_slot: self.time_slot, start, guid }
    }
}

/// How many slots a model has: the `N` of its [`SharedTables`].
pub const fn slot_count<M: Model>() -> usize {
    M::IDENTITY.slots.len()
}

/// Access to what all instances of a model share.
#[derive(Clone, Copy)]
pub struct Tables {
    /// What may be done with each slot.
    pub checks: &'static [VariableCheck],
    /// The slot of the independent variable, where there is one.
    pub time_slot: Option<usize>,
    /// The start value of each slot.
    pub start: &'static [f64],
    /// By which a host knows that a model description belongs to this model.
    pub guid: &'static Guid,
}

const fn time_slot(checks: &[VariableCheck]) -> Option<usize> {
    let mut slot = 0;
    while slot < checks.len() {
        if matches!(checks[slot].role, Role::Time) {
            return Some(slot);
        }
        slot += 1;
    }
    None
}
