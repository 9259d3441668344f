//! Instances in many threads do not know of each other.

use std::thread;

use crate::fixture::*;

#[test]
fn sixteen_threads_get_what_one_gets() {
    fn run(gain: f64) -> Vec<u64> {
        let mut instance = stepping(&[("gain", gain)]);
        let step = |n: u32| {
            instance.set("u", f64::from(n).cos()).unwrap();
            instance.step(f64::from(n) * 1e-3, 1e-3).unwrap();
            if n.is_multiple_of(100) {
                assert!(instance.set("u", f64::NAN).is_err());
            }
            instance.get("y").unwrap().to_bits()
        };
        (0..2000).map(step).collect()
    }
    let alone: Vec<_> = (0..16).map(|n| run(f64::from(n))).collect();
    let together: Vec<_> = (0..16).map(|n| thread::spawn(move || run(f64::from(n)))).collect();
    for (thread, expected) in together.into_iter().zip(alone) {
        assert_eq!(thread.join().unwrap(), expected);
    }
}

#[test]
fn an_instance_can_move_to_another_thread() {
    let mut instance = stepping(&[]);
    let mut instance = thread::spawn(move || {
        instance.step(0.0, 0.1).unwrap();
        instance
    })
    .join()
    .unwrap();
    instance.step(0.1, 0.1).unwrap();
}
