//! A model as its host sees it: one value a slot.

use alloc::{string::String, vec::Vec};

use crate::{Group, Model, ParameterError, Reader, Time, Writer, slot_count};

/// A [`Model`] whose inputs, outputs and parameters lie in slots.
///
/// The host keeps the values. The host gives the model the slots when parameters matter and at
/// every step, and the model writes its outputs back. The slots are those of time, inputs, outputs
/// and parameters, in this order.
pub trait SlotModel: Model {
    /// Writes the start value of every slot; the outputs are those of the model
    /// with the other values.
    fn start_slots(slots: &mut [f64]) {
        Time::START.write(&mut Writer::new(slots));
        Self::Input::START.write(&mut Writer::new(&mut slots[FIRST_INPUT_SLOT..]));
        Self::Parameters::START.write(&mut Writer::new(&mut slots[first_parameter_slot::<Self>()..]));
        if let Ok(model) = Self::new(&Self::Parameters::START, &Self::Input::START) {
            model.write_outputs(slots);
        }
    }

    /// The model before its first step, with the parameters and inputs in `slots`.
    ///
    /// # Errors
    /// As [`Model::new`].
    fn from_slots(slots: &[f64]) -> Result<Self, ParameterError> {
        Self::new(&Self::parameters_in(slots), &read_group(slots, FIRST_INPUT_SLOT))
    }

    /// The parameters in `slots`.
    fn parameters_in(slots: &[f64]) -> Self::Parameters {
        read_group(slots, first_parameter_slot::<Self>())
    }

    /// Doubts about the parameters in `slots`, in sentences.
    fn warnings_in(slots: &[f64]) -> Vec<String> {
        Self::warnings(&Self::parameters_in(slots))
    }

    /// Doubts about the first step's input in `slots`, in sentences.
    fn input_warnings_in(slots: &[f64]) -> Vec<String> {
        Self::input_warnings(&Self::parameters_in(slots), &read_group(slots, FIRST_INPUT_SLOT))
    }

    /// Changes tunable parameters to those in `slots`. On an error nothing has changed.
    ///
    /// # Errors
    /// As [`Model::retune`].
    fn retune_from(&mut self, slots: &[f64]) -> Result<(), ParameterError> {
        self.retune(&Self::parameters_in(slots))
    }

    /// Advances by `step` seconds from the inputs in `slots`. `derivatives` has a slot for each of
    /// `slots`, with the inputs' time derivatives, zero where the host gives none.
    fn step_slots(&mut self, slots: &[f64], derivatives: Option<&[f64]>, step: f64) {
        let start = read_group(slots, FIRST_INPUT_SLOT);
        match derivatives {
            None => self.step(&start, step),
            Some(derivatives) => {
                let end = Self::input_after(&start, &read_group(derivatives, FIRST_INPUT_SLOT), step);
                self.step_between(&start, &end, step);
            }
        }
    }

    /// Writes the outputs into their slots.
    fn write_outputs(&self, slots: &mut [f64]) {
        self.output().write(&mut Writer::new(&mut slots[first_output_slot::<Self>()..]));
    }

    /// Writes the outputs' time derivatives into the outputs' slots.
    fn write_output_derivatives(&self, slots: &mut [f64]) {
        self.output_derivative().write(&mut Writer::new(&mut slots[first_output_slot::<Self>()..]));
    }
}

impl<M: Model> SlotModel for M {}

/// The slots at which the groups begin.
const FIRST_INPUT_SLOT: usize = slot_count(Time::ROWS);
const fn first_output_slot<M: Model>() -> usize {
    const { FIRST_INPUT_SLOT + slot_count(M::Input::ROWS) }
}
const fn first_parameter_slot<M: Model>() -> usize {
    const { first_output_slot::<M>() + slot_count(M::Output::ROWS) }
}

/// The group that begins at this slot.
fn read_group<G: Group>(slots: &[f64], begin: usize) -> G {
    G::read(&mut Reader::new(&slots[begin..]))
}
