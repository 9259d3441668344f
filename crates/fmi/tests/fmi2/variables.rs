//! Getting and setting.

use moris_fmu_host::{Fmu, Instance, Status, variables_of};
use moris_interface::{Causality, Kind, SlotModel, Types, Variability};

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
            // A fixed parameter takes the value that it has; none has 2.
            let value = if row.variability == Variability::Fixed { 2.0 } else { 1.0 };
            assert_eq!(instance.set(&name, value).is_ok(), expected, "{name}");
            if !expected {
                let message = last_message(&instance);
                assert!(message.text.contains(&format!("'{name}'")), "{}", message.text);
                assert_eq!(message.status, Status::Error);
                assert_eq!(bytes(&mut instance), state);
            }
        }
    }
}

/// Hosts write all their parameters again once the simulation runs.
#[test]
fn a_fixed_parameter_takes_the_value_that_it_has_while_steps_are_made() {
    let mut instance = stepping(&[("tau", 0.25), ("substeps", 4.0)]);
    let [tau, gain] = ["tau", "gain"].map(reference);
    let (messages, state) = (instance.messages().len(), bytes(&mut instance));
    assert_eq!(instance.set_real(&[tau, gain], &[0.25, 1.0]), Status::Ok);
    assert_eq!(instance.set_integer(&[reference("substeps")], &[4]), Status::Ok);
    assert_eq!((instance.messages().len(), bytes(&mut instance)), (messages, state));
    assert_eq!(instance.set_real(&[gain, tau], &[2.0, 0.25]), Status::Ok);
    assert_eq!((instance.get("gain").unwrap(), instance.get("tau").unwrap()), (2.0, 0.25));
    let before = bytes(&mut instance);
    let parts = ["'tau' cannot be set in state 'step complete'", "Reset the instance"];
    for other in [0.250_000_1, f64::NAN] {
        let status = instance.set_real(&[gain, tau], &[3.0, other]);
        assert_call_error(&instance, status, Status::Error, &parts);
        assert_eq!(bytes(&mut instance), before);
    }
    let mut over = terminated();
    assert_eq!(over.set_real(&[tau], &[0.5]), Status::Error);
    assert_eq!(bytes(&mut over), bytes(&mut terminated()));
}

/// A host that knows no type but Real, by the GUID of a description that has none other.
#[test]
fn with_reals_only_every_variable_goes_by_real() {
    let token = Types::Reals.token(&guid());
    let fmu = Fmu::with_variables(&library(), &token, variables_of(&IDENTITY)).unwrap();
    let (mut reals, mut typed) = (fmu.instantiate("reals").unwrap(), instantiated());
    let start = [("gain", 3.0), ("method", 2.0), ("substeps", 4.0), ("tau", 0.25)];
    typed.initialize(&start, None).unwrap();
    assert_eq!(reals.setup_experiment(0.0, None), Status::Ok);
    assert_eq!(reals.enter_initialization_mode(), Status::Ok);
    for (name, value) in start {
        assert_eq!(reals.set_real(&[reference(name)], &[value]), Status::Ok, "{name}");
    }
    assert_eq!(reals.exit_initialization_mode(), Status::Ok);
    let inputs = [("u", 2.0), ("offset", -3.0), ("frozen", 0.0)];
    for step in 0..3 {
        for (name, value) in inputs {
            typed.set(name, value).unwrap();
            assert_eq!(reals.set_real(&[reference(name)], &[value]), Status::Ok, "{name}");
        }
        for instance in [&mut typed, &mut reals] {
            assert_eq!(instance.do_step(f64::from(step) * 0.1, 0.1), Status::Ok);
        }
    }
    for slot in 0..IDENTITY.slots.len() {
        let (name, mut value) = (IDENTITY.variable_name(slot), [f64::NAN]);
        assert_eq!(reals.get_real(&[slot as u32], &mut value), Status::Ok, "{name}");
        assert_eq!(value[0], typed.get(&name).unwrap(), "{name}");
    }
    let status = reals.set_integer(&[reference("offset")], &[1]);
    assert_call_error(&reals, status, Status::Error, &["'offset' is of type Real"]);
    // A parameter has to be a whole number, an input counts as the nearest.
    for (name, value, expected) in
        [("method", 1.5, "one of 1 (exact), 2 (euler)"), ("trap", 0.5, "a whole number from 0")]
    {
        let parts = [&format!("'{name}' is {value}, but must be {expected}")[..]];
        let status = reals.set_real(&[reference(name)], &[value]);
        assert_call_error(&reals, status, Status::Discard, &parts);
    }
    let y = |instance: &mut Instance, time: f64| {
        assert_eq!(instance.do_step(time, 0.1), Status::Ok);
        let mut value = [f64::NAN];
        assert_eq!(instance.get_real(&[reference("y")], &mut value), Status::Ok);
        value[0].to_bits()
    };
    assert_eq!(reals.set_real(&[reference("offset")], &[-2.6]), Status::Ok);
    assert_eq!(y(&mut reals, 0.3), y(&mut typed, 0.3), "-2.6 is -3");
    let held = y(&mut typed, 0.4);
    assert_eq!(y(&mut reals, 0.4), held);
    for (frozen, same) in [(0.6, true), (1.0, true), (7.0, true), (0.4, false)] {
        assert_eq!(reals.set_real(&[reference("frozen")], &[frozen]), Status::Ok);
        let time = reals.get("time").unwrap();
        assert_eq!(y(&mut reals, time) == held, same, "{frozen}");
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
