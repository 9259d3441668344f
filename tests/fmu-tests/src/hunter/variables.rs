//! The washout's variables by slot.

use std::collections::HashMap;

use anyhow::{Context, Result};
use moris_interface::{Causality, Group, Identity, Kind, Model, Row, SlotModel, Variability};
use moris_washout::{Preview, Washout};

use super::episode::Values;

/// The washout's interface.
pub const IDENTITY: Identity = Washout::IDENTITY;
/// Number of real inputs beside the preview.
pub const REAL_INPUTS: usize = 11;

/// Where a variable is in the model's slots, by its name.
pub struct Variables {
    slots: HashMap<String, usize>,
    start: Vec<f64>,
}

impl Variables {
    /// All variables with their start values.
    pub fn new() -> Self {
        let mut start = vec![0.0; IDENTITY.slots.len()];
        Washout::start_slots(&mut start);
        let slots = (0..IDENTITY.slots.len()).map(|slot| (IDENTITY.variable_name(slot), slot)).collect();
        Variables { slots, start }
    }

    /// The slot of the variable of this name.
    ///
    /// # Errors
    /// The washout has no variable of this name.
    pub fn slot(&self, name: &str) -> Result<usize> {
        self.slots.get(name).copied().with_context(|| format!("{name} is no variable of the washout"))
    }

    /// The start values with these over them.
    ///
    /// # Errors
    /// A name that is no variable's.
    pub fn values(&self, changed: &Values) -> Result<Vec<f64>> {
        let mut slots = self.start.clone();
        self.overlay(&mut slots, changed)?;
        Ok(slots)
    }

    /// Lays values over others.
    ///
    /// # Errors
    /// A name that is no variable's.
    pub fn overlay(&self, slots: &mut [f64], changed: &Values) -> Result<()> {
        for (name, value) in changed {
            slots[self.slot(name)?] = *value;
        }
        Ok(())
    }

    /// The start value of a variable.
    pub fn start(&self, slot: usize) -> f64 {
        self.start[slot]
    }

    /// The smallest and the largest value of a variable; any positive one where none are declared.
    pub fn range(&self, name: &str) -> (f64, f64) {
        let declared = self.slots.get(name).and_then(|&slot| IDENTITY.row(slot).range);
        declared.unwrap_or((f64::MIN_POSITIVE, f64::MAX))
    }

    /// The slots of the parameters of this variability, with their rows and names.
    pub fn parameters(&self, variability: Variability) -> impl Iterator<Item = (usize, &'static Row, String)> {
        (0..IDENTITY.slots.len())
            .map(|slot| (slot, IDENTITY.row(slot)))
            .filter(move |(_, row)| row.causality == Causality::Parameter && row.variability == variability)
            .map(|(slot, row)| (slot, row, IDENTITY.variable_name(slot)))
    }

    /// The name of each input, the real ones first, and its start value.
    pub fn inputs(&self) -> Vec<(String, f64)> {
        let inputs = (0..IDENTITY.slots.len()).filter(|&slot| {
            let row = IDENTITY.row(slot);
            row.causality == Causality::Input && !Preview::ROWS.contains(row)
        });
        let (booleans, reals): (Vec<_>, Vec<_>) = inputs.partition(|&slot| IDENTITY.row(slot).kind == Kind::Boolean);
        reals.into_iter().chain(booleans).map(|slot| (IDENTITY.variable_name(slot), self.start[slot])).collect()
    }
}

impl Default for Variables {
    fn default() -> Self {
        Variables::new()
    }
}
