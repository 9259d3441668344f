//! The names by which a host connects the motorcycle.

use std::collections::BTreeSet;

use moris_interface::{Causality, Kind, Model, SlotModel};
use moris_motorcycle::Motorcycle;
use moris_washout::Washout;

/// Names of a model's variables of a causality, with their kinds.
fn variables<M: Model>(causality: Causality) -> Vec<(String, Kind)> {
    let identity = M::IDENTITY;
    (0..identity.slots.len())
        .filter(|&slot| identity.row(slot).causality == causality)
        .map(|slot| (identity.variable_name(slot), identity.row(slot).kind))
        .collect()
}

#[test]
fn its_first_outputs_are_the_washouts_inputs_in_order_with_their_units() {
    let inputs = variables::<Washout>(Causality::Input);
    let outputs = variables::<Motorcycle>(Causality::Output);
    let engaged = inputs.iter().position(|(name, _)| name == "engaged").unwrap();
    assert_eq!(inputs[..engaged], outputs[..engaged]);
    // The host decides on the rest: whether to cue, and what to preview.
    assert!(inputs[engaged + 1..].iter().all(|(name, _)| name.starts_with("vehicle.preview.")));
}

#[test]
fn no_name_is_used_twice() {
    let identity = Motorcycle::IDENTITY;
    let names: BTreeSet<_> = (0..identity.slots.len()).map(|slot| identity.variable_name(slot)).collect();
    assert_eq!(names.len(), identity.slots.len());
}

#[test]
fn as_a_model_it_starts_with_the_outputs_of_a_motorcycle_at_rest() {
    let identity = Motorcycle::IDENTITY;
    let mut slots = vec![0.0; identity.slots.len()];
    Motorcycle::start_slots(&mut slots);
    let at = |name: &str| slots[identity.slot(name).unwrap()];
    assert_eq!(at("vehicle.specificForce.z"), 9.80665);
    assert_eq!(at("rider.feetDown"), 1.0);
    let mut again = slots.clone();
    Motorcycle::from_slots(&slots).unwrap().write_outputs(&mut again);
    assert_eq!(slots, again);
}
