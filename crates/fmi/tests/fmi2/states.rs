//! Saving and restoring states, as memory and as bytes.

use moris_fmu_host::{Instance, Status};

use crate::fixture::*;

/// A few steps with changing inputs; all outputs' bits.
fn run(instance: &mut Instance, from: u32) -> Vec<u64> {
    let step = |n: u32| {
        instance.set("u", f64::from(n).sin()).unwrap();
        instance.step(f64::from(n) * 0.1, 0.1).unwrap();
        ["y", "count", "rising", "time"].map(|name| instance.get(name).unwrap().to_bits())
    };
    (from..from + 20).flat_map(step).collect()
}

#[test]
fn a_state_repeats_bit_for_bit_here_and_in_another_instance() {
    let fmu = open();
    let mut instance = fmu.instantiate("one").unwrap();
    instance.initialize(&[("tau", 0.7)], Some(100.0)).unwrap();
    run(&mut instance, 0);
    instance.set("gain", 2.0).unwrap();
    instance.set("offset", 1.0).unwrap();
    assert_eq!(instance.set_real_input_derivatives(&[reference("u")], &[0.5]), Status::Ok);
    let state = instance.get_state().unwrap();
    let saved = instance.serialize(&state).unwrap();
    let expected = run(&mut instance, 20);
    instance.set("gain", 9.0).unwrap();

    assert_eq!(instance.set_state(&state), Status::Ok);
    assert_eq!(instance.get("gain").unwrap(), 2.0);
    assert_eq!(run(&mut instance, 20), expected);

    let mut other = fmu.instantiate("two").unwrap();
    assert_eq!(other.set_state(&state), Status::Ok, "before any initialization, and with another instance's state");
    assert_eq!(run(&mut other, 20), expected);
    assert_eq!(other.do_step(99.9, 0.1), Status::Error, "the communication point is restored too");

    let mut third = fmu.instantiate("three").unwrap();
    let read = third.deserialize(&saved).unwrap();
    assert_eq!(third.serialize(&read).unwrap(), saved);
    assert_eq!(third.set_state(&read), Status::Ok);
    assert_eq!(run(&mut third, 20), expected);
    for state in [state, read] {
        assert_eq!(third.free_state(state), Status::Ok);
    }
}

/// Memory that is there already is used again.
#[test]
fn a_state_is_saved_over_another() {
    let mut instance = stepping(&[]);
    let mut state = instance.get_state().unwrap();
    let pointer = state.pointer();
    run(&mut instance, 0);
    assert_eq!(instance.get_state_into(&mut state), Status::Ok);
    assert_eq!(state.pointer(), pointer);
    let expected = run(&mut instance, 20);
    assert_eq!(instance.reset(), Status::Ok);
    assert_eq!(instance.set_state(&state), Status::Ok);
    assert_eq!(run(&mut instance, 20), expected);
    assert_eq!(instance.free_state(state), Status::Ok);
}

#[test]
fn a_state_brings_its_mode_back() {
    let makers = [instantiated, initializing, || stepping(&[]), terminated, failed];
    for (source, target) in (0..5).flat_map(|source| (0..5).map(move |target| (source, target))) {
        let mut instance = makers[source]();
        let state = instance.get_state().unwrap();
        let expected = instance.serialize(&state).unwrap();
        // Into another instance of the same library.
        let mut other = makers[target]();
        assert_eq!(other.set_state(&state), Status::Ok);
        assert_eq!(bytes(&mut other), expected, "{source} to {target}");
        assert_eq!(other.free_state(state), Status::Ok);
    }
}

/// An initialization that a state interrupts goes on where it was.
#[test]
fn values_that_are_set_and_untried_are_in_the_state() {
    let mut instance = initializing();
    instance.set("y0", 2.0).unwrap();
    let state = instance.get_state().unwrap();
    assert_eq!(instance.reset(), Status::Ok);
    assert_eq!(instance.set_state(&state), Status::Ok);
    assert_eq!(instance.get("y").unwrap(), 2.0);
    assert_eq!(instance.free_state(state), Status::Ok);
}

#[test]
fn damaged_bytes_are_refused() {
    let mut instance = stepping(&[]);
    run(&mut instance, 0);
    let good = bytes(&mut instance);
    let refused = |bytes: &[u8], instance: &mut Instance, what: &str| {
        assert!(instance.deserialize(bytes).is_err(), "{what}");
        let entries = instance.take_messages();
        assert!(entries.last().unwrap().text.contains("the serialized state is rejected"), "{what}");
    };
    for length in 0..good.len() {
        refused(&good[..length], &mut instance, &format!("cut to {length}"));
    }
    for (position, flip) in (0..good.len()).flat_map(|position| (0..8).map(move |bit| (position, 1 << bit))) {
        let mut bytes = good.clone();
        bytes[position] ^= flip;
        refused(&bytes, &mut instance, &format!("{flip:#x} at {position}"));
    }
    refused(&[&good[..], &[0]].concat(), &mut instance, "longer");
    refused(&[&good[..], &good[..]].concat(), &mut instance, "twice");
    refused(&vec![0xff; 100_000], &mut instance, "ones");
    let state = instance.deserialize(&good).unwrap();
    assert_eq!(instance.free_state(state), Status::Ok);
    assert_eq!(bytes(&mut instance), good);
}

#[test]
fn bytes_hold_no_addresses() {
    let all: Vec<_> = (0..2)
        .map(|_| {
            let mut instance = stepping(&[]);
            run(&mut instance, 0);
            bytes(&mut instance)
        })
        .collect();
    assert_eq!(all[0], all[1]);
}

#[test]
fn what_is_no_state_is_refused() {
    let mut instance = stepping(&[]);
    let state = instance.get_state().unwrap();
    let mut no_state = [0u64; 64];
    let (c, api) = (instance.component(), instance.api());
    let mut size = 0;
    let mut room = [0; 4096];
    // SAFETY: the component is alive, and the pointers are null or lead to enough memory.
    unsafe {
        for pointer in [std::ptr::null_mut(), no_state.as_mut_ptr().cast()] {
            assert_eq!((api.set_fmu_state)(c, pointer), 3);
            assert_eq!((api.serialized_fmu_state_size)(c, pointer, &mut size), 3);
            assert_eq!((api.serialize_fmu_state)(c, pointer, room.as_mut_ptr(), room.len()), 3);
        }
        let mut pointer = no_state.as_mut_ptr().cast();
        assert_eq!((api.free_fmu_state)(c, &mut pointer), 3);
        assert_eq!((api.get_fmu_state)(c, &mut pointer), 3);
        assert_eq!((api.get_fmu_state)(c, std::ptr::null_mut()), 3);
        assert_eq!((api.serialized_fmu_state_size)(c, state.pointer(), std::ptr::null_mut()), 3);
        assert_eq!((api.serialize_fmu_state)(c, state.pointer(), std::ptr::null_mut(), 4096), 3);
        assert_eq!((api.deserialize_fmu_state)(c, std::ptr::null(), 100, &mut pointer), 3);
        assert_eq!((api.deserialize_fmu_state)(c, room.as_ptr(), 100, std::ptr::null_mut()), 3);
        // Null is ignored, and a freed state's pointer becomes null.
        assert_eq!((api.free_fmu_state)(c, std::ptr::null_mut()), 0);
        let mut pointer = state.pointer();
        assert_eq!((api.free_fmu_state)(c, &mut pointer), 0);
        assert!(pointer.is_null());
        assert_eq!((api.free_fmu_state)(c, &mut pointer), 0);
    }
}

#[test]
fn a_state_is_not_written_where_it_has_no_room() {
    let mut instance = stepping(&[]);
    let state = instance.get_state().unwrap();
    let length = instance.serialize(&state).unwrap().len();
    let mut room = vec![0xaa; length + 10];
    let serialize = |instance: &Instance, room: &mut [u8], size| {
        // SAFETY: the component is alive, and there is room for `size` bytes.
        unsafe { (instance.api().serialize_fmu_state)(instance.component(), state.pointer(), room.as_mut_ptr(), size) }
    };
    assert_eq!(serialize(&instance, &mut room, length - 1), 3);
    assert!(last_message(&instance).text.contains("room"));
    assert!(room.iter().all(|&byte| byte == 0xaa));
    assert_eq!(serialize(&instance, &mut room, length + 10), 0, "more room than needed is fine");
    assert!(room[length..].iter().all(|&byte| byte == 0xaa));
    assert_eq!(instance.free_state(state), Status::Ok);
}
