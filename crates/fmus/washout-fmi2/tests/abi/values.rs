//! Every variable of the washout with values that it cannot take, and where it cannot be set.

use moris_fmu_host::{Instance, Status};
use moris_interface::{Causality, Kind, Variability, start_values};
use moris_washout::Washout;

use crate::fixture::*;

/// Instances in initialization mode and between steps, with whether fixed
/// parameters can be set in them.
fn instances() -> [(Instance, bool); 2] {
    let mut initializing = open().instantiate("washout").unwrap();
    assert_eq!(initializing.setup_experiment(0.0, None), Status::Ok);
    assert_eq!(initializing.enter_initialization_mode(), Status::Ok);
    [(initializing, true), (initialized(&[]), false)]
}

/// Sets the variable in this slot, by its own type.
fn set(instance: &mut Instance, slot: usize, value: f64) -> Status {
    let reference = [slot as u32];
    match IDENTITY.row(slot).kind {
        Kind::Real(_) => instance.set_real(&reference, &[value]),
        Kind::Boolean => instance.set_boolean(&reference, &[value as i32]),
        Kind::Integer | Kind::Enumeration(_) => instance.set_integer(&reference, &[value as i32]),
    }
}

/// Values that the variable cannot have.
fn impossible(slot: usize) -> Vec<f64> {
    let row = IDENTITY.row(slot);
    let (min, max) = row.bounds();
    match (row.kind, row.causality) {
        (Kind::Real(_), Causality::Input) => vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY],
        (Kind::Real(_), _) => vec![min.next_down(), max.next_up(), f64::NAN, f64::INFINITY, f64::NEG_INFINITY],
        (Kind::Boolean, _) => vec![],
        _ => vec![min - 1.0, max + 1.0, f64::from(i32::MIN), f64::from(i32::MAX)],
    }
}

#[test]
fn impossible_values_are_discarded_and_the_old_ones_stay() {
    let mut tried = 0;
    for (mut instance, fixed_too) in instances() {
        let before = bytes(&mut instance);
        for slot in 0..IDENTITY.slots.len() {
            let (row, name) = (IDENTITY.row(slot), IDENTITY.variable_name(slot));
            let settable = match row.causality {
                Causality::Input => true,
                Causality::Parameter => fixed_too || row.variability == Variability::Tunable,
                _ => false,
            };
            for value in impossible(slot).into_iter().filter(|_| settable) {
                assert_eq!(set(&mut instance, slot, value), Status::Discard, "{name} = {value}");
                let message = instance.take_messages().pop().unwrap();
                assert_eq!(message.category, "logStatusDiscard");
                assert!(message.text.contains(&format!("'{name}'")), "{}", message.text);
                tried += 1;
            }
        }
        // Initialization tries out what has been set; nothing has.
        assert!(bytes(&mut instance) == before);
    }
    assert!(tried > 500, "{tried}");
}

#[test]
fn outputs_time_and_fixed_parameters_cannot_be_set_during_the_ride() {
    let start = start_values::<Washout>(&[]);
    for (mut instance, fixed_too) in instances() {
        let before = bytes(&mut instance);
        for (slot, value) in start.iter().enumerate() {
            let (row, name) = (IDENTITY.row(slot), IDENTITY.variable_name(slot));
            let settable = match row.causality {
                Causality::Input => true,
                Causality::Parameter => fixed_too || row.variability == Variability::Tunable,
                _ => false,
            };
            if !settable {
                // A fixed parameter takes the value that it has.
                let other = if *value == 1.0 { 2.0 } else { 1.0 };
                assert_eq!(set(&mut instance, slot, other), Status::Error, "{name}");
                let message = instance.take_messages().pop().unwrap();
                assert!(message.text.contains(&format!("'{name}'")), "{}", message.text);
            }
        }
        assert!(bytes(&mut instance) == before);
    }
}

#[test]
fn references_may_repeat() {
    let mut instance = initialized(&[]);
    let (x, limit) = (reference("vehicle.specificForce.x"), reference("tilt.rateLimit"));
    assert_eq!(instance.set_real(&[x, limit, x, limit], &[1.0, 0.1, 2.0, 0.2]), Status::Ok);
    let mut values = [0.0; 5];
    assert_eq!(instance.get_real(&[limit, x, x, limit, x], &mut values), Status::Ok);
    assert_eq!(values, [0.2, 2.0, 2.0, 0.2, 2.0]);
    // Refused by the washout as a whole: the values from before the call are back, not those from within it.
    assert_eq!(instance.set_real(&[limit, x, limit], &[0.3, 3.0, -1.0]), Status::Discard);
    assert_eq!(instance.get_real(&[limit, x, x, limit, x], &mut values), Status::Ok);
    assert_eq!(values, [0.2, 2.0, 2.0, 0.2, 2.0]);
}
