//! The libraries keep the ranges that the rows state.

use moris_interface::{Causality, Kind, Row, Variability, shown};

use crate::library::*;

/// The next number beyond each end of a range; the next whole number for integers.
fn beyond(row: &Row) -> [f64; 2] {
    let (min, max) = row.bounds();
    if matches!(row.kind, Kind::Real(_)) { [min.next_down(), max.next_up()] } else { [min - 1.0, max + 1.0] }
}

fn is_set_by_host(row: &Row) -> bool {
    matches!(row.causality, Causality::Input | Causality::Parameter) && row.kind != Kind::Boolean
}

#[test]
fn every_number_that_a_host_sets_has_a_range_with_its_start_value_inside() {
    for model in MODELS {
        let start = model.start();
        for slot in model.slots() {
            let (row, name) = (model.identity.row(slot), model.identity.variable_name(slot));
            if is_set_by_host(row) {
                let declared = row.range.is_some() || matches!(row.kind, Kind::Enumeration(_));
                assert!(declared, "{name} has no range");
                assert!(row.accepts(start[slot]), "{name} starts outside its range");
            }
        }
    }
}

/// Tested for all parameters in initialization mode, and for tunable ones between steps.
#[test]
fn parameters_take_the_ends_of_their_ranges_and_nothing_beyond() {
    for model in MODELS {
        for version in VERSIONS {
            let library = Library::open(model, version, &model.library());
            for stepping in [false, true] {
                let messages = Messages::default();
                let mut instance = library.instantiate(&messages).unwrap();
                assert_eq!(instance.enter_initialization_mode(), OK);
                if stepping {
                    assert_eq!(instance.exit_initialization_mode(), OK);
                }
                for slot in model.slots() {
                    let (row, name) = (model.identity.row(slot), model.identity.variable_name(slot));
                    let settable = !stepping || row.variability == Variability::Tunable;
                    if row.causality != Causality::Parameter || row.kind == Kind::Boolean || !settable {
                        continue;
                    }
                    let (min, max) = row.bounds();
                    if !stepping {
                        // The ends of several ranges may contradict each other. Such contradictions
                        // are checked only at the end of the initialization.
                        assert_eq!((instance.set(slot, min), instance.set(slot, max)), (OK, OK), "{name}");
                    }
                    for value in beyond(row) {
                        messages.borrow_mut().clear();
                        assert_eq!(instance.set(slot, value), DISCARD, "{name} = {value}");
                        let message = &messages.borrow()[0];
                        let parts = [format!("'{name}'"), shown(value), shown(min), shown(max)];
                        let named = if matches!(row.kind, Kind::Enumeration(_)) { &parts[..2] } else { &parts[..] };
                        assert!(named.iter().all(|part| message.contains(part)), "{message}");
                    }
                }
            }
        }
    }
}

/// The user hears of it once, by the name of the first such input, and again after a reset.
#[test]
fn an_input_beyond_its_range_is_a_warning_once() {
    for model in MODELS {
        for version in VERSIONS {
            let library = Library::open(model, version, &model.library());
            let messages = Messages::default();
            let mut instance = library.instantiate(&messages).unwrap();
            let is_real_input = |&slot: &usize| {
                let row = model.identity.row(slot);
                // FMI 3.0 names an array's variable otherwise.
                row.causality == Causality::Input && matches!(row.kind, Kind::Real(_)) && row.slots() == 1
            };
            let inputs: Vec<usize> = model.slots().filter(is_real_input).collect();
            for round in 0..2 {
                assert_eq!(instance.enter_initialization_mode(), OK);
                assert_eq!(instance.exit_initialization_mode(), OK);
                messages.borrow_mut().clear();
                for &slot in &inputs {
                    let (min, max) = model.identity.row(slot).bounds();
                    assert_eq!(instance.set(slot, max), OK);
                    assert_eq!(instance.set(slot, max + 1e-12 * (max - min)), OK);
                }
                for &slot in &inputs {
                    assert_eq!(instance.set(slot, 0.0), OK);
                }
                assert!(
                    messages.borrow().is_empty(),
                    "rounding and zero are no reason to warn: {:?}",
                    messages.borrow()
                );
                for &slot in &inputs {
                    let (_, max) = model.identity.row(slot).bounds();
                    assert_eq!(instance.set(slot, 3.0 * max), OK);
                }
                let (name, (_, max)) =
                    (model.identity.variable_name(inputs[0]), model.identity.row(inputs[0]).bounds());
                let expected = [format!("'{name}' is {}", shown(3.0 * max)), format!("the model uses {}", shown(max))];
                let heard = messages.borrow();
                assert_eq!(heard.len(), 1, "round {round}: {heard:?}");
                assert!(expected.iter().all(|part| heard[0].contains(part)), "{heard:?}");
                drop(heard);
                assert_eq!(instance.reset(), OK);
            }
        }
    }
}

/// The model refuses the force limit, so that no value of the call is taken.
#[test]
fn an_input_of_a_call_that_fails_is_no_warning() {
    let [.., model] = MODELS;
    let slots = ["command[1].velocity", "actuator.forceLimit"].map(|name| model.identity.slot(name).unwrap() as u32);
    for version in VERSIONS {
        let library = Library::open(model, version, &model.library());
        let messages = Messages::default();
        let mut instance = library.instantiate(&messages).unwrap();
        assert_eq!((instance.enter_initialization_mode(), instance.exit_initialization_mode()), (OK, OK));
        messages.borrow_mut().clear();
        assert_eq!(instance.set_reals(&slots, &[300.0, 1.0]), DISCARD);
        assert_eq!(instance.get_reals(&slots, &mut [0.0; 2]), OK);
        assert_eq!(instance.reset(), OK);
        let heard = messages.take();
        assert!(heard[0].contains("actuator.forceLimit: is 1 N") && heard[1..] == ["reset"], "{heard:?}");
        assert_eq!((instance.enter_initialization_mode(), instance.exit_initialization_mode()), (OK, OK));
        messages.borrow_mut().clear();
        assert_eq!(instance.set_reals(&slots, &[300.0, 4000.0]), OK);
        assert!(messages.borrow()[0].contains("'command[1].velocity' is 300"), "{:?}", messages.borrow());
    }
}

/// Rounding in a host may put an input slightly beyond its range. Such a value must
/// not end a simulation.
#[test]
fn inputs_beyond_their_range_count_as_its_end() {
    for model in MODELS {
        let outputs: Vec<u32> = model
            .slots()
            .filter(|&slot| {
                let row = model.identity.row(slot);
                row.causality == Causality::Output && matches!(row.kind, Kind::Real(_))
            })
            .map(|slot| slot as u32)
            .collect();
        let library = Library::open(model, Version::Fmi2, &model.library());
        let after = |slot: usize, value: f64| {
            let messages = Messages::default();
            let mut instance = library.instantiate(&messages).unwrap();
            assert_eq!(instance.enter_initialization_mode(), OK);
            assert_eq!(instance.exit_initialization_mode(), OK);
            assert_eq!(instance.set(slot, value), OK, "{}", model.identity.variable_name(slot));
            assert_eq!(instance.get(slot), value, "an input is read back as it was set");
            for k in 0..50 {
                assert_eq!(instance.step(0.01 * f64::from(k), 0.01), OK);
            }
            let mut values = vec![0.0; outputs.len()];
            assert_eq!(instance.get_reals(&outputs, &mut values), OK);
            values
        };
        for slot in model.slots() {
            let row = model.identity.row(slot);
            if row.causality == Causality::Input && matches!(row.kind, Kind::Real(_)) {
                let (min, max) = row.bounds();
                let name = model.identity.variable_name(slot);
                for (end, beyond) in [(min, min - 0.01), (max, max + 0.01), (max, 1e300), (min, -f64::MAX)] {
                    assert!(after(slot, beyond) == after(slot, end), "{name} = {beyond}");
                }
            }
        }
    }
}
