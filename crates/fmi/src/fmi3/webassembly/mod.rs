//! The functions of FMI 3.0 as a WebAssembly component, by the working draft fmi-ls-wasm.
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

use std::alloc::{Layout, alloc, handle_alloc_error, realloc};
use std::ffi::{CStr, CString, c_char, c_void};
use std::mem::ManuallyDrop;
use std::ptr::{null, null_mut};

use moris_interface::Model;

use super::types::*;
use super::{Logger, calling_sequence, lifecycle, steps, variables};
use crate::abi::{Function, call, fmu_state, lifecycle as common, unsupported};
use crate::{Modes, Scalar, SharedTables};

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

/// A list or string.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct List<T> {
    first: *mut T,
    length: usize,
}

impl<T> List<T> {
    /// A list of these values, which [`Release`] frees.
    pub fn new(values: Vec<T>) -> Self {
        let values = ManuallyDrop::new(values.into_boxed_slice());
        List { first: values.as_ptr().cast_mut(), length: values.len() }
    }

    /// The list that a host has passed.
    ///
    /// # Safety
    /// The memory is that of `cabi_realloc` or of [`List::new`], and is used by nothing else.
    pub unsafe fn take(first: *mut T, length: usize) -> Vec<T> {
        // SAFETY: allocated with the alignment and the size of these values, as the caller guarantees.
        if length == 0 { Vec::new() } else { unsafe { Vec::from_raw_parts(first, length, length) } }
    }
}

/// Results that a host reads from memory: a value, or the status of a call that failed.
#[repr(C)]
pub struct Answer<T: Copy> {
    failed: bool,
    content: Content<T>,
}

/// Lies where the alignment of both permits, as the canonical ABI has it.
#[derive(Clone, Copy)]
#[repr(C)]
union Content<T: Copy> {
    value: T,
    status: u8,
}

impl<T: Copy> Answer<T> {
    /// The value made if the call has succeeded or warned, else its status.
    fn new(status: fmi3Status, value: impl FnOnce() -> T) -> *mut Self {
        match status {
            fmi3Status::fmi3OK | fmi3Status::fmi3Warning => {
                Box::into_raw(Box::new(Answer { failed: false, content: Content { value: value() } }))
            }
            _ => Self::failed(status),
        }
    }

    /// The status of a call that failed.
    fn failed(status: fmi3Status) -> *mut Self {
        Box::into_raw(Box::new(Answer { failed: true, content: Content { status: status as u8 } }))
    }
}

/// Frees what a value owns.
pub trait Release {
    /// # Safety
    /// The value comes from here and is not used afterwards.
    unsafe fn release(&self) {}
}

impl Release for StepResult {}
impl Release for u64 {}

impl<T> Release for List<T> {
    unsafe fn release(&self) {
        // SAFETY: `List::new` made it.
        drop(unsafe { Self::take(self.first, self.length) });
    }
}

/// Frees an answer that the host has read.
///
/// # Safety
/// It comes from a function of this module.
pub unsafe fn release<T: Copy + Release>(answer: *mut Answer<T>) {
    // SAFETY: guaranteed by the caller.
    let answer = unsafe { Box::from_raw(answer) };
    if !answer.failed {
        // SAFETY: the value is there, because the call has not failed.
        unsafe { answer.content.value.release() };
    }
}

/// The record `do-step-result`.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct StepResult {
    last_successful_time: f64,
    event_handling_needed: fmi3Boolean,
    terminate_simulation: fmi3Boolean,
    early_return: fmi3Boolean,
}

/// A variable and an order of its derivative.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Request {
    reference: fmi3ValueReference,
    order: u32,
}

/// The record `interval-fraction`.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Fraction {
    counter: u64,
    resolution: u64,
}

/// An `option` of a handle.
#[repr(C)]
pub struct OptionalHandle {
    present: bool,
    handle: u32,
}

/// The version of FMI.
pub fn version() -> *mut List<u8> {
    Box::into_raw(Box::new(List::new(b"3.0".to_vec())))
}

/// Memory for lists: new for `old` of no size, else the old block with another size.
///
/// # Safety
/// As the canonical ABI says.
pub unsafe fn reallocate(old: *mut u8, old_size: usize, alignment: usize, size: usize) -> *mut u8 {
    let Ok(layout) = Layout::from_size_align(size, alignment) else { return null_mut() };
    // SAFETY: sizes are not zero where memory is requested; the old block comes from here.
    let block = unsafe {
        match (old_size, size) {
            (_, 0) => return alignment as *mut u8,
            (0, _) => alloc(layout),
            _ => realloc(old, Layout::from_size_align_unchecked(old_size, alignment), size),
        }
    };
    if block.is_null() {
        handle_alloc_error(layout);
    }
    block
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

/// Exports a [`Model`] that [`export_fmi3!`](crate::export_fmi3) exports as a component,
/// too. Use it beside that macro, for `wasm32-unknown-unknown`.
#[macro_export]
macro_rules! export_fmi3_component {
    ($model:ty) => {
        /// The functions of FMI 3.0, for a component's host.
        mod fmi3_component {
            // SAFETY of all calls below: the component model vouches for what a host passes.
            use $crate::abi::{lifecycle as common, unsupported};
            use $crate::fmi3::types::*;
            use $crate::fmi3::webassembly::{
                self as component, Answer, Fraction, List, OptionalHandle, Representation, Request, StepResult,
            };
            use $crate::fmi3::{Logger, lifecycle};

            use super::fmi3_functions::{SLOTS, TABLES};
            mod function {
                pub use $crate::fmi3::calling_sequence::*;
                pub use $crate::fmi3::webassembly::SET_INPUT_DERIVATIVES;
            }
            #[allow(unused_imports)] // the model's path may be relative to the macro's place
            use super::*;

            #[unsafe(no_mangle)]
            unsafe extern "C" fn cabi_realloc(old: *mut u8, old_size: usize, alignment: usize, size: usize) -> *mut u8 {
                unsafe { component::reallocate(old, old_size, alignment, size) }
            }

            #[unsafe(export_name = "fmi:fmi3/common@3.0.0#get-version")]
            unsafe extern "C" fn get_version() -> *mut List<u8> {
                component::version()
            }

            #[unsafe(export_name = "cabi_post_fmi:fmi3/common@3.0.0#get-version")]
            unsafe extern "C" fn release_version(version: *mut List<u8>) {
                unsafe { component::Release::release(&*Box::from_raw(version)) }
            }

            #[unsafe(export_name = "fmi:fmi3/co-simulation@3.0.0#[static]co-simulation-instance.instantiate-co-simulation")]
            unsafe extern "C" fn instantiate_co_simulation(
                name: *mut u8,
                name_length: usize,
                token: *mut u8,
                token_length: usize,
                resource_path: *mut u8,
                resource_path_length: usize,
                _visible: fmi3Boolean,
                logging_on: fmi3Boolean,
                event_mode_used: fmi3Boolean,
                _early_return_allowed: fmi3Boolean,
                intermediate_variables: *mut fmi3ValueReference,
                intermediate_variable_count: usize,
            ) -> *mut OptionalHandle {
                unsafe {
                    drop(List::take(resource_path, resource_path_length));
                    drop(List::take(intermediate_variables, intermediate_variable_count));
                    let texts = [List::take(name, name_length), List::take(token, token_length)];
                    component::instantiate::<$model, SLOTS>(
                        &TABLES,
                        texts,
                        logging_on,
                        event_mode_used,
                        intermediate_variable_count,
                    )
                }
            }

            #[unsafe(export_name = "cabi_post_fmi:fmi3/co-simulation@3.0.0#[static]co-simulation-instance.instantiate-co-simulation")]
            unsafe extern "C" fn release_optional(optional: *mut OptionalHandle) {
                drop(unsafe { Box::from_raw(optional) });
            }

            #[unsafe(export_name = "fmi:fmi3/co-simulation@3.0.0#[dtor]co-simulation-instance")]
            unsafe extern "C" fn free(representation: *mut Representation) {
                unsafe { component::free::<$model>(representation) }
            }

            $crate::component_calls! {
                "enter-initialization-mode" ENTER_INITIALIZATION_MODE
                    (has_tolerance: fmi3Boolean, tolerance: f64, start: f64, has_stop: fmi3Boolean, stop: f64) -> fmi3Status
                    => lifecycle::enter_initialization_mode::<$model>;
                "exit-initialization-mode" EXIT_INITIALIZATION_MODE
                    () -> fmi3Status
                    => common::exit_initialization_mode::<$model, Logger>;
                "terminate" TERMINATE () -> fmi3Status => common::terminate::<$model, Logger>;
                "reset" RESET () -> fmi3Status => common::reset::<$model, Logger>;
                "enter-configuration-mode" ENTER_CONFIGURATION_MODE
                    () -> fmi3Status
                    => unsupported::never_allowed::<$model, Logger>;
                "exit-configuration-mode" EXIT_CONFIGURATION_MODE
                    () -> fmi3Status
                    => unsupported::never_allowed::<$model, Logger>;
                "enter-event-mode" ENTER_EVENT_MODE () -> fmi3Status => unsupported::never_allowed::<$model, Logger>;
                "evaluate-discrete-states" EVALUATE_DISCRETE_STATES
                    () -> fmi3Status
                    => unsupported::never_allowed::<$model, Logger>;
                "enter-step-mode" ENTER_STEP_MODE () -> fmi3Status => unsupported::never_allowed::<$model, Logger>;
            }

            $crate::component_methods! {
                "set-debug-logging" SET_DEBUG_LOGGING
                    (on: fmi3Boolean, first: *mut List<u8>, length: usize) -> fmi3Status
                    => component::set_debug_logging::<$model>;
                "set-fmu-state" SET_FMU_STATE
                    (bytes: *mut u8, length: usize) -> fmi3Status
                    => component::set_fmu_state::<$model>;
            }

            $crate::component_setters! {
                "set-float64" SET_FLOAT64 (u32, fmi3Float64) => component::set::<$model, fmi3Float64>;
                "set-int32" SET_INT32 (u32, fmi3Int32) => component::set::<$model, fmi3Int32>;
                "set-int64" SET_INT64 (u32, fmi3Int64) => component::set::<$model, fmi3Int64>;
                "set-boolean" SET_BOOLEAN (u32, fmi3Boolean) => component::set::<$model, fmi3Boolean>;
                "set-float32" SET_FLOAT32 (u32, f32) => component::set_none::<$model, _, _>;
                "set-int8" SET_INT8 (u32, i8) => component::set_none::<$model, _, _>;
                "set-uint8" SET_UINT8 (u32, u8) => component::set_none::<$model, _, _>;
                "set-int16" SET_INT16 (u32, i16) => component::set_none::<$model, _, _>;
                "set-uint16" SET_UINT16 (u32, u16) => component::set_none::<$model, _, _>;
                "set-uint32" SET_UINT32 (u32, u32) => component::set_none::<$model, _, _>;
                "set-uint64" SET_UINT64 (u32, u64) => component::set_none::<$model, _, _>;
                "set-string" SET_STRING (u32, List<u8>) => component::set_no_texts::<$model>;
                "set-binary" SET_BINARY (u32, List<u8>) => component::set_no_texts::<$model>;
                "set-clock" SET_CLOCK (u32, u8) => component::set_none::<$model, _, _>;
                "set-interval-decimal" SET_INTERVAL_DECIMAL (u32, f64) => component::set_none::<$model, _, _>;
                "set-interval-fraction" SET_INTERVAL_FRACTION (u32, Fraction) => component::set_none::<$model, _, _>;
                "set-shift-decimal" SET_SHIFT_DECIMAL (u32, f64) => component::set_none::<$model, _, _>;
                "set-shift-fraction" SET_SHIFT_FRACTION (u32, Fraction) => component::set_none::<$model, _, _>;
                "set-input-derivatives" SET_INPUT_DERIVATIVES (Request, f64) => component::set_none::<$model, _, _>;
            }

            $crate::component_getters! {
                "get-float64" GET_FLOAT64 (List<fmi3Float64>) => component::get::<$model, fmi3Float64>;
                "get-int32" GET_INT32 (List<fmi3Int32>) => component::get::<$model, fmi3Int32>;
                "get-int64" GET_INT64 (List<fmi3Int64>) => component::get::<$model, fmi3Int64>;
                "get-boolean" GET_BOOLEAN (List<fmi3Boolean>) => component::get::<$model, fmi3Boolean>;
                "get-float32" GET_FLOAT32 (List<u8>) => component::get_none::<$model>;
                "get-int8" GET_INT8 (List<u8>) => component::get_none::<$model>;
                "get-uint8" GET_UINT8 (List<u8>) => component::get_none::<$model>;
                "get-int16" GET_INT16 (List<u8>) => component::get_none::<$model>;
                "get-uint16" GET_UINT16 (List<u8>) => component::get_none::<$model>;
                "get-uint32" GET_UINT32 (List<u8>) => component::get_none::<$model>;
                "get-uint64" GET_UINT64 (List<u8>) => component::get_none::<$model>;
                "get-string" GET_STRING (List<u8>) => component::get_none::<$model>;
                "get-binary" GET_BINARY (List<u8>) => component::get_none::<$model>;
                "get-clock" GET_CLOCK (List<u8>) => component::get_none::<$model>;
                "get-interval-decimal" GET_INTERVAL_DECIMAL (List<u8>) => component::get_none::<$model>;
                "get-interval-fraction" GET_INTERVAL_FRACTION (List<u8>) => component::get_none::<$model>;
                "get-shift-decimal" GET_SHIFT_DECIMAL (List<u8>) => component::get_none::<$model>;
                "get-shift-fraction" GET_SHIFT_FRACTION (List<u8>) => component::get_none::<$model>;
            }

            $crate::component_answers! {
                "get-output-derivatives" GET_OUTPUT_DERIVATIVES
                    (requests: *mut Request, length: usize) -> List<f64>
                    => component::get_output_derivatives::<$model>;
                "get-fmu-state" GET_FMU_STATE () -> List<u8> => component::get_fmu_state::<$model>;
                "do-step" DO_STEP
                    (time: f64, step: f64, no_going_back: fmi3Boolean) -> StepResult
                    => component::do_step::<$model>;
                "update-discrete-states" UPDATE_DISCRETE_STATES () -> u64 => component::never::<$model>;
                "get-number-of-variable-dependencies" GET_NUMBER_OF_VARIABLE_DEPENDENCIES
                    (reference: u32) -> u64
                    => component::no_dependencies::<$model, u64>;
                "get-variable-dependencies" GET_VARIABLE_DEPENDENCIES
                    (reference: u32) -> List<u8>
                    => component::no_dependencies::<$model, List<u8>>;
                "get-directional-derivative" GET_DIRECTIONAL_DERIVATIVE
                    (unknowns: *mut u32, unknown_count: usize, knowns: *mut u32, known_count: usize, seed: *mut f64, count: usize) -> List<f64>
                    => component::no_derivatives::<$model>;
                "get-adjoint-derivative" GET_ADJOINT_DERIVATIVE
                    (unknowns: *mut u32, unknown_count: usize, knowns: *mut u32, known_count: usize, seed: *mut f64, count: usize) -> List<f64>
                    => component::no_derivatives::<$model>;
            }
        }
    };
}

/// Methods of an instance whose result is a status: the name, the function's constant, and
/// the arguments after the instance.
#[doc(hidden)] // for `export_fmi3_component!`
#[macro_export]
macro_rules! component_methods {
    ($($name:literal $constant:ident ($($argument:ident: $type:ty),*) -> fmi3Status => $body:expr;)+) => {
        $(
            const _: () = {
                #[unsafe(export_name = concat!("fmi:fmi3/co-simulation@3.0.0#[method]co-simulation-instance.", $name))]
                unsafe extern "C" fn method(representation: *mut Representation $(, $argument: $type)*) -> fmi3Status {
                    unsafe { $body(component::instance(representation), &function::$constant $(, $argument)*) }
                }
            };
        )+
    };
}

/// The same for the functions that C calls.
#[doc(hidden)] // for `export_fmi3_component!`
#[macro_export]
macro_rules! component_calls {
    ($($name:literal $constant:ident ($($argument:ident: $type:ty),*) -> fmi3Status => $body:path;)+) => {
        $crate::component_methods! {
            $($name $constant ($($argument: $type),*) -> fmi3Status
                => |instance, function, $($argument: $type),*| $crate::abi::call(
                    instance, function, |component: &mut _| $body(component $(, $argument)*)
                );)+
        }
    };
}

/// Methods of an instance with several results.
#[doc(hidden)] // for `export_fmi3_component!`
#[macro_export]
macro_rules! component_answers {
    ($($name:literal $constant:ident ($($argument:ident: $type:ty),*) -> $result:ty => $body:path;)+) => {
        $(
            const _: () = {
                #[unsafe(export_name = concat!("fmi:fmi3/co-simulation@3.0.0#[method]co-simulation-instance.", $name))]
                unsafe extern "C" fn method(
                    representation: *mut Representation $(, $argument: $type)*
                ) -> *mut Answer<$result> {
                    unsafe { $body(component::instance(representation), &function::$constant $(, $argument)*) }
                }

                #[unsafe(export_name = concat!("cabi_post_fmi:fmi3/co-simulation@3.0.0#[method]co-simulation-instance.", $name))]
                unsafe extern "C" fn release(answer: *mut Answer<$result>) {
                    unsafe { component::release(answer) }
                }
            };
        )+
    };
}

/// Methods that take a list of variables, each with the type of its items, and a list of values.
#[doc(hidden)] // for `export_fmi3_component!`
#[macro_export]
macro_rules! component_setters {
    ($($name:literal $constant:ident ($variable:ty, $value:ty) => $body:path;)+) => {
        $crate::component_methods! {
            $($name $constant
                (variables: *mut $variable, length: usize, values: *mut $value, count: usize) -> fmi3Status
                => $body;)+
        }
    };
}

/// Methods that take a list of value references and answer a list.
#[doc(hidden)] // for `export_fmi3_component!`
#[macro_export]
macro_rules! component_getters {
    ($($name:literal $constant:ident ($result:ty) => $body:path;)+) => {
        $crate::component_answers! {
            $($name $constant (references: *mut u32, length: usize) -> $result => $body;)+
        }
    };
}
