//! Start values of an FMU: the model's own, or embedded ones in their place.

use moris_fmi::{Overrides, SectionError, embed};
use moris_interface::Causality;
use moris_setup::{NamedValues, parameter_file};

use crate::{Error, FmuModel};

/// The start values of a model's FMU.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Start values that stand in place of the model's own, by slot, in the order of the slots.
    overrides: Overrides,
    /// Start values of all slots.
    slots: Vec<f64>,
}

impl Start {
    /// The model's own.
    pub fn own(model: &FmuModel) -> Self {
        Start { overrides: Vec::new(), slots: (model.functions.start)(&[]) }
    }

    /// The start values that a library of the model holds in place of the model's own.
    pub fn of_library(model: &FmuModel, overrides: Overrides) -> Self {
        Start { slots: (model.functions.start)(&overrides), overrides }
    }

    /// The model's own with these laid over them; what the model has no parameter of that name for
    /// is left out.
    ///
    /// # Errors
    /// The model cannot start with them.
    pub fn with(model: &FmuModel, values: &NamedValues) -> Result<Self, Error> {
        let identity = &model.functions.identity;
        let own = (model.functions.start)(&[]);
        let mut slots = own.clone();
        for (name, value) in values {
            if let Some(slot) = identity.slot(name).filter(|&slot| identity.row(slot).causality == Causality::Parameter)
            {
                slots[slot] = *value;
            }
        }
        for (name, value) in (model.derived_start_values)(&slots) {
            slots[identity.slot(&name).expect("what follows is the model's")] = value;
        }
        let is_set = |slot: usize| matches!(identity.row(slot).causality, Causality::Parameter | Causality::Input);
        let overrides: Overrides = (0..slots.len())
            .filter(|&slot| is_set(slot) && slots[slot] != own[slot])
            .map(|slot| (slot, slots[slot]))
            .collect();
        let start = Start::of_library(model, overrides);
        start.check(model)?;
        Ok(start)
    }

    fn check(&self, model: &FmuModel) -> Result<(), Error> {
        (model.functions.check)(&self.slots).map_err(|error| Error::Start { model: model.name, error })
    }

    /// The start value of each slot.
    pub fn slots(&self) -> &[f64] {
        &self.slots
    }

    /// Number of values that replace the model's own.
    pub fn count(&self) -> usize {
        self.overrides.len()
    }

    /// True if no value replaces the model's own.
    pub fn is_own(&self) -> bool {
        self.overrides.is_empty()
    }

    /// Writes the overrides into the model's library.
    ///
    /// # Errors
    /// The library has no place for them.
    pub fn embed(&self, model: &FmuModel, library: &mut [u8]) -> Result<(), SectionError> {
        embed(library, model.functions.identity.slots.len(), &self.overrides)
    }

    /// The overrides as a parameter file.
    pub fn file(&self, model: &FmuModel) -> String {
        let identity = &model.functions.identity;
        let named: NamedValues =
            self.overrides.iter().map(|&(slot, value)| (identity.variable_name(slot), value)).collect();
        parameter_file::write("Start values in place of the model's own", &named, identity.rows)
    }
}
