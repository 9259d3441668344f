//! Saving and restoring states, as memory and as bytes.

use std::ptr::{null, null_mut};

use crate::fixture::*;

/// A few steps with changing inputs; all outputs' bits.
fn run(instance: &Instance, from: u32) -> Vec<u64> {
    let step = |n: u32| {
        let n = f64::from(n);
        instance.set_real("u", &[n.sin(), n.cos(), 1.0]);
        assert_eq!(instance.do_step(n * 0.1, 0.1).0, OK);
        instance.real::<6>("sum").map(f64::to_bits)
    };
    (from..from + 20).flat_map(step).collect()
}

#[test]
fn a_state_repeats_bit_for_bit_here_and_in_another_instance() {
    let instance = stepping();
    run(&instance, 0);
    instance.set_real("gain", &[2.0, 3.0, 4.0]);
    let state = instance.get_state();
    let saved = instance.serialize(state);
    let expected = run(&instance, 20);
    assert_eq!(instance.set_state(state), OK);
    assert_eq!(instance.real("gain"), [2.0, 3.0, 4.0]);
    assert_eq!(run(&instance, 20), expected);
    instance.free_state(state);

    let other = Instance::new();
    let read = other.deserialize(&saved).unwrap();
    assert_eq!(other.set_state(read), OK);
    assert_eq!(run(&other, 20), expected);
    other.free_state(read);
}

#[test]
fn a_state_brings_its_mode_back() {
    let makers = [Instance::new, initializing, stepping, terminated, failed];
    for (source, target) in (0..5).flat_map(|source| (0..5).map(move |target| (source, target))) {
        let instance = makers[source]();
        let state = instance.get_state();
        let expected = instance.serialize(state);
        let other = makers[target]();
        assert_eq!(other.set_state(state), OK);
        assert_eq!(other.bytes(), expected, "{source} to {target}");
        other.free_state(state);
    }
}

#[test]
fn damaged_bytes_are_refused() {
    let instance = stepping();
    run(&instance, 0);
    let good = instance.bytes();
    for length in 0..good.len() {
        assert_eq!(instance.deserialize(&good[..length]), Err(ERROR), "cut to {length}");
    }
    for position in 0..good.len() {
        let mut bytes = good.clone();
        bytes[position] ^= 0x10;
        assert_eq!(instance.deserialize(&bytes), Err(ERROR), "at {position}");
    }
    assert!(instance.last_message().2.contains("the serialized state is rejected"));
    assert_eq!(instance.bytes(), good);
}

#[test]
fn what_is_no_state_is_refused() {
    let instance = stepping();
    let (c, api) = (instance.pointer, instance.api());
    let mut no_state = [0u64; 64];
    let mut room = [0; 8];
    // SAFETY: the instance is alive, and the pointers are null or lead to enough memory.
    unsafe {
        for pointer in [null_mut(), no_state.as_mut_ptr().cast()] {
            assert_eq!((api.set_fmu_state)(c, pointer), ERROR);
            assert_eq!((api.serialized_fmu_state_size)(c, pointer, &mut 0), ERROR);
            assert_eq!((api.serialize_fmu_state)(c, pointer, room.as_mut_ptr(), room.len()), ERROR);
        }
        let mut pointer = no_state.as_mut_ptr().cast();
        assert_eq!((api.free_fmu_state)(c, &mut pointer), ERROR);
        assert_eq!((api.get_fmu_state)(c, &mut pointer), ERROR);
        assert_eq!((api.get_fmu_state)(c, null_mut()), ERROR);
        assert_eq!((api.deserialize_fmu_state)(c, null(), 100, &mut pointer), ERROR);
        let state = instance.get_state();
        let status = (api.serialize_fmu_state)(c, state, room.as_mut_ptr(), room.len());
        instance.assert_call_error(status, ERROR, &["fmi3SerializeFMUState", "room"]);
        instance.free_state(state);
        assert_eq!((api.free_fmu_state)(c, &mut null_mut()), OK);
    }
}
