//! The trait of a model, for those who host it.

use serde::{Serialize, de::DeserializeOwned};

use crate::{Causality, Row, Slot};

/// Who a model is and what its variables are.
#[derive(Clone, Copy, Debug)]
pub struct Identity {
    /// The name, also a legal C identifier: FMI's modelName and modelIdentifier.
    pub name: &'static str,
    pub version: &'static str,
    /// A sentence or two on what the model does.
    pub text: &'static str,
    pub rows: &'static [Row],
    pub slots: &'static [Slot],
    /// Names of the rows of the parameters that matter most, which descriptions list first.
    pub main_parameters: &'static [&'static str],
    /// The default experiment's stop time and step \[s\].
    pub stop_time: f64,
    pub step_size: f64,
}

impl Identity {
    /// The row that a slot belongs to.
    pub fn row(&self, slot: usize) -> &'static Row {
        &self.rows[usize::from(self.slots[slot].row)]
    }

    /// The name of a slot's variable.
    pub fn variable_name(&self, slot: usize) -> String {
        self.row(slot).variable_name(usize::from(self.slots[slot].element))
    }

    /// The slots in the order in which descriptions list them: everything but parameters,
    /// the main parameters, the other parameters; otherwise in their own order. The slots
    /// of a row stay together.
    pub fn listed_slots(&self) -> Vec<usize> {
        let rank = |&slot: &usize| {
            let row = self.row(slot);
            let place = self.main_parameters.iter().position(|&name| name == row.name);
            (row.causality == Causality::Parameter, place.unwrap_or(self.main_parameters.len()))
        };
        let mut slots: Vec<usize> = (0..self.slots.len()).collect();
        slots.sort_by_key(rank);
        slots
    }

    /// The slot of the variable of this name.
    pub fn slot(&self, name: &str) -> Option<usize> {
        (0..self.slots.len()).find(|&slot| self.variable_name(slot) == name)
    }
}

/// Why a set of parameters cannot be used: which variable, its value, and the reason.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{variable}: {reason}")]
pub struct Refusal {
    pub variable: String,
    pub reason: String,
}

/// An error: this variable cannot be used, for this reason.
///
/// # Errors
/// Always.
pub fn refuse<T>(variable: impl Into<String>, reason: impl Into<String>) -> Result<T, Refusal> {
    Err(Refusal { variable: variable.into(), reason: reason.into() })
}

/// A model that a host steps.
///
/// The host keeps the values, one `f64` a slot. It gives the model the slots when parameters matter
/// ([`Model::new`], [`Model::retune`]) and at every step, and the model writes its outputs back.
pub trait Model: Clone + Serialize + DeserializeOwned + Send + 'static {
    const IDENTITY: Identity;

    /// Writes the start value of every slot, outputs included: they are those of [`Model::new`]
    /// from these very slots.
    fn start(slots: &mut [f64]);

    /// The model at rest, with the parameters in `slots`.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why.
    fn new(slots: &[f64]) -> Result<Self, Refusal>;

    /// Takes over tunable parameters that have changed. On an error nothing has changed.
    ///
    /// # Errors
    /// The first parameter that cannot be used, and why.
    fn retune(&mut self, slots: &[f64]) -> Result<(), Refusal>;

    /// Longest communication step \[s\].
    fn longest_step(&self) -> f64 {
        f64::INFINITY
    }

    /// Advances by `step` seconds. Inputs are read from `slots` as they are at the beginning of the
    /// step, and hold until its end unless the host gives `derivatives`: a slot for each of
    /// `slots`, the inputs' time derivatives, zero where it gives none.
    fn step(&mut self, slots: &[f64], derivatives: Option<&[f64]>, step: f64);

    /// Writes the outputs into their slots.
    fn outputs(&self, slots: &mut [f64]);

    /// Writes the outputs' time derivatives into their slots.
    fn output_derivatives(&self, slots: &mut [f64]);
}
