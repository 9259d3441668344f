//! Tables shared by all instances of a model, in static memory, so that unloading the
//! library leaks nothing.

use std::sync::OnceLock;

use moris_interface::{Model, Types, guid_of, start_values};

use crate::CallError;
use crate::start_section::StartSection;
use crate::variable_info::{Role, VariableInfo, as_reals, variable_infos};

/// A GUID in braces, in ASCII.
pub type Guid = [u8; 38];

/// Tables shared by all instances of a model. The export macro makes one static of it.
pub struct SharedTables<const N: usize> {
    infos: [VariableInfo; N],
    real_infos: [VariableInfo; N],
    time_slot: Option<usize>,
    section: &'static StartSection<N>,
    start: OnceLock<[f64; N]>,
    guid: OnceLock<Guid>,
}

impl<const N: usize> SharedTables<N> {
    /// The tables of the model `M`, which has `N` slots, with the start values in this place.
    pub const fn new<M: Model>(section: &'static StartSection<N>) -> Self {
        assert!(M::IDENTITY.slots.len() == N);
        let infos = variable_infos(&M::IDENTITY);
        let time_slot = time_slot(&infos);
        SharedTables {
            infos,
            real_infos: as_reals(infos),
            time_slot,
            section,
            start: OnceLock::new(),
            guid: OnceLock::new(),
        }
    }

    /// The tables, filled on the first call. `M` is the model that they were made for.
    ///
    /// # Errors
    /// The library's start values are damaged.
    pub fn get<M: Model>(&'static self) -> Result<Tables, CallError> {
        let overrides = self.section.read()?;
        let start = self.start.get_or_init(|| {
            start_values::<M>(&overrides).try_into().expect("a model has as many start values as slots")
        });
        let guid =
            self.guid.get_or_init(|| guid_of::<M>(start).as_bytes().try_into().expect("a GUID has 38 characters"));
        Ok(Tables { infos: &self.infos, real_infos: &self.real_infos, time_slot: self.time_slot, start, guid })
    }
}

/// Number of slots of a model: the `N` of its [`SharedTables`].
pub const fn slot_count<M: Model>() -> usize {
    M::IDENTITY.slots.len()
}

/// Access to what all instances of a model share.
#[derive(Clone, Copy)]
pub struct Tables {
    /// Access to each slot.
    pub infos: &'static [VariableInfo],
    /// Access to each slot where the description has reals only.
    real_infos: &'static [VariableInfo],
    /// The slot of the independent variable, where there is one.
    pub time_slot: Option<usize>,
    /// The start value of each slot.
    pub start: &'static [f64],
    /// By which a host knows that a model description belongs to this model.
    pub guid: &'static Guid,
}

impl Tables {
    /// The tables for a host whose description has variables of these types.
    #[must_use]
    pub fn of_types(self, types: Types) -> Self {
        match types {
            Types::Own => self,
            Types::Reals => Tables { infos: self.real_infos, ..self },
        }
    }
}

const fn time_slot(infos: &[VariableInfo]) -> Option<usize> {
    let mut slot = 0;
    while slot < infos.len() {
        if matches!(infos[slot].role, Role::Time) {
            return Some(slot);
        }
        slot += 1;
    }
    None
}
