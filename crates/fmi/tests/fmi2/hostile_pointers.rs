//! Null and nonsense where pointers belong: an error, never a crash.

use std::ffi::c_void;
use std::ptr::{null, null_mut};

use crate::fixture::*;

#[test]
fn null_is_no_instance() {
    assert_refused_as_instance(null_mut());
}

#[test]
fn memory_that_is_no_instance_is_told_from_one() {
    let mut zeros = [0u64; 64];
    assert_refused_as_instance(zeros.as_mut_ptr().cast());
    assert_refused_as_instance(zeros.as_mut_ptr().cast::<c_void>().wrapping_byte_add(1));
    let mut instance = instantiated();
    let state = instance.get_state().unwrap();
    assert_refused_as_instance(state.pointer());
    assert_eq!(instance.free_state(state), moris_fmu_host::Status::Ok);
}

/// Every function refuses the pointer.
fn assert_refused_as_instance(c: *mut c_void) {
    let fmu = open();
    let api = fmu.api();
    // SAFETY: the pointer is null or leads to more memory than a look takes, and is to be refused.
    unsafe {
        let statuses = [
            (api.set_debug_logging)(c, 1, 0, null()),
            (api.setup_experiment)(c, 0, 0.0, 0.0, 0, 0.0),
            (api.enter_initialization_mode)(c),
            (api.exit_initialization_mode)(c),
            (api.terminate)(c),
            (api.reset)(c),
            (api.get_real)(c, null(), 0, null_mut()),
            (api.get_integer)(c, null(), 0, null_mut()),
            (api.get_boolean)(c, null(), 0, null_mut()),
            (api.get_string)(c, null(), 0, null_mut()),
            (api.set_real)(c, null(), 0, null()),
            (api.set_integer)(c, null(), 0, null()),
            (api.set_boolean)(c, null(), 0, null()),
            (api.set_string)(c, null(), 0, null()),
            (api.get_fmu_state)(c, null_mut()),
            (api.set_fmu_state)(c, null_mut()),
            (api.free_fmu_state)(c, null_mut()),
            (api.serialized_fmu_state_size)(c, null_mut(), null_mut()),
            (api.serialize_fmu_state)(c, null_mut(), null_mut(), 0),
            (api.deserialize_fmu_state)(c, null(), 0, null_mut()),
            (api.get_directional_derivative)(c, null(), 0, null(), 0, null(), null_mut()),
            (api.set_real_input_derivatives)(c, null(), 0, null(), null()),
            (api.get_real_output_derivatives)(c, null(), 0, null(), null_mut()),
            (api.do_step)(c, 0.0, 0.1, 1),
            (api.cancel_step)(c),
            (api.get_status)(c, 0, null_mut()),
            (api.get_real_status)(c, 2, null_mut()),
            (api.get_integer_status)(c, 0, null_mut()),
            (api.get_boolean_status)(c, 3, null_mut()),
            (api.get_string_status)(c, 1, null_mut()),
            (api.enter_event_mode)(c),
            (api.new_discrete_states)(c, null_mut()),
            (api.enter_continuous_time_mode)(c),
            (api.completed_integrator_step)(c, 0, null_mut(), null_mut()),
            (api.set_time)(c, 0.0),
            (api.set_continuous_states)(c, null(), 0),
            (api.get_derivatives)(c, null_mut(), 0),
            (api.get_event_indicators)(c, null_mut(), 0),
            (api.get_continuous_states)(c, null_mut(), 0),
            (api.get_nominals_of_continuous_states)(c, null_mut(), 0),
        ];
        assert!(statuses.iter().all(|&status| status == 3), "{statuses:?}");
        // With the four that take no instance, these are all.
        assert_eq!(statuses.len(), moris_fmu_host::Api::SYMBOLS.len() - 4);
        (api.free_instance)(c);
    }
}

#[test]
fn arrays_may_be_null_only_without_elements() {
    let mut instance = stepping(&[]);
    let before = bytes(&mut instance);
    let (c, api) = (instance.component(), instance.api());
    let (u, y) = (reference("u"), reference("y"));
    // SAFETY: the component is alive; null, a misaligned pointer and a length beyond all memory are to be refused.
    unsafe {
        assert_eq!((api.get_real)(c, null(), 0, null_mut()), 0);
        assert_eq!((api.set_real)(c, null(), 0, null()), 0);
        assert_eq!((api.set_real_input_derivatives)(c, null(), 0, null(), null()), 0);
        assert_eq!((api.get_real_output_derivatives)(c, null(), 0, null(), null_mut()), 0);
        let misaligned = [0u64; 4].as_ptr().byte_add(1);
        let refused = [
            (api.get_real)(c, null(), 1, &mut 0.0),
            (api.get_real)(c, &y, 1, null_mut()),
            (api.set_real)(c, null(), 1, &1.0),
            (api.set_real)(c, &u, 1, null()),
            (api.set_real)(c, misaligned.cast(), 1, &1.0),
            (api.set_real)(c, &u, 1, misaligned.cast()),
            (api.set_real)(c, &u, usize::MAX, &1.0),
            (api.get_integer)(c, &reference("count"), 1, null_mut()),
            (api.set_integer)(c, &reference("offset"), 1, null()),
            (api.get_boolean)(c, &reference("rising"), 1, null_mut()),
            (api.set_boolean)(c, &reference("frozen"), 1, null()),
            (api.set_real_input_derivatives)(c, &u, 1, null(), &1.0),
            (api.set_real_input_derivatives)(c, &u, 1, &1, null()),
            (api.set_real_input_derivatives)(c, null(), 1, &1, &1.0),
            (api.get_real_output_derivatives)(c, &y, 1, null(), &mut 0.0),
            (api.get_real_output_derivatives)(c, &y, 1, &1, null_mut()),
            (api.set_debug_logging)(c, 1, 1, null()),
        ];
        assert!(refused.iter().all(|&status| status == 3), "{refused:?}");
    }
    assert!(last_message(&instance).text.contains("null"));
    assert_eq!(bytes(&mut instance), before);
}
