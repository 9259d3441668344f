//! The functions of FMI 3.0 as a WebAssembly component, by the working draft fmi-ls-wasm.
//!
//! Nothing else of this crate uses this folder: a reader of the C functions may skip it.
//!
//! `wit/co-simulation-fmu.wit` declares them. A component's canonical ABI passes lists and strings
//! as C does, by address and length, and a resource as the address of its representation. So each
//! export hands its arguments to the function of the C interface. What differs:
//!
//! - A list from the host lies in memory of [`cabi_realloc`](crate::export_fmi3_component), and
//!   belongs to the function that is called.
//! - Several results come as the address of an [`Answer`], which the host's runtime frees by a
//!   second export.
//! - Messages go to an imported function.

use std::ffi::{CStr, CString, c_char, c_void};
use std::ptr::{null, null_mut};

use moris_interface::Model;

use super::types::*;
use super::{Logger, calling_sequence, lifecycle, steps, variables};
use crate::abi::{Function, call, fmu_state, lifecycle as common, unsupported};
use crate::{Modes, Scalar, SharedTables};

mod export;
mod lists;

pub use lists::{Answer, Fraction, List, OptionalHandle, Release, Request, StepResult, reallocate, release, version};

/// The draft has this function, which FMI 3.0 has not.
pub const SET_INPUT_DERIVATIVES: Function = Function { name: "set-input-derivatives", allowed: Modes::NONE };

#[link(wasm_import_module = "fmi:fmi3/callbacks@3.0.0")]
unsafe extern "C" {
    #[link_name = "log-message"]
    fn log_message(
        name: *const u8,
        name_length: usize,
        status: fmi3Status,
        category: *const u8,
        category_length: usize,
        message: *const u8,
        message_length: usize,
    );
}

#[link(wasm_import_module = "[export]fmi:fmi3/co-simulation@3.0.0")]
unsafe extern "C" {
    #[link_name = "[resource-new]co-simulation-instance"]
    fn new_handle(representation: *mut c_void) -> u32;
}

/// Representation of the resource `co-simulation-instance`.
pub struct Representation {
    instance: fmi3Instance,
    /// The environment of the instance's messages.
    _name: CString,
}

/// Sends a message on; the environment is the instance's name.
unsafe extern "C" fn log(name: fmi3InstanceEnvironment, status: fmi3Status, category: fmi3String, message: fmi3String) {
    // SAFETY: the strings live until this function returns.
    let [name, category, message] =
        [name.cast::<c_char>().cast_const(), category, message].map(|text| unsafe { CStr::from_ptr(text) }.to_bytes());
    // SAFETY: addresses and lengths of strings.
    unsafe {
        log_message(
            name.as_ptr(),
            name.len(),
            status,
            category.as_ptr(),
            category.len(),
            message.as_ptr(),
            message.len(),
        );
    }
}

/// `instantiate-co-simulation`
///
/// # Safety
/// The strings are the host's.
pub unsafe fn instantiate<M: Model, const N: usize>(
    tables: &'static SharedTables<N>,
    [name, token]: [Vec<u8>; 2],
    logging_on: fmi3Boolean,
    event_mode_used: fmi3Boolean,
    intermediate_variable_count: usize,
) -> *mut OptionalHandle {
    let [name, token] = [name, token].map(|text| CString::new(text).unwrap_or_default());
    let request = lifecycle::Request {
        instance_name: name.as_ptr(),
        instantiation_token: token.as_ptr(),
        event_mode_used,
        intermediate_variable_count,
    };
    let logger = Logger::new(Some(log), name.as_ptr().cast_mut().cast(), logging_on.is_true());
    // SAFETY: the strings live during the call, the name as long as the instance.
    let instance = unsafe { lifecycle::instantiate::<M, N>(tables, &request, logger) };
    let optional = if instance.is_null() {
        OptionalHandle { present: false, handle: 0 }
    } else {
        let representation = Box::into_raw(Box::new(Representation { instance, _name: name }));
        // SAFETY: a new representation gets a handle once.
        OptionalHandle { present: true, handle: unsafe { new_handle(representation.cast()) } }
    };
    Box::into_raw(Box::new(optional))
}

/// The destructor of the resource.
///
/// # Safety
/// The representation comes from [`instantiate`].
pub unsafe fn free<M: Model>(representation: *mut Representation) {
    // SAFETY: guaranteed by the caller.
    unsafe {
        let representation = Box::from_raw(representation);
        common::free_instance::<M, Logger>(representation.instance);
    }
}

/// The instance of a resource.
///
/// # Safety
/// The representation comes from [`instantiate`] and is not freed.
pub unsafe fn instance(representation: *mut Representation) -> fmi3Instance {
    // SAFETY: guaranteed by the caller.
    unsafe { (*representation).instance }
}

/// `set-debug-logging`
pub unsafe fn set_debug_logging<M: Model>(
    instance: fmi3Instance,
    function: &Function,
    logging_on: fmi3Boolean,
    first: *mut List<u8>,
    length: usize,
) -> fmi3Status {
    // SAFETY: the host's list of strings.
    let categories = unsafe { texts(first, length) };
    let categories: Vec<CString> = categories.into_iter().map(|text| CString::new(text).unwrap_or_default()).collect();
    let pointers: Vec<fmi3String> = categories.iter().map(|category| category.as_ptr()).collect();
    // SAFETY: the strings live during the call.
    unsafe {
        call(instance, function, |component| {
            lifecycle::set_debug_logging::<M>(component, logging_on, pointers.len(), pointers.as_ptr())
        })
    }
}

/// The host's list of strings or of bytes.
unsafe fn texts(first: *mut List<u8>, length: usize) -> Vec<Vec<u8>> {
    // SAFETY: the host's list, and the lists in it.
    unsafe { List::take(first, length).into_iter().map(|text| List::take(text.first, text.length)).collect() }
}

/// `get-float64` and its like for the types that variables have.
pub unsafe fn get<M: Model, S: Scalar>(
    instance: fmi3Instance,
    function: &Function,
    first: *mut fmi3ValueReference,
    length: usize,
) -> *mut Answer<List<S>> {
    // SAFETY: the host's list.
    let references = unsafe { List::take(first, length) };
    // SAFETY: the host's instance.
    let count = unsafe { variables::value_count::<M>(instance, &references) };
    let mut values = Vec::with_capacity(count);
    // SAFETY: memory for as many values, and all of them are written if the call succeeds.
    let status = unsafe {
        let status = call(instance, function, |component| {
            variables::get::<M, S>(component, references.as_ptr(), length, values.as_mut_ptr(), count)
        });
        values.set_len(if status == fmi3Status::fmi3OK { count } else { 0 });
        status
    };
    Answer::new(status, || List::new(values))
}

/// `set-float64` and its like for the types that variables have.
pub unsafe fn set<M: Model, S: Scalar>(
    instance: fmi3Instance,
    function: &Function,
    first: *mut fmi3ValueReference,
    length: usize,
    first_value: *mut S,
    value_count: usize,
) -> fmi3Status {
    // SAFETY: the host's lists.
    unsafe {
        let (references, values) = (List::take(first, length), List::take(first_value, value_count));
        call(instance, function, |component| {
            variables::set::<M, S>(component, references.as_ptr(), length, values.as_ptr(), value_count)
        })
    }
}

/// `get-output-derivatives`
pub unsafe fn get_output_derivatives<M: Model>(
    instance: fmi3Instance,
    function: &Function,
    first: *mut Request,
    length: usize,
) -> *mut Answer<List<f64>> {
    // SAFETY: the host's list.
    let requests = unsafe { List::take(first, length) };
    let references: Vec<fmi3ValueReference> = requests.iter().map(|request| request.reference).collect();
    let orders: Vec<i32> = requests.iter().map(|request| i32::try_from(request.order).unwrap_or(i32::MAX)).collect();
    // SAFETY: the host's instance.
    let mut values = vec![0.0; unsafe { variables::value_count::<M>(instance, &references) }];
    // SAFETY: as many orders as references, and memory for the values.
    let status = unsafe {
        let (references, orders) = (references.as_ptr(), orders.as_ptr());
        let (first, count) = (values.as_mut_ptr(), values.len());
        call(instance, function, |component| {
            variables::get_output_derivatives::<M>(component, references, length, orders, first, count)
        })
    };
    Answer::new(status, || List::new(values))
}

/// `do-step`
pub unsafe fn do_step<M: Model>(
    instance: fmi3Instance,
    function: &Function,
    time: f64,
    step: f64,
    _no_going_back: fmi3Boolean,
) -> *mut Answer<StepResult> {
    let no = fmi3Boolean(0);
    let mut result = StepResult {
        last_successful_time: time,
        event_handling_needed: no,
        terminate_simulation: no,
        early_return: no,
    };
    let outcome = steps::StepOutcome {
        event_handling_needed: &raw mut result.event_handling_needed,
        terminate_simulation: &raw mut result.terminate_simulation,
        early_return: &raw mut result.early_return,
        last_successful_time: &raw mut result.last_successful_time,
    };
    // SAFETY: the host's instance.
    let status = unsafe { call(instance, function, |component| steps::do_step::<M>(component, time, step, &outcome)) };
    Answer::new(status, || result)
}

/// `get-fmu-state`: the state's bytes.
pub unsafe fn get_fmu_state<M: Model>(instance: fmi3Instance, function: &Function) -> *mut Answer<List<u8>> {
    let mut state: fmi3FMUState = null_mut();
    let mut bytes = Vec::new();
    // SAFETY: the host's instance, and a state of it.
    let status = unsafe {
        let mut status = call(instance, function, |component| fmu_state::get::<M, Logger>(component, &raw mut state));
        if status == fmi3Status::fmi3OK {
            let mut size = 0;
            status = call(instance, &calling_sequence::SERIALIZED_FMU_STATE_SIZE, |component| {
                fmu_state::serialized_size::<M, Logger>(component, state, &raw mut size)
            });
            bytes.resize(size, 0);
            if status == fmi3Status::fmi3OK {
                let function = &calling_sequence::SERIALIZE_FMU_STATE;
                status = call(instance, function, |component| {
                    fmu_state::serialize::<M, Logger>(component, state, bytes.as_mut_ptr(), size)
                });
            }
            call(instance, &calling_sequence::FREE_FMU_STATE, |component| {
                fmu_state::free::<M, Logger>(component, &raw mut state)
            });
        }
        status
    };
    Answer::new(status, || List::new(bytes))
}

/// `set-fmu-state`: back to the state of these bytes.
pub unsafe fn set_fmu_state<M: Model>(
    instance: fmi3Instance,
    function: &Function,
    first: *mut u8,
    length: usize,
) -> fmi3Status {
    let mut state: fmi3FMUState = null_mut();
    // SAFETY: the host's list and instance, and a state of it.
    unsafe {
        let bytes = List::take(first, length);
        let deserialize = &calling_sequence::DESERIALIZE_FMU_STATE;
        let status = call(instance, deserialize, |component| {
            fmu_state::deserialize::<M, Logger>(component, bytes.as_ptr(), length, &raw mut state)
        });
        if status != fmi3Status::fmi3OK {
            return status;
        }
        let status = call(instance, function, |component| fmu_state::set::<M, Logger>(component, state));
        call(instance, &calling_sequence::FREE_FMU_STATE, |component| {
            fmu_state::free::<M, Logger>(component, &raw mut state)
        });
        status
    }
}

/// A get function of a type that no variable has, or that the calling sequence allows in no state.
pub unsafe fn get_none<M: Model>(
    instance: fmi3Instance,
    function: &Function,
    first: *mut fmi3ValueReference,
    length: usize,
) -> *mut Answer<List<u8>> {
    // SAFETY: the host's list and instance.
    let status = unsafe {
        drop(List::take(first, length));
        call(instance, function, |component| unsupported::none_of_this_type::<M, Logger>(component, length))
    };
    Answer::new(status, || List::new(Vec::new()))
}

/// A set function of a type that no variable has, or that the calling sequence allows in no state.
pub unsafe fn set_none<M: Model, R, T>(
    instance: fmi3Instance,
    function: &Function,
    first: *mut R,
    length: usize,
    first_value: *mut T,
    value_count: usize,
) -> fmi3Status {
    // SAFETY: the host's lists and instance.
    unsafe {
        drop((List::take(first, length), List::take(first_value, value_count)));
        call(instance, function, |component| unsupported::none_of_this_type::<M, Logger>(component, length))
    }
}

/// A set function of strings or of bytes, which no variable has.
pub unsafe fn set_no_texts<M: Model>(
    instance: fmi3Instance,
    function: &Function,
    first: *mut fmi3ValueReference,
    length: usize,
    first_value: *mut List<u8>,
    value_count: usize,
) -> fmi3Status {
    // SAFETY: the host's lists and instance.
    unsafe {
        drop(texts(first_value, value_count));
        set_none::<M, _, u8>(instance, function, first, length, null::<u8>().cast_mut(), 0)
    }
}

/// `update-discrete-states`, which is allowed in no state; its record is aligned as a `u64`.
pub unsafe fn never<M: Model>(instance: fmi3Instance, function: &Function) -> *mut Answer<u64> {
    // SAFETY: the host's instance.
    Answer::new(unsafe { call(instance, function, unsupported::never_allowed::<M, Logger>) }, || 0)
}

/// Functions for dependencies, of which there are none.
pub unsafe fn no_dependencies<M: Model, T: Copy>(
    instance: fmi3Instance,
    function: &Function,
    _reference: fmi3ValueReference,
) -> *mut Answer<T> {
    let capability = "providesPerElementDependencies";
    let body = |component: &mut _| unsupported::not_provided::<M, Logger>(component, capability);
    // SAFETY: the host's instance.
    let status = unsafe { call(instance, function, body) };
    Answer::failed(status)
}

/// `get-directional-derivative`, `get-adjoint-derivative`
#[allow(clippy::too_many_arguments)] // it has so many
pub unsafe fn no_derivatives<M: Model>(
    instance: fmi3Instance,
    function: &Function,
    unknowns: *mut fmi3ValueReference,
    unknown_count: usize,
    knowns: *mut fmi3ValueReference,
    known_count: usize,
    seed: *mut f64,
    count: usize,
) -> *mut Answer<List<f64>> {
    let capability = "providesDirectionalDerivatives or providesAdjointDerivatives";
    // SAFETY: the host's lists and instance.
    let status = unsafe {
        drop((List::take(unknowns, unknown_count), List::take(knowns, known_count), List::take(seed, count)));
        call(instance, function, |component| unsupported::not_provided::<M, Logger>(component, capability))
    };
    Answer::failed(status)
}
