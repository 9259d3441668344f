//! Getting and setting scalars and arrays.

use std::ffi::c_int;

use moris_interface::{Causality, Kind, Variability};

use crate::fixture::*;

/// The value reference of every variable, with its number of values.
fn variables() -> Vec<(u32, usize)> {
    let firsts = (0..IDENTITY.slots.len()).filter(|&slot| IDENTITY.slots[slot].element == 0);
    firsts.map(|slot| (slot as u32, IDENTITY.row(slot).slots())).collect()
}

#[test]
fn arrays_are_set_and_read_as_a_whole_and_several_together() {
    let instance = initializing();
    let weights: [f64; 18] = std::array::from_fn(|k| k as f64 * 0.5);
    instance.set_real("weight", &weights);
    assert_eq!(instance.real("weight"), weights);
    let [u, gain, tau] = ["u", "gain", "tau"].map(reference);
    assert_eq!(instance.set(&[tau, u, gain], &[9.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]), OK);
    let mut values = [0.0; 7];
    assert_eq!(instance.get(&[gain, tau, u], &mut values), OK);
    assert_eq!(values, [4.0, 5.0, 6.0, 9.0, 1.0, 2.0, 3.0]);
    assert_eq!(instance.get(&[], &mut []), OK);
    assert_eq!(instance.set(&[], &[]), OK);
}

#[test]
fn several_scalars_are_set_and_read_together_or_not_at_all() {
    let instance = initializing();
    let [time, tau, count] = ["time", "tau", "count"].map(reference);
    assert_eq!(instance.set(&[tau, tau], &[2.0, 3.0]), OK, "the last one counts");
    let mut values = [-1.0; 3];
    assert_eq!(instance.get(&[tau, time, tau], &mut values), OK);
    assert_eq!(values, [3.0, 0.0, 3.0]);
    let before = instance.bytes();
    let status = instance.set(&[tau, tau], &[4.0, f64::NAN]);
    instance.assert_call_error(status, DISCARD, &["fmi3SetFloat64", "'tau'", "finite"]);
    let status = instance.set(&[tau, time], &[4.0, 5.0]);
    instance.assert_call_error(status, ERROR, &["'time'"]);
    assert_eq!(instance.bytes(), before);
    let status = instance.get(&[tau, time, count], &mut values);
    instance.assert_call_error(status, ERROR, &["fmi3GetFloat64", "'count'", "Int32"]);
    assert_eq!(values, [3.0, 0.0, 3.0]);
}

#[test]
fn lengths_have_to_fit() {
    let instance = stepping();
    let before = instance.bytes();
    let [u, gain, y, time] = ["u", "gain", "y", "time"].map(reference);
    for length in [0, 1, 2, 4, 5, 100] {
        let status = instance.set(&[u], &vec![1.0; length]);
        instance.assert_call_error(status, ERROR, &["fmi3SetFloat64", "'u'", "3 values", &length.to_string()]);
        let mut room = vec![-1.0; length];
        let status = instance.get(&[y], &mut room);
        instance.assert_call_error(status, ERROR, &["fmi3GetFloat64", "'y'"]);
        assert!(room.iter().all(|&value| value == -1.0));
    }
    assert_eq!(instance.get(&[y, time, gain], &mut [0.0; 6]), ERROR);
    assert_eq!(instance.get(&[y, time, gain], &mut [0.0; 7]), OK);
    let mut room = [-1.0; 4];
    instance.assert_call_error(instance.get(&[y, reference("count")], &mut room), ERROR, &["'count'", "Int32"]);
    assert_eq!(room, [-1.0; 4]);
    assert_eq!(instance.get(&[], &mut [0.0]), ERROR);
    instance.assert_call_error(instance.set(&[], &[0.0]), ERROR, &["no variables"]);
    assert_eq!(instance.bytes(), before);
}

#[test]
fn an_array_goes_by_its_first_element() {
    let instance = initializing();
    let u = reference("u");
    for inner in [u + 1, u + 2] {
        let parts = ["fmi3SetFloat64", &inner.to_string(), "'u'", &format!("has {u}")];
        instance.assert_call_error(instance.set(&[inner], &[1.0]), ERROR, &parts);
        instance.assert_call_error(instance.get(&[inner], &mut [0.0]), ERROR, &["fmi3GetFloat64", "'u'"]);
    }
    for unknown in [IDENTITY.slots.len() as u32, 1_000_000, u32::MAX] {
        instance.assert_call_error(instance.set(&[unknown], &[1.0]), ERROR, &["no variable", &unknown.to_string()]);
        instance.assert_call_error(instance.get(&[unknown], &mut [0.0]), ERROR, &["no variable"]);
    }
}

/// Every variable by every type, got and set.
#[test]
fn variables_have_one_type() {
    let instance = initializing();
    let (c, api) = (instance.pointer, instance.api());
    for (reference, length) in variables() {
        let r = &raw const reference;
        // SAFETY: the instance is alive, and the arrays are as long as said.
        let statuses: [[c_int; 2]; 4] = unsafe {
            let (mut reals, mut integers) = (vec![0.0; length], vec![0; length]);
            let (mut longs, mut booleans) = (vec![0; length], vec![0; length]);
            [
                [
                    (api.get_float64)(c, r, 1, reals.as_mut_ptr(), length),
                    (api.set_float64)(c, r, 1, vec![1.0; length].as_ptr(), length),
                ],
                [
                    (api.get_int32)(c, r, 1, integers.as_mut_ptr(), length),
                    (api.set_int32)(c, r, 1, vec![1; length].as_ptr(), length),
                ],
                [
                    (api.get_int64)(c, r, 1, longs.as_mut_ptr(), length),
                    (api.set_int64)(c, r, 1, vec![1; length].as_ptr(), length),
                ],
                [
                    (api.get_boolean)(c, r, 1, booleans.as_mut_ptr(), length),
                    (api.set_boolean)(c, r, 1, vec![1; length].as_ptr(), length),
                ],
            ]
        };
        let row = IDENTITY.row(reference as usize);
        let own = match row.kind {
            Kind::Real(_) => 0,
            Kind::Integer => 1,
            Kind::Enumeration(_) => 2,
            Kind::Boolean => 3,
        };
        let settable = matches!(row.causality, Causality::Input | Causality::Parameter);
        for (by, [get, set]) in statuses.into_iter().enumerate() {
            assert_eq!(get, if by == own { OK } else { ERROR }, "{} by {by}", row.name);
            assert_eq!(set, if by == own && settable { OK } else { ERROR }, "{} by {by}", row.name);
        }
    }
    // SAFETY: the instance is alive, and the arrays have one element.
    let status = unsafe { (api.set_int32)(c, &reference("method"), 1, &1, 1) };
    instance.assert_call_error(status, ERROR, &["fmi3SetInt32", "'method'", "Int64"]);
}

#[test]
fn variables_can_be_set_where_the_standard_says() {
    for (reference, length) in variables() {
        let row = IDENTITY.row(reference as usize);
        if !matches!(row.kind, Kind::Real(_)) {
            continue;
        }
        let (before, stepping_too) = match (row.causality, row.variability) {
            (Causality::Input, _) | (Causality::Parameter, Variability::Tunable) => (true, true),
            (Causality::Parameter, _) => (true, false),
            _ => (false, false),
        };
        for (instance, expected) in [(Instance::new(), before), (initializing(), before), (stepping(), stepping_too)] {
            let state = instance.bytes();
            // None of the fixed parameters has this value.
            let status = instance.set(&[reference], &vec![0.75; length]);
            assert_eq!(status, if expected { OK } else { ERROR }, "{}", row.name);
            assert!(expected || instance.bytes() == state);
        }
    }
}

#[test]
fn a_fixed_parameter_takes_the_values_that_it_has_while_steps_are_made() {
    let instance = initializing();
    let mut weights: [f64; 18] = std::array::from_fn(|k| k as f64 * 0.5);
    instance.set_real("weight", &weights);
    assert_eq!(instance.exit_initialization_mode(), OK);
    let (messages, state) = (instance.messages(), instance.bytes());
    instance.set_real("weight", &weights);
    assert_eq!(instance.set(&[reference("tau")], &[0.5]), OK);
    assert_eq!((instance.messages(), instance.bytes()), (messages, state.clone()));
    weights[17] += 1e-9;
    let status = instance.set(&[reference("weight")], &weights);
    instance.assert_call_error(status, ERROR, &["cannot be set in state"]);
    assert_eq!(instance.bytes(), state);
}

#[test]
fn booleans_are_bytes_and_enumerations_are_long() {
    let instance = stepping();
    let (c, api) = (instance.pointer, instance.api());
    let [frozen, method, used, offset] = ["frozen", "method", "methodUsed", "offset"].map(reference);
    // SAFETY: the instance is alive, and the arrays have one element.
    unsafe {
        let (mut boolean, mut long) = (9, -1);
        assert_eq!((api.set_boolean)(c, &frozen, 1, &200, 1), OK);
        assert_eq!((api.get_boolean)(c, &frozen, 1, &mut boolean, 1), OK);
        assert_eq!(boolean, 1, "everything but 0 is true");
        assert_eq!((api.set_int64)(c, &method, 1, &2, 1), OK);
        assert_eq!(instance.do_step(0.0, 0.1).0, OK);
        assert_eq!((api.get_int64)(c, &used, 1, &mut long, 1), OK);
        assert_eq!(long, 2);
        let before = instance.bytes();
        for item in [0, 3, -1, i64::MAX, i64::MIN] {
            let status = (api.set_int64)(c, &method, 1, &item, 1);
            instance.assert_call_error(status, DISCARD, &["'method'", "1 (exact), 2 (euler)"]);
        }
        for value in [6, i32::MIN] {
            let status = (api.set_int32)(c, &offset, 1, &value, 1);
            instance.assert_call_error(status, DISCARD, &["'offset'", "-5 to 5"]);
        }
        assert_eq!(instance.bytes(), before);
    }
}

#[test]
fn a_call_is_taken_as_a_whole_or_not_at_all() {
    for instance in [initializing(), stepping()] {
        let before = instance.bytes();
        let [u, gain, y] = ["u", "gain", "y"].map(reference);
        let status = instance.set(&[u, gain], &[1.0, 2.0, 3.0, 4.0, f64::NAN, 6.0]);
        instance.assert_call_error(status, DISCARD, &["fmi3SetFloat64", "'gain[2]'", "finite"]);
        let status = instance.set(&[u, gain, y], &[1.0; 9]);
        instance.assert_call_error(status, ERROR, &["'y[1]'", "output"]);
        assert_eq!(instance.bytes(), before);
    }
    let instance = stepping();
    let before = instance.bytes();
    let status = instance.set(&[reference("u"), reference("gain")], &[9.0, 9.0, 9.0, 1.0, -1.0, 1.0]);
    instance.assert_call_error(status, DISCARD, &["gain: must not be negative"]);
    assert_eq!(instance.bytes(), before);
}

#[test]
fn types_without_variables_take_no_variables() {
    let instance = stepping();
    let (c, api) = (instance.pointer, instance.api());
    let mut name = std::ptr::null();
    // SAFETY: the instance is alive, and the arrays have one element.
    unsafe {
        assert_eq!((api.get_float32)(c, &1, 1, &mut 0.0, 1), ERROR);
        assert_eq!((api.get_string)(c, &1, 1, &mut name, 1), ERROR);
        assert_eq!((api.get_binary)(c, &1, 1, &mut 0, &mut std::ptr::null(), 1), ERROR);
        assert_eq!((api.set_uint64)(c, &1, 1, &0, 1), ERROR);
        assert_eq!((api.set_int8)(c, std::ptr::null(), 0, std::ptr::null(), 0), OK);
    }
}
