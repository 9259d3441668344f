//! Status queries after a step, and functions that are not supported.

use crate::fixture::*;

#[test]
fn the_last_time_is_known_and_nothing_is_pending() {
    let mut instance = stepping(&[]);
    instance.step(0.0, 0.25).unwrap();
    let (c, api) = (instance.component(), instance.api());
    let (mut real, mut integer, mut string) = (-1.0, -1, std::ptr::null());
    const DO_STEP: i32 = 0;
    const PENDING: i32 = 1;
    const LAST_SUCCESSFUL_TIME: i32 = 2;
    const TERMINATED: i32 = 3;
    // SAFETY: the component is alive, and the pointers lead to one element.
    unsafe {
        assert_eq!((api.get_real_status)(c, LAST_SUCCESSFUL_TIME, &mut real), 0);
        assert_eq!(real, 0.25);
        assert_eq!((api.get_boolean_status)(c, TERMINATED, &mut integer), 0);
        assert_eq!(integer, 0);
        for kind in [DO_STEP, PENDING, 7, -1] {
            assert_eq!((api.get_status)(c, kind, &mut integer), 2);
            assert_eq!((api.get_integer_status)(c, kind, &mut integer), 2);
            assert_eq!((api.get_string_status)(c, kind, &mut string), 2);
            assert_eq!((api.get_real_status)(c, kind, &mut real), 2);
            assert_eq!((api.get_boolean_status)(c, kind, &mut integer), 2);
        }
        assert_eq!((api.get_real_status)(c, LAST_SUCCESSFUL_TIME, std::ptr::null_mut()), 3);
        assert_eq!((api.get_boolean_status)(c, TERMINATED, std::ptr::null_mut()), 3);
    }
}

#[test]
fn directional_derivatives_are_refused_with_a_reason() {
    let instance = stepping(&[]);
    let (c, api) = (instance.component(), instance.api());
    // SAFETY: the component is alive, and the pointers lead to one element.
    let status = unsafe { (api.get_directional_derivative)(c, &4, 1, &1, 1, &1.0, &mut 0.0) };
    assert_call_error(&instance, status.into(), moris_fmu_host::Status::Error, &["providesDirectionalDerivative"]);
}
