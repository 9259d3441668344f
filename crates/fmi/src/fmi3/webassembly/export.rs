//! The exported functions of a component.

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
