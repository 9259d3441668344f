//! Washouts in many threads, and in threads with little room.

use std::thread;

use crate::fixture::*;

#[test]
fn sixteen_threads_get_the_bits_of_sixteen_runs_one_after_another() {
    /// The values along a ride of two seconds that begins at `n` seconds.
    fn run(n: u32) -> Vec<u64> {
        let mut instance = open().instantiate("washout").unwrap();
        assert_eq!(instance.setup_experiment(f64::from(n), None), moris_fmu_host::Status::Ok);
        instance.set("splitter.x.omega1", 1.0 + 0.1 * f64::from(n)).unwrap();
        assert_eq!(instance.enter_initialization_mode(), moris_fmu_host::Status::Ok);
        assert_eq!(instance.exit_initialization_mode(), moris_fmu_host::Status::Ok);
        (0..20).flat_map(|part| ride(&mut instance, 1000 * n + 100 * part, 100)).collect()
    }
    let alone: Vec<_> = (0..16).map(run).collect();
    let together: Vec<_> = (0..16).map(|n| thread::spawn(move || run(n))).collect();
    for (thread, expected) in together.into_iter().zip(&alone) {
        assert!(thread.join().unwrap() == *expected);
    }
    assert!(alone.windows(2).all(|pair| pair[0] != pair[1]), "each ride is another");
}

/// Rust's threads have 2 MiB by default, C's 512 KiB on macOS. A plan takes the most.
#[test]
fn a_thread_with_a_small_stack_will_do() {
    let small = || {
        let mut instance = open().instantiate("washout").unwrap();
        // A rig of one's own, which is surveyed.
        instance.initialize(&[("rig.base[1].x", 0.99)], None).unwrap();
        let expected = ride(&mut instance, 0, 10);
        let state = instance.get_state().unwrap();
        let saved = instance.serialize(&state).unwrap();
        let read = instance.deserialize(&saved).unwrap();
        assert_eq!(instance.set_state(&read), moris_fmu_host::Status::Ok);
        assert!(all_values(&mut instance) == expected);
        for state in [state, read] {
            assert_eq!(instance.free_state(state), moris_fmu_host::Status::Ok);
        }
    };
    thread::Builder::new().stack_size(320 * 1024).spawn(small).unwrap().join().unwrap();
}
