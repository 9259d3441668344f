//! Every allocation is freed again.

use moris_fmu_host::Status;

use crate::fixture::*;

/// One instance's life, with states, refused calls and messages.
fn one_round() {
    let mut instance = open().instantiate("washout").unwrap();
    instance.initialize(&[("tilt.rateLimit", 0.06)], None).unwrap();
    instance.step(0.0, 1e-3).unwrap();
    let state = instance.get_state().unwrap();
    let bytes = instance.serialize(&state).unwrap();
    let read = instance.deserialize(&bytes).unwrap();
    assert!(instance.deserialize(&bytes[1..]).is_err());
    assert_eq!(instance.do_step(0.0, -1.0), Status::Error);
    instance.set("tilt.rateLimit", 0.07).unwrap();
    assert_eq!(instance.set_state(&read), Status::Ok);
    for state in [state, read] {
        assert_eq!(instance.free_state(state), Status::Ok);
    }
}

/// The bytes that this process and the library, which share the C library's heap, have allocated.
fn allocated() -> usize {
    // SAFETY: it only counts.
    let counts = unsafe { libc::mallinfo2() };
    counts.uordblks + counts.hblkhd
}

/// Run in a process of its own, where nothing else allocates: see the next test.
#[test]
#[ignore = "a part of rounds_leave_nothing_behind, which runs it"]
fn count_what_is_left() {
    let _library_stays = open();
    (0..100).for_each(|_| one_round());
    let before = allocated();
    let rounds = 5_000;
    (0..rounds).for_each(|_| one_round());
    let after = allocated();
    // Anything that each round left would take 16 bytes at least; what the heap keeps in reserve varies by less.
    assert!(after < before + 16 * rounds, "{} bytes are left of {rounds} rounds", after - before);
}

#[test]
fn rounds_leave_nothing_behind() {
    run_alone("rounds::count_what_is_left");
}

/// For valgrind and the address sanitizer, which look at each byte and so are slow.
#[test]
fn a_few_rounds_do_no_harm() {
    (0..10).for_each(|_| one_round());
}
