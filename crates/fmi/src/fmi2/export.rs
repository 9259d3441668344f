//! The macro that makes the library's functions.

/// Exports a [`Model`](moris_interface::Model) by all functions of fmi2Functions.h, those of model
/// exchange included, which fail. Use it once, in a `cdylib`:
///
/// ```ignore
/// moris_fmi::export_fmi2!(my_crate::MyModel);
/// ```
///
/// Where the variable `FMU_START_VALUES` is set when the library is compiled, it holds start values
/// in place of the model's own: see [`SharedTables::new`](crate::SharedTables::new). Whoever sets
/// it has to make sure that the model can start with them.
#[macro_export]
macro_rules! export_fmi2 {
    ($model:ty) => {
        /// The functions of FMI 2.0, for C.
        #[allow(clippy::missing_safety_doc)] // the standard says what a host may pass
        pub mod fmi2_functions {
            $crate::own_functions_of_newer_glibc!();

            // SAFETY of all calls below: each function hands on what the host passes, for which the standard vouches.
            use std::ffi::{c_int, c_void};

            use $crate::abi::{fmu_state, lifecycle as common, unsupported};
            use $crate::fmi2::types::*;
            use $crate::fmi2::{Logger, calling_sequence as function, lifecycle, steps, variables};

            #[allow(unused_imports)] // the model's path may be relative to the macro's place
            use super::*;

            const SLOTS: usize = $crate::slot_count::<$model>();
            static TABLES: $crate::SharedTables<SLOTS> =
                $crate::SharedTables::new::<$model>(option_env!("FMU_START_VALUES"));

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetTypesPlatform() -> fmi2String {
                c"default".as_ptr()
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetVersion() -> fmi2String {
                c"2.0".as_ptr()
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2SetDebugLogging(
                component: fmi2Component,
                logging_on: fmi2Boolean,
                count: usize,
                categories: *const fmi2String,
            ) -> fmi2Status {
                unsafe { lifecycle::set_debug_logging::<$model>(component, logging_on, count, categories) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2Instantiate(
                instance_name: fmi2String,
                fmu_type: c_int,
                guid: fmi2String,
                _resource_location: fmi2String,
                callbacks: *const fmi2CallbackFunctions,
                _visible: fmi2Boolean,
                logging_on: fmi2Boolean,
            ) -> fmi2Component {
                unsafe {
                    lifecycle::instantiate::<$model, SLOTS>(
                        &TABLES,
                        instance_name,
                        fmu_type,
                        guid,
                        callbacks,
                        logging_on,
                    )
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2FreeInstance(component: fmi2Component) {
                unsafe { common::free_instance::<$model, Logger>(component) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2SetupExperiment(
                component: fmi2Component,
                tolerance_defined: fmi2Boolean,
                tolerance: fmi2Real,
                start_time: fmi2Real,
                stop_time_defined: fmi2Boolean,
                stop_time: fmi2Real,
            ) -> fmi2Status {
                unsafe {
                    lifecycle::setup_experiment::<$model>(
                        component,
                        tolerance_defined,
                        tolerance,
                        start_time,
                        stop_time_defined,
                        stop_time,
                    )
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2EnterInitializationMode(component: fmi2Component) -> fmi2Status {
                unsafe { lifecycle::enter_initialization_mode::<$model>(component) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2ExitInitializationMode(component: fmi2Component) -> fmi2Status {
                unsafe {
                    common::exit_initialization_mode::<$model, Logger>(component, &function::EXIT_INITIALIZATION_MODE)
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2Terminate(component: fmi2Component) -> fmi2Status {
                unsafe { common::terminate::<$model, Logger>(component, &function::TERMINATE) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2Reset(component: fmi2Component) -> fmi2Status {
                unsafe { common::reset::<$model, Logger>(component, &function::RESET) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetReal(
                component: fmi2Component,
                references: *const fmi2ValueReference,
                count: usize,
                values: *mut fmi2Real,
            ) -> fmi2Status {
                unsafe { variables::get::<$model, fmi2Real>(component, &function::GET_REAL, references, count, values) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetInteger(
                component: fmi2Component,
                references: *const fmi2ValueReference,
                count: usize,
                values: *mut fmi2Integer,
            ) -> fmi2Status {
                unsafe {
                    variables::get::<$model, fmi2Integer>(component, &function::GET_INTEGER, references, count, values)
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetBoolean(
                component: fmi2Component,
                references: *const fmi2ValueReference,
                count: usize,
                values: *mut fmi2Boolean,
            ) -> fmi2Status {
                unsafe {
                    variables::get::<$model, fmi2Boolean>(component, &function::GET_BOOLEAN, references, count, values)
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetString(
                component: fmi2Component,
                _references: *const fmi2ValueReference,
                count: usize,
                _values: *mut fmi2String,
            ) -> fmi2Status {
                unsafe { unsupported::none_of_this_type::<$model, Logger>(component, &function::GET_STRING, count) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2SetReal(
                component: fmi2Component,
                references: *const fmi2ValueReference,
                count: usize,
                values: *const fmi2Real,
            ) -> fmi2Status {
                unsafe { variables::set::<$model, fmi2Real>(component, &function::SET_REAL, references, count, values) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2SetInteger(
                component: fmi2Component,
                references: *const fmi2ValueReference,
                count: usize,
                values: *const fmi2Integer,
            ) -> fmi2Status {
                unsafe {
                    variables::set::<$model, fmi2Integer>(component, &function::SET_INTEGER, references, count, values)
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2SetBoolean(
                component: fmi2Component,
                references: *const fmi2ValueReference,
                count: usize,
                values: *const fmi2Boolean,
            ) -> fmi2Status {
                unsafe {
                    variables::set::<$model, fmi2Boolean>(component, &function::SET_BOOLEAN, references, count, values)
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2SetString(
                component: fmi2Component,
                _references: *const fmi2ValueReference,
                count: usize,
                _values: *const fmi2String,
            ) -> fmi2Status {
                unsafe { unsupported::none_of_this_type::<$model, Logger>(component, &function::SET_STRING, count) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetFMUstate(component: fmi2Component, state: *mut fmi2FMUstate) -> fmi2Status {
                unsafe { fmu_state::get::<$model, Logger>(component, &function::GET_FMU_STATE, state) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2SetFMUstate(component: fmi2Component, state: fmi2FMUstate) -> fmi2Status {
                unsafe { fmu_state::set::<$model, Logger>(component, &function::SET_FMU_STATE, state) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2FreeFMUstate(
                component: fmi2Component,
                state: *mut fmi2FMUstate,
            ) -> fmi2Status {
                unsafe { fmu_state::free::<$model, Logger>(component, &function::FREE_FMU_STATE, state) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
                component: fmi2Component,
                state: fmi2FMUstate,
                size: *mut usize,
            ) -> fmi2Status {
                unsafe {
                    fmu_state::serialized_size::<$model, Logger>(
                        component,
                        &function::SERIALIZED_FMU_STATE_SIZE,
                        state,
                        size,
                    )
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2SerializeFMUstate(
                component: fmi2Component,
                state: fmi2FMUstate,
                bytes: *mut fmi2Byte,
                size: usize,
            ) -> fmi2Status {
                unsafe {
                    fmu_state::serialize::<$model, Logger>(
                        component,
                        &function::SERIALIZE_FMU_STATE,
                        state,
                        bytes.cast(),
                        size,
                    )
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
                component: fmi2Component,
                bytes: *const fmi2Byte,
                size: usize,
                state: *mut fmi2FMUstate,
            ) -> fmi2Status {
                unsafe {
                    fmu_state::deserialize::<$model, Logger>(
                        component,
                        &function::DESERIALIZE_FMU_STATE,
                        bytes.cast(),
                        size,
                        state,
                    )
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
                component: fmi2Component,
                _unknowns: *const fmi2ValueReference,
                _unknown_count: usize,
                _knowns: *const fmi2ValueReference,
                _known_count: usize,
                _known_changes: *const fmi2Real,
                _unknown_changes: *mut fmi2Real,
            ) -> fmi2Status {
                unsafe {
                    unsupported::not_provided::<$model, Logger>(
                        component,
                        &function::GET_DIRECTIONAL_DERIVATIVE,
                        "providesDirectionalDerivative",
                    )
                }
            }

            // Co-simulation.

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
                component: fmi2Component,
                references: *const fmi2ValueReference,
                count: usize,
                orders: *const fmi2Integer,
                values: *const fmi2Real,
            ) -> fmi2Status {
                unsafe { variables::set_real_input_derivatives::<$model>(component, references, count, orders, values) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
                component: fmi2Component,
                references: *const fmi2ValueReference,
                count: usize,
                orders: *const fmi2Integer,
                values: *mut fmi2Real,
            ) -> fmi2Status {
                unsafe {
                    variables::get_real_output_derivatives::<$model>(component, references, count, orders, values)
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2DoStep(
                component: fmi2Component,
                time: fmi2Real,
                step: fmi2Real,
                _no_going_back: fmi2Boolean,
            ) -> fmi2Status {
                unsafe { steps::do_step::<$model>(component, time, step) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2CancelStep(component: fmi2Component) -> fmi2Status {
                unsafe { unsupported::never_allowed::<$model, Logger>(component, &function::CANCEL_STEP) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetStatus(
                component: fmi2Component,
                kind: c_int,
                _value: *mut fmi2Status,
            ) -> fmi2Status {
                unsafe { steps::nothing_pending::<$model>(component, &function::GET_STATUS, kind) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetRealStatus(
                component: fmi2Component,
                kind: c_int,
                value: *mut fmi2Real,
            ) -> fmi2Status {
                unsafe { steps::get_real_status::<$model>(component, kind, value) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetIntegerStatus(
                component: fmi2Component,
                kind: c_int,
                _value: *mut fmi2Integer,
            ) -> fmi2Status {
                unsafe { steps::nothing_pending::<$model>(component, &function::GET_INTEGER_STATUS, kind) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetBooleanStatus(
                component: fmi2Component,
                kind: c_int,
                value: *mut fmi2Boolean,
            ) -> fmi2Status {
                unsafe { steps::get_boolean_status::<$model>(component, kind, value) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetStringStatus(
                component: fmi2Component,
                kind: c_int,
                _value: *mut fmi2String,
            ) -> fmi2Status {
                unsafe { steps::nothing_pending::<$model>(component, &function::GET_STRING_STATUS, kind) }
            }

            // Model exchange.

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2EnterEventMode(component: fmi2Component) -> fmi2Status {
                unsafe { unsupported::never_allowed::<$model, Logger>(component, &function::ENTER_EVENT_MODE) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2NewDiscreteStates(
                component: fmi2Component,
                _event_info: *mut c_void,
            ) -> fmi2Status {
                unsafe { unsupported::never_allowed::<$model, Logger>(component, &function::NEW_DISCRETE_STATES) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2EnterContinuousTimeMode(component: fmi2Component) -> fmi2Status {
                unsafe {
                    unsupported::never_allowed::<$model, Logger>(component, &function::ENTER_CONTINUOUS_TIME_MODE)
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2CompletedIntegratorStep(
                component: fmi2Component,
                _no_going_back: fmi2Boolean,
                _enter_event_mode: *mut fmi2Boolean,
                _terminate: *mut fmi2Boolean,
            ) -> fmi2Status {
                unsafe { unsupported::never_allowed::<$model, Logger>(component, &function::COMPLETED_INTEGRATOR_STEP) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2SetTime(component: fmi2Component, _time: fmi2Real) -> fmi2Status {
                unsafe { unsupported::never_allowed::<$model, Logger>(component, &function::SET_TIME) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2SetContinuousStates(
                component: fmi2Component,
                _states: *const fmi2Real,
                _count: usize,
            ) -> fmi2Status {
                unsafe { unsupported::never_allowed::<$model, Logger>(component, &function::SET_CONTINUOUS_STATES) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetDerivatives(
                component: fmi2Component,
                _derivatives: *mut fmi2Real,
                _count: usize,
            ) -> fmi2Status {
                unsafe { unsupported::never_allowed::<$model, Logger>(component, &function::GET_DERIVATIVES) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetEventIndicators(
                component: fmi2Component,
                _indicators: *mut fmi2Real,
                _count: usize,
            ) -> fmi2Status {
                unsafe { unsupported::never_allowed::<$model, Logger>(component, &function::GET_EVENT_INDICATORS) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetContinuousStates(
                component: fmi2Component,
                _states: *mut fmi2Real,
                _count: usize,
            ) -> fmi2Status {
                unsafe { unsupported::never_allowed::<$model, Logger>(component, &function::GET_CONTINUOUS_STATES) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetNominalsOfContinuousStates(
                component: fmi2Component,
                _nominals: *mut fmi2Real,
                _count: usize,
            ) -> fmi2Status {
                unsafe {
                    unsupported::never_allowed::<$model, Logger>(
                        component,
                        &function::GET_NOMINALS_OF_CONTINUOUS_STATES,
                    )
                }
            }
        }
    };
}
