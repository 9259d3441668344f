//! Start values of a model, with overrides.

use alloc::{vec, vec::Vec};

use crate::{Model, SlotModel};

/// The start value of every slot of a model, with these laid over the model's own, each a
/// slot and its value. The outputs are those that follow from them. Slots that the model does
/// not have are left out.
pub fn start_values<M: Model>(overrides: &[(usize, f64)]) -> Vec<f64> {
    let mut slots = vec![0.0; M::IDENTITY.slots.len()];
    M::start_slots(&mut slots);
    for &(slot, value) in overrides {
        if let Some(start) = slots.get_mut(slot) {
            *start = value;
        }
    }
    if !overrides.is_empty()
        && let Ok(model) = M::from_slots(&slots)
    {
        model.write_outputs(&mut slots);
    }
    slots
}
