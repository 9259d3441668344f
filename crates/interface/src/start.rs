//! Start values of a model, with overrides.

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

/// Slots and values as a text, the values by their bits: `17=3fd6666666666666,42=3ff0000000000000`.
/// Bits, because what decimals are read as depends on how the processor has been set to round.
pub fn write_start_values(values: &[(usize, f64)]) -> String {
    let pairs = values.iter().map(|(slot, value)| format!("{slot}={:016x}", value.to_bits()));
    pairs.collect::<Vec<_>>().join(",")
}

/// The slots and values that a text of [`write_start_values`] holds. What is not of
/// its form is left out.
pub fn read_start_values(text: &str) -> Vec<(usize, f64)> {
    let pair = |pair: &str| {
        let (slot, value) = pair.split_once('=')?;
        Some((slot.parse().ok()?, f64::from_bits(u64::from_str_radix(value, 16).ok()?)))
    };
    text.split(',').filter_map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_survive_as_text_to_the_bit() {
        let values = [(0, 0.1 + 0.2), (7, -1e-300), (123, 5e-324), (4, f64::MAX), (5, -0.0), (9, 3.0)];
        let read = read_start_values(&write_start_values(&values));
        assert_eq!(read.len(), values.len());
        for (read, written) in read.iter().zip(&values) {
            assert_eq!((read.0, read.1.to_bits()), (written.0, written.1.to_bits()));
        }
    }

    #[test]
    fn what_is_no_value_is_left_out() {
        assert!(read_start_values("").is_empty());
        assert_eq!(read_start_values("x=1,2=y,3,4=4014000000000000"), [(4, 5.0)]);
    }
}
