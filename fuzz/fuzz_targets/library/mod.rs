//! The washout's C functions, linked into the fuzzer so that it sees which code its inputs reach.
#![allow(dead_code)] // each fuzzer uses one version

use std::mem::transmute;
use std::ptr::{null, null_mut};

use moris_fmu_host::{api, fmi3};

moris_fmi::export_fmi2!(moris_washout::Washout);
moris_fmi::export_fmi3!(moris_washout::Washout);

macro_rules! linked_fmi2 {
    ($($field:ident $function:ident ($($argument:ty),*) $(-> $result:ty)?;)+) => {
        api::Api {
            // SAFETY: the host declares the functions with the types that the standard gives them, as the library does.
            $( $field: unsafe { transmute::<*const (), _>(fmi2_functions::$function as *const ()) }, )+
        }
    };
}

macro_rules! linked_fmi3 {
    ($($field:ident $function:ident ($($argument:ty),*) $(-> $result:ty)?;)+) => {
        fmi3::Api {
            // SAFETY: as above.
            $( $field: unsafe { transmute::<*const (), _>(fmi3_functions::$function as *const ()) }, )+
        }
    };
}

/// The functions of FMI 2.0 as a host has them.
pub fn fmi2() -> api::Api {
    let api = moris_fmu_host::fmi2_functions!(linked_fmi2);
    // SAFETY: null is to be refused.
    keeping_the_hook(|| unsafe { (api.instantiate)(null(), 0, null(), null(), null(), 0, 0) }.is_null());
    api
}

/// The functions of FMI 3.0 as a host has them.
pub fn fmi3() -> fmi3::Api {
    let api = moris_fmu_host::fmi3_functions!(linked_fmi3);
    let instantiate = api.instantiate_co_simulation;
    // SAFETY: null is to be refused.
    keeping_the_hook(|| {
        unsafe { instantiate(null(), null(), null(), 0, 0, 0, 0, null(), 0, null_mut(), None, None) }.is_null()
    });
    api
}

/// Makes the library's first call, which silences panics, and then sets the
/// fuzzer's panic hook again.
///
/// The library is linked in here and shares that hook. From then on a panic, the host's or the
/// library's, ends the process with its text.
fn keeping_the_hook(first_call: impl FnOnce() -> bool) {
    let hook = std::panic::take_hook();
    let is_refused = first_call();
    std::panic::set_hook(hook);
    assert!(is_refused);
}
