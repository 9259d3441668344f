//! The macro that makes the library's functions.

/// Exports a [`Model`](moris_interface::Model) by all functions of fmi3Functions.h. Those of model
/// exchange, of scheduled execution, of event mode and of clocks fail. Use it once, in a `cdylib`:
///
/// ```ignore
/// moris_fmi::export_fmi3!(my_crate::MyModel);
/// ```
#[macro_export]
macro_rules! export_fmi3 {
    ($model:ty) => {
        /// The functions of FMI 3.0, for C.
        #[allow(clippy::missing_safety_doc)] // the standard says what a host may pass
        #[allow(clippy::too_many_arguments)] // it has so many
        pub mod fmi3_functions {
            $crate::own_functions_of_newer_glibc!();

            // SAFETY of all calls below: each function hands on what the host passes, for which the standard vouches.
            use $crate::abi::{fmu_state, lifecycle as common, unsupported};
            use $crate::fmi3::types::*;
            use $crate::fmi3::{Logger, calling_sequence as function, lifecycle, steps, variables};

            #[allow(unused_imports)] // the model's path may be relative to the macro's place
            use super::*;

            const SLOTS: usize = $crate::slot_count::<$model>();
            static TABLES: $crate::SharedTables<SLOTS> =
                $crate::SharedTables::new::<$model>(option_env!("FMU_START_VALUES"));

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3GetVersion() -> fmi3String {
                c"3.0".as_ptr()
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3SetDebugLogging(
                instance: fmi3Instance,
                logging_on: fmi3Boolean,
                count: usize,
                categories: *const fmi3String,
            ) -> fmi3Status {
                unsafe { lifecycle::set_debug_logging::<$model>(instance, logging_on, count, categories) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
                instance_name: fmi3String,
                instantiation_token: fmi3String,
                _resource_path: fmi3String,
                _visible: fmi3Boolean,
                logging_on: fmi3Boolean,
                event_mode_used: fmi3Boolean,
                _early_return_allowed: fmi3Boolean,
                _intermediate_variables: *const fmi3ValueReference,
                intermediate_variable_count: usize,
                environment: fmi3InstanceEnvironment,
                log_message: Option<fmi3LogMessageCallback>,
                _intermediate_update: fmi3UnusedCallback,
            ) -> fmi3Instance {
                let request = lifecycle::Request {
                    instance_name,
                    instantiation_token,
                    event_mode_used,
                    intermediate_variable_count,
                };
                let logger = Logger::new(log_message, environment, logging_on.is_true());
                unsafe { lifecycle::instantiate::<$model, SLOTS>(&TABLES, &request, logger) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3InstantiateModelExchange(
                _instance_name: fmi3String,
                _instantiation_token: fmi3String,
                _resource_path: fmi3String,
                _visible: fmi3Boolean,
                logging_on: fmi3Boolean,
                environment: fmi3InstanceEnvironment,
                log_message: Option<fmi3LogMessageCallback>,
            ) -> fmi3Instance {
                let logger = Logger::new(log_message, environment, logging_on.is_true());
                lifecycle::refuse_to_instantiate("fmi3InstantiateModelExchange", &logger)
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3InstantiateScheduledExecution(
                _instance_name: fmi3String,
                _instantiation_token: fmi3String,
                _resource_path: fmi3String,
                _visible: fmi3Boolean,
                logging_on: fmi3Boolean,
                environment: fmi3InstanceEnvironment,
                log_message: Option<fmi3LogMessageCallback>,
                _clock_update: fmi3UnusedCallback,
                _lock_preemption: fmi3UnusedCallback,
                _unlock_preemption: fmi3UnusedCallback,
            ) -> fmi3Instance {
                let logger = Logger::new(log_message, environment, logging_on.is_true());
                lifecycle::refuse_to_instantiate("fmi3InstantiateScheduledExecution", &logger)
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3FreeInstance(instance: fmi3Instance) {
                unsafe { common::free_instance::<$model, Logger>(instance) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3EnterInitializationMode(
                instance: fmi3Instance,
                tolerance_defined: fmi3Boolean,
                tolerance: f64,
                start_time: f64,
                stop_time_defined: fmi3Boolean,
                stop_time: f64,
            ) -> fmi3Status {
                let tolerance = tolerance_defined.is_true().then_some(tolerance);
                let stop_time = stop_time_defined.is_true().then_some(stop_time);
                unsafe {
                    lifecycle::enter_initialization_mode::<$model>(instance, tolerance, start_time, stop_time)
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3ExitInitializationMode(instance: fmi3Instance) -> fmi3Status {
                unsafe {
                    common::exit_initialization_mode::<$model, Logger>(instance, &function::EXIT_INITIALIZATION_MODE)
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3Terminate(instance: fmi3Instance) -> fmi3Status {
                unsafe { common::terminate::<$model, Logger>(instance, &function::TERMINATE) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3Reset(instance: fmi3Instance) -> fmi3Status {
                unsafe { common::reset::<$model, Logger>(instance, &function::RESET) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3DoStep(
                instance: fmi3Instance,
                time: f64,
                step: f64,
                _no_going_back: fmi3Boolean,
                event_handling_needed: *mut fmi3Boolean,
                terminate_simulation: *mut fmi3Boolean,
                early_return: *mut fmi3Boolean,
                last_successful_time: *mut f64,
            ) -> fmi3Status {
                let outcome = steps::StepOutcome {
                    event_handling_needed,
                    terminate_simulation,
                    early_return,
                    last_successful_time,
                };
                unsafe { steps::do_step::<$model>(instance, time, step, &outcome) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3GetOutputDerivatives(
                instance: fmi3Instance,
                references: *const fmi3ValueReference,
                count: usize,
                orders: *const i32,
                values: *mut f64,
                value_count: usize,
            ) -> fmi3Status {
                unsafe {
                    variables::get_output_derivatives::<$model>(
                        instance,
                        references,
                        count,
                        orders,
                        values,
                        value_count,
                    )
                }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3GetFMUState(instance: fmi3Instance, state: *mut fmi3FMUState) -> fmi3Status {
                unsafe { fmu_state::get::<$model, Logger>(instance, &function::GET_FMU_STATE, state) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3SetFMUState(instance: fmi3Instance, state: fmi3FMUState) -> fmi3Status {
                unsafe { fmu_state::set::<$model, Logger>(instance, &function::SET_FMU_STATE, state) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3FreeFMUState(instance: fmi3Instance, state: *mut fmi3FMUState) -> fmi3Status {
                unsafe { fmu_state::free::<$model, Logger>(instance, &function::FREE_FMU_STATE, state) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
                instance: fmi3Instance,
                state: fmi3FMUState,
                size: *mut usize,
            ) -> fmi3Status {
                let function = &function::SERIALIZED_FMU_STATE_SIZE;
                unsafe { fmu_state::serialized_size::<$model, Logger>(instance, function, state, size) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3SerializeFMUState(
                instance: fmi3Instance,
                state: fmi3FMUState,
                bytes: *mut fmi3Byte,
                size: usize,
            ) -> fmi3Status {
                let function = &function::SERIALIZE_FMU_STATE;
                unsafe { fmu_state::serialize::<$model, Logger>(instance, function, state, bytes, size) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3DeserializeFMUState(
                instance: fmi3Instance,
                bytes: *const fmi3Byte,
                size: usize,
                state: *mut fmi3FMUState,
            ) -> fmi3Status {
                let function = &function::DESERIALIZE_FMU_STATE;
                unsafe { fmu_state::deserialize::<$model, Logger>(instance, function, bytes, size, state) }
            }

            $crate::export_fmi3_variables! {
                $model;
                fmi3GetFloat64 GET_FLOAT64 fmi3SetFloat64 SET_FLOAT64 fmi3Float64;
                fmi3GetInt32 GET_INT32 fmi3SetInt32 SET_INT32 fmi3Int32;
                fmi3GetInt64 GET_INT64 fmi3SetInt64 SET_INT64 fmi3Int64;
                fmi3GetBoolean GET_BOOLEAN fmi3SetBoolean SET_BOOLEAN fmi3Boolean;
            }

            $crate::export_fmi3_none_of_this_type! {
                $model;
                fmi3GetFloat32 GET_FLOAT32 (*mut f32);
                fmi3GetInt8 GET_INT8 (*mut i8);
                fmi3GetUInt8 GET_UINT8 (*mut u8);
                fmi3GetInt16 GET_INT16 (*mut i16);
                fmi3GetUInt16 GET_UINT16 (*mut u16);
                fmi3GetUInt32 GET_UINT32 (*mut u32);
                fmi3GetUInt64 GET_UINT64 (*mut u64);
                fmi3GetString GET_STRING (*mut fmi3String);
                fmi3GetBinary GET_BINARY (*mut usize, *mut fmi3Binary);
                fmi3SetFloat32 SET_FLOAT32 (*const f32);
                fmi3SetInt8 SET_INT8 (*const i8);
                fmi3SetUInt8 SET_UINT8 (*const u8);
                fmi3SetInt16 SET_INT16 (*const i16);
                fmi3SetUInt16 SET_UINT16 (*const u16);
                fmi3SetUInt32 SET_UINT32 (*const u32);
                fmi3SetUInt64 SET_UINT64 (*const u64);
                fmi3SetString SET_STRING (*const fmi3String);
                fmi3SetBinary SET_BINARY (*const usize, *const fmi3Binary);
            }

            $crate::export_fmi3_not_provided! {
                $model;
                fmi3GetNumberOfVariableDependencies GET_NUMBER_OF_VARIABLE_DEPENDENCIES "providesPerElementDependencies"
                    (fmi3ValueReference, *mut usize);
                fmi3GetVariableDependencies GET_VARIABLE_DEPENDENCIES "providesPerElementDependencies"
                    (fmi3ValueReference, *mut usize, *mut fmi3ValueReference, *mut usize, *mut i32, usize);
                fmi3GetDirectionalDerivative GET_DIRECTIONAL_DERIVATIVE "providesDirectionalDerivatives"
                    (*const fmi3ValueReference, usize, *const fmi3ValueReference, usize, *const f64, usize, *mut f64, usize);
                fmi3GetAdjointDerivative GET_ADJOINT_DERIVATIVE "providesAdjointDerivatives"
                    (*const fmi3ValueReference, usize, *const fmi3ValueReference, usize, *const f64, usize, *mut f64, usize);
            }

            $crate::export_fmi3_unsupported! {
                $model;
                // Configuration mode and event mode.
                fmi3EnterConfigurationMode ENTER_CONFIGURATION_MODE ();
                fmi3ExitConfigurationMode EXIT_CONFIGURATION_MODE ();
                fmi3EnterEventMode ENTER_EVENT_MODE ();
                fmi3EvaluateDiscreteStates EVALUATE_DISCRETE_STATES ();
                fmi3UpdateDiscreteStates UPDATE_DISCRETE_STATES
                    (*mut fmi3Boolean, *mut fmi3Boolean, *mut fmi3Boolean, *mut fmi3Boolean, *mut fmi3Boolean, *mut f64);
                fmi3EnterStepMode ENTER_STEP_MODE ();
                // Clocks.
                fmi3GetClock GET_CLOCK (*const fmi3ValueReference, usize, *mut fmi3Boolean);
                fmi3SetClock SET_CLOCK (*const fmi3ValueReference, usize, *const fmi3Boolean);
                fmi3GetIntervalDecimal GET_INTERVAL_DECIMAL (*const fmi3ValueReference, usize, *mut f64, *mut i32);
                fmi3GetIntervalFraction GET_INTERVAL_FRACTION
                    (*const fmi3ValueReference, usize, *mut u64, *mut u64, *mut i32);
                fmi3GetShiftDecimal GET_SHIFT_DECIMAL (*const fmi3ValueReference, usize, *mut f64);
                fmi3GetShiftFraction GET_SHIFT_FRACTION (*const fmi3ValueReference, usize, *mut u64, *mut u64);
                fmi3SetIntervalDecimal SET_INTERVAL_DECIMAL (*const fmi3ValueReference, usize, *const f64);
                fmi3SetIntervalFraction SET_INTERVAL_FRACTION
                    (*const fmi3ValueReference, usize, *const u64, *const u64);
                fmi3SetShiftDecimal SET_SHIFT_DECIMAL (*const fmi3ValueReference, usize, *const f64);
                fmi3SetShiftFraction SET_SHIFT_FRACTION (*const fmi3ValueReference, usize, *const u64, *const u64);
                // Model exchange.
                fmi3EnterContinuousTimeMode ENTER_CONTINUOUS_TIME_MODE ();
                fmi3CompletedIntegratorStep COMPLETED_INTEGRATOR_STEP
                    (fmi3Boolean, *mut fmi3Boolean, *mut fmi3Boolean);
                fmi3SetTime SET_TIME (f64);
                fmi3SetContinuousStates SET_CONTINUOUS_STATES (*const f64, usize);
                fmi3GetContinuousStateDerivatives GET_CONTINUOUS_STATE_DERIVATIVES (*mut f64, usize);
                fmi3GetEventIndicators GET_EVENT_INDICATORS (*mut f64, usize);
                fmi3GetContinuousStates GET_CONTINUOUS_STATES (*mut f64, usize);
                fmi3GetNominalsOfContinuousStates GET_NOMINALS_OF_CONTINUOUS_STATES (*mut f64, usize);
                fmi3GetNumberOfEventIndicators GET_NUMBER_OF_EVENT_INDICATORS (*mut usize);
                fmi3GetNumberOfContinuousStates GET_NUMBER_OF_CONTINUOUS_STATES (*mut usize);
                // Scheduled execution.
                fmi3ActivateModelPartition ACTIVATE_MODEL_PARTITION (fmi3ValueReference, f64);
            }
        }
    };
}

/// The get and set functions of the types that variables have: a type a line.
#[doc(hidden)] // for `export_fmi3!`
#[macro_export]
macro_rules! export_fmi3_variables {
    ($model:ty; $($get:ident $get_constant:ident $set:ident $set_constant:ident $type:ty;)+) => {
        $(
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $get(
                instance: fmi3Instance,
                references: *const fmi3ValueReference,
                count: usize,
                values: *mut $type,
                value_count: usize,
            ) -> fmi3Status {
                let function = &function::$get_constant;
                unsafe { variables::get::<$model, $type>(instance, function, references, count, values, value_count) }
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $set(
                instance: fmi3Instance,
                references: *const fmi3ValueReference,
                count: usize,
                values: *const $type,
                value_count: usize,
            ) -> fmi3Status {
                let function = &function::$set_constant;
                unsafe { variables::set::<$model, $type>(instance, function, references, count, values, value_count) }
            }
        )+
    };
}

/// The get and set functions of the other types, with the types of their arguments between counts.
#[doc(hidden)] // for `export_fmi3!`
#[macro_export]
macro_rules! export_fmi3_none_of_this_type {
    ($model:ty; $($name:ident $constant:ident ($($values:ty),+);)+) => {
        $(
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(
                instance: fmi3Instance,
                _: *const fmi3ValueReference,
                count: usize,
                $( _: $values, )+
                _: usize,
            ) -> fmi3Status {
                unsafe { unsupported::none_of_this_type::<$model, Logger>(instance, &function::$constant, count) }
            }
        )+
    };
}

/// Functions that the FMU does not offer: the attribute that says so, and the types of the
/// arguments after the instance.
#[doc(hidden)] // for `export_fmi3!`
#[macro_export]
macro_rules! export_fmi3_not_provided {
    ($model:ty; $($name:ident $constant:ident $capability:literal ($($argument:ty),*);)+) => {
        $(
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(instance: fmi3Instance $(, _: $argument)*) -> fmi3Status {
                unsafe { unsupported::not_provided::<$model, Logger>(instance, &function::$constant, $capability) }
            }
        )+
    };
}

/// Functions that are never allowed, with the types of the arguments after the instance.
#[doc(hidden)] // for `export_fmi3!`
#[macro_export]
macro_rules! export_fmi3_unsupported {
    ($model:ty; $($name:ident $constant:ident ($($argument:ty),*);)+) => {
        $(
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(instance: fmi3Instance $(, _: $argument)*) -> fmi3Status {
                unsafe { unsupported::never_allowed::<$model, Logger>(instance, &function::$constant) }
            }
        )+
    };
}
