//! Getting and setting.

use moris_fmu_host::{Instance, Status};
use moris_interface::{Causality, Kind, SlotModel, Variability};

use crate::fixture::*;
use crate::model::FirstOrder;

#[test]
fn every_variable_shows_its_start_value_during_initialization() {
    let mut start = vec![0.0; IDENTITY.slots.len()];
    FirstOrder::start_slots(&mut start);
    let mut instance = initializing();
    for (slot, value) in start.into_iter().enumerate() {
        let name = IDENTITY.variable_name(slot);
        assert_eq!(instance.get(&name).unwrap(), value, "{name}");
    }
}

#[test]
fn what_is_set_can_be_read_back() {
    let mut instance = stepping(&[]);
    for (name, value) in [("u", -2.5), ("offset", -5.0), ("frozen", 1.0), ("gain", 3.0), ("method", 2.0), ("trap", 1.0)]
    {
        instance.set(name, value).unwrap();
        assert_eq!(instance.get(name).unwrap(), value, "{name}");
    }
    assert_eq!(instance.set_boolean(&[reference("frozen")], &[-7]), Status::Ok);
    assert_eq!(instance.get("frozen").unwrap(), 1.0, "everything but 0 is true");
    assert_eq!(instance.set_real(&[], &[]), Status::Ok);
    assert_eq!(instance.get_real(&[], &mut []), Status::Ok);
}

/// Every variable in every state in which something can be set, against the rule of the standard.
#[test]
fn variables_can_be_set_where_the_standard_says() {
    for slot in 0..IDENTITY.slots.len() {
        let (name, row) = (IDENTITY.variable_name(slot), IDENTITY.row(slot));
        let (before, stepping_too) = match (row.causality, row.variability) {
            (Causality::Input, _) | (Causality::Parameter, Variability::Tunable) => (true, true),
            (Causality::Parameter, _) => (true, false),
            _ => (false, false),
        };
        for (mut instance, expected) in
            [(instantiated(), before), (initializing(), before), (stepping(&[]), stepping_too)]
        {
            let state = bytes(&mut instance);
            assert_eq!(instance.set(&name, 1.0).is_ok(), expected, "{name}");
            if !expected {
                let message = last_message(&instance);
                assert!(message.text.contains(&format!("'{name}'")), "{}", message.text);
                assert_eq!(message.status, Status::Error);
                assert_eq!(bytes(&mut instance), state);
            }
        }
    }
}

/// Every variable by every type, got and set.
#[test]
fn variables_have_one_type() {
    let mut instance = initializing();
    for slot in 0..IDENTITY.slots.len() {
        let r = [slot as u32];
        let statuses = [
            [instance.get_real(&r, &mut [0.0]), instance.set_real(&r, &[1.0])],
            [instance.get_integer(&r, &mut [0]), instance.set_integer(&r, &[1])],
            [instance.get_boolean(&r, &mut [0]), instance.set_boolean(&r, &[1])],
        ];
        let own = match IDENTITY.row(slot).kind {
            Kind::Real(_) => 0,
            Kind::Integer | Kind::Enumeration(_) => 1,
            Kind::Boolean => 2,
        };
        for (by, [get, set]) in statuses.into_iter().enumerate() {
            assert_eq!(get == Status::Ok, by == own, "{slot} by {by}");
            assert!(by == own || set == Status::Error, "{slot} by {by}");
        }
    }
    let status = instance.set_integer(&[reference("gain")], &[1]);
    assert_call_error(&instance, status, Status::Error, &["fmi2SetInteger", "'gain'", "Real", "Integer"]);
}

#[test]
fn there_are_no_strings() {
    let instance = stepping(&[]);
    let (c, api) = (instance.component(), instance.api());
    // SAFETY: the component is alive, and the pointers lead to one element.
    unsafe {
        let mut value = std::ptr::null();
        assert_eq!((api.get_string)(c, &1, 1, &mut value), 3);
        assert_eq!((api.set_string)(c, &1, 1, &c"text".as_ptr()), 3);
        assert_eq!((api.get_string)(c, std::ptr::null(), 0, std::ptr::null_mut()), 0);
    }
    assert!(last_message(&instance).text.contains("String"));
}

#[track_caller]
fn assert_discarded(instance: &mut Instance, set: impl FnOnce(&mut Instance) -> Status, parts: &[&str]) {
    let before = bytes(instance);
    let status = set(instance);
    assert_call_error(instance, status, Status::Discard, parts);
    assert!(bytes(instance) == before, "a discarded value changed something");
}

#[test]
fn impossible_values_are_discarded() {
    for mut instance in [initializing(), stepping(&[])] {
        instance.set("u", 7.0).unwrap();
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_discarded(&mut instance, |i| i.set_real(&[reference("u")], &[value]), &["'u'", "finite", "7"]);
        }
        assert_discarded(
            &mut instance,
            |i| i.set_integer(&[reference("offset")], &[6]),
            &["'offset' is 6", "from -5 to 5"],
        );
        assert_discarded(&mut instance, |i| i.set_integer(&[reference("offset")], &[i32::MIN]), &["'offset'"]);
        for item in [0, 3, -1, i32::MAX] {
            let parts = ["'method'", "1 (exact), 2 (euler)"];
            assert_discarded(&mut instance, |i| i.set_integer(&[reference("method")], &[item]), &parts);
        }
        assert_eq!(instance.set_real(&[reference("u")], &[f64::MAX]), Status::Ok);
        assert_eq!(instance.set_real(&[reference("u")], &[-0.0]), Status::Ok);
    }
}

#[test]
fn a_call_is_taken_as_a_whole_or_not_at_all() {
    for mut instance in [initializing(), stepping(&[])] {
        let [u, gain, y] = ["u", "gain", "y"].map(reference);
        assert_discarded(&mut instance, |i| i.set_real(&[u, gain], &[1.0, f64::NAN]), &["'gain'"]);
        let before = bytes(&mut instance);
        for wrong in [y, 10_000, u32::MAX, reference("frozen"), reference("time")] {
            // A wrong reference outweighs a wrong value, wherever it stands.
            let status = instance.set_real(&[u, gain, wrong], &[f64::NAN, 2.0, 1.0]);
            assert_call_error(&instance, status, Status::Error, &["fmi2SetReal"]);
            let mut values = [-1.0; 3];
            if wrong != y && wrong != reference("time") {
                let status = instance.get_real(&[u, gain, wrong], &mut values);
                assert_call_error(&instance, status, Status::Error, &["fmi2GetReal"]);
                assert_eq!(values, [-1.0; 3]);
            }
        }
        assert_eq!(bytes(&mut instance), before);
    }
}

#[test]
fn of_a_variable_set_twice_the_last_value_counts_and_the_first_old_value_returns() {
    let mut instance = stepping(&[("gain", 4.0)]);
    let gain = reference("gain");
    assert_eq!(instance.set_real(&[gain, gain], &[5.0, 6.0]), Status::Ok);
    assert_eq!(instance.get("gain").unwrap(), 6.0);
    assert_discarded(&mut instance, |i| i.set_real(&[gain, gain], &[7.0, -1.0]), &["gain"]);
    assert_eq!(instance.get("gain").unwrap(), 6.0);
}

#[test]
fn a_tunable_parameter_takes_effect_between_steps() {
    let mut instance = stepping(&[]);
    instance.set("u", 1.0).unwrap();
    instance.set("gain", 3.0).unwrap();
    instance.step(0.0, 1.0).unwrap();
    let expected = 3.0 * (1.0 - (-1.0f64 / 0.5).exp());
    assert!((instance.get("y").unwrap() - expected).abs() < 1e-15);
}

#[test]
fn a_parameter_that_the_model_refuses_is_discarded_with_the_model_s_reason() {
    let mut instance = stepping(&[]);
    let references = [reference("u"), reference("gain")];
    let parts = ["fmi2SetReal", "gain: must not be negative"];
    assert_discarded(&mut instance, |i| i.set_real(&references, &[9.0, -1.0]), &parts);
    instance.step(0.0, 0.1).unwrap();
}

/// The trap would spring if the model were told of a value that is the same as before.
#[test]
fn the_model_is_told_only_of_changes() {
    let mut instance = stepping(&[("trap", 2.0)]);
    assert_eq!(instance.set_real(&[reference("gain"), reference("u")], &[1.0, 5.0]), Status::Ok);
    assert_eq!(instance.get("u").unwrap(), 5.0);
    assert_eq!(instance.set_real(&[reference("gain")], &[1.5]), Status::Error);
}
