//! Null where pointers belong: an error, never a crash.

use std::ptr::{null, null_mut};

use crate::fixture::*;

#[test]
fn arrays_may_be_null_only_without_elements() {
    let instance = stepping();
    let before = instance.bytes();
    let (c, api) = (instance.pointer, instance.api());
    let (u, y) = (reference("u"), reference("y"));
    // SAFETY: the instance is alive; null, a misaligned pointer and a length beyond all memory are to be refused.
    unsafe {
        assert_eq!((api.get_float64)(c, null(), 0, null_mut(), 0), OK);
        assert_eq!((api.set_float64)(c, null(), 0, null(), 0), OK);
        assert_eq!((api.get_output_derivatives)(c, null(), 0, null(), null_mut(), 0), OK);
        let misaligned = [0u64; 4].as_ptr().byte_add(1);
        let refused = [
            (api.get_float64)(c, null(), 1, [0.0; 3].as_mut_ptr(), 3),
            (api.get_float64)(c, &y, 1, null_mut(), 3),
            (api.set_float64)(c, null(), 1, [0.0; 3].as_ptr(), 3),
            (api.set_float64)(c, &u, 1, null(), 3),
            (api.set_float64)(c, &u, 1, misaligned.cast(), 3),
            (api.set_float64)(c, &u, usize::MAX, [0.0; 3].as_ptr(), 3),
            (api.set_float64)(c, &u, 1, [0.0; 3].as_ptr(), usize::MAX),
            (api.get_int32)(c, &reference("count"), 1, null_mut(), 1),
            (api.set_boolean)(c, &reference("frozen"), 1, null(), 1),
            (api.get_output_derivatives)(c, &y, 1, null(), [0.0; 3].as_mut_ptr(), 3),
            (api.get_output_derivatives)(c, &y, 1, &1, null_mut(), 3),
            (api.set_debug_logging)(c, 1, 1, null()),
            (api.set_debug_logging)(c, 1, 1, [null()].as_ptr()),
        ];
        assert!(refused.iter().all(|&status| status == ERROR), "{refused:?}");
    }
    assert_eq!(instance.bytes(), before);
}

/// Without room for its answers a step is not made.
#[test]
fn a_step_needs_room_for_every_answer() {
    let instance = stepping();
    let before = instance.bytes();
    let (c, do_step) = (instance.pointer, instance.api().do_step);
    for missing in 0..4 {
        let (mut flags, mut time) = ([0; 3], 0.0);
        let flag = |k: usize, flags: &mut [u8; 3]| if k == missing { null_mut() } else { &raw mut flags[k] };
        let (event, terminate, early) = (flag(0, &mut flags), flag(1, &mut flags), flag(2, &mut flags));
        let last = if missing == 3 { null_mut() } else { &raw mut time };
        // SAFETY: the instance is alive; null is to be refused.
        let status = unsafe { do_step(c, 0.0, 0.1, 1, event, terminate, early, last) };
        instance.assert_call_error(status, ERROR, &["fmi3DoStep", "null"]);
        assert_eq!(instance.bytes(), before);
    }
}
