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

            pub(super) const SLOTS: usize = $crate::slot_count::<$model>();
            // Kept as a whole in the library's file, where a packing program replaces its values.
            #[used]
            static START: $crate::StartSection<SLOTS> = $crate::StartSection::own();
            pub(super) static TABLES: $crate::SharedTables<SLOTS> = $crate::SharedTables::new::<$model>(&START);

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi3GetVersion() -> fmi3String {
                c"3.0".as_ptr()
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
                let body = |component: &mut _| unsafe { steps::do_step::<$model>(component, time, step, &outcome) };
                unsafe { $crate::abi::call(instance, &function::DO_STEP, body) }
            }

            $crate::export_functions! {
                fmi3SetDebugLogging SET_DEBUG_LOGGING
                    (logging_on: fmi3Boolean, count: usize, categories: *const fmi3String)
                    => lifecycle::set_debug_logging::<$model>;
                fmi3EnterInitializationMode ENTER_INITIALIZATION_MODE
                    (tolerance_defined: fmi3Boolean, tolerance: f64, start_time: f64,
                     stop_time_defined: fmi3Boolean, stop_time: f64)
                    => lifecycle::enter_initialization_mode::<$model>;
                fmi3ExitInitializationMode EXIT_INITIALIZATION_MODE ()
                    => common::exit_initialization_mode::<$model, Logger>;
                fmi3Terminate TERMINATE () => common::terminate::<$model, Logger>;
                fmi3Reset RESET () => common::reset::<$model, Logger>;
                fmi3GetFloat64 GET_FLOAT64
                    (references: *const fmi3ValueReference, count: usize, values: *mut fmi3Float64, value_count: usize)
                    => variables::get::<$model, fmi3Float64>;
                fmi3GetInt32 GET_INT32
                    (references: *const fmi3ValueReference, count: usize, values: *mut fmi3Int32, value_count: usize)
                    => variables::get::<$model, fmi3Int32>;
                fmi3GetInt64 GET_INT64
                    (references: *const fmi3ValueReference, count: usize, values: *mut fmi3Int64, value_count: usize)
                    => variables::get::<$model, fmi3Int64>;
                fmi3GetBoolean GET_BOOLEAN
                    (references: *const fmi3ValueReference, count: usize, values: *mut fmi3Boolean, value_count: usize)
                    => variables::get::<$model, fmi3Boolean>;
                fmi3SetFloat64 SET_FLOAT64
                    (references: *const fmi3ValueReference, count: usize,
                     values: *const fmi3Float64, value_count: usize)
                    => variables::set::<$model, fmi3Float64>;
                fmi3SetInt32 SET_INT32
                    (references: *const fmi3ValueReference, count: usize, values: *const fmi3Int32, value_count: usize)
                    => variables::set::<$model, fmi3Int32>;
                fmi3SetInt64 SET_INT64
                    (references: *const fmi3ValueReference, count: usize, values: *const fmi3Int64, value_count: usize)
                    => variables::set::<$model, fmi3Int64>;
                fmi3SetBoolean SET_BOOLEAN
                    (references: *const fmi3ValueReference, count: usize,
                     values: *const fmi3Boolean, value_count: usize)
                    => variables::set::<$model, fmi3Boolean>;
                fmi3GetOutputDerivatives GET_OUTPUT_DERIVATIVES
                    (references: *const fmi3ValueReference, count: usize,
                     orders: *const i32, values: *mut f64, value_count: usize)
                    => variables::get_output_derivatives::<$model>;
                fmi3GetFMUState GET_FMU_STATE (state: *mut fmi3FMUState) => fmu_state::get::<$model, Logger>;
                fmi3SetFMUState SET_FMU_STATE (state: fmi3FMUState) => fmu_state::set::<$model, Logger>;
                fmi3FreeFMUState FREE_FMU_STATE (state: *mut fmi3FMUState) => fmu_state::free::<$model, Logger>;
                fmi3SerializedFMUStateSize SERIALIZED_FMU_STATE_SIZE (state: fmi3FMUState, size: *mut usize)
                    => fmu_state::serialized_size::<$model, Logger>;
                fmi3SerializeFMUState SERIALIZE_FMU_STATE (state: fmi3FMUState, bytes: *mut fmi3Byte, size: usize)
                    => fmu_state::serialize::<$model, Logger>;
                fmi3DeserializeFMUState DESERIALIZE_FMU_STATE
                    (bytes: *const fmi3Byte, size: usize, state: *mut fmi3FMUState)
                    => fmu_state::deserialize::<$model, Logger>;
            }

            $crate::export_none_of_this_type! {
                $model;
                fmi3GetFloat32 GET_FLOAT32 (*mut f32, usize);
                fmi3GetInt8 GET_INT8 (*mut i8, usize);
                fmi3GetUInt8 GET_UINT8 (*mut u8, usize);
                fmi3GetInt16 GET_INT16 (*mut i16, usize);
                fmi3GetUInt16 GET_UINT16 (*mut u16, usize);
                fmi3GetUInt32 GET_UINT32 (*mut u32, usize);
                fmi3GetUInt64 GET_UINT64 (*mut u64, usize);
                fmi3GetString GET_STRING (*mut fmi3String, usize);
                fmi3GetBinary GET_BINARY (*mut usize, *mut fmi3Binary, usize);
                fmi3SetFloat32 SET_FLOAT32 (*const f32, usize);
                fmi3SetInt8 SET_INT8 (*const i8, usize);
                fmi3SetUInt8 SET_UINT8 (*const u8, usize);
                fmi3SetInt16 SET_INT16 (*const i16, usize);
                fmi3SetUInt16 SET_UINT16 (*const u16, usize);
                fmi3SetUInt32 SET_UINT32 (*const u32, usize);
                fmi3SetUInt64 SET_UINT64 (*const u64, usize);
                fmi3SetString SET_STRING (*const fmi3String, usize);
                fmi3SetBinary SET_BINARY (*const usize, *const fmi3Binary, usize);
            }

            $crate::export_unsupported! {
                unsupported::not_provided::<$model, Logger>;
                fmi3GetNumberOfVariableDependencies GET_NUMBER_OF_VARIABLE_DEPENDENCIES
                    (fmi3ValueReference, *mut usize)
                    "providesPerElementDependencies";
                fmi3GetVariableDependencies GET_VARIABLE_DEPENDENCIES
                    (fmi3ValueReference, *mut usize, *mut fmi3ValueReference, *mut usize, *mut i32, usize)
                    "providesPerElementDependencies";
                fmi3GetDirectionalDerivative GET_DIRECTIONAL_DERIVATIVE
                    (*const fmi3ValueReference, usize, *const fmi3ValueReference, usize, *const f64, usize, *mut f64, usize)
                    "providesDirectionalDerivatives";
                fmi3GetAdjointDerivative GET_ADJOINT_DERIVATIVE
                    (*const fmi3ValueReference, usize, *const fmi3ValueReference, usize, *const f64, usize, *mut f64, usize)
                    "providesAdjointDerivatives";
            }

            $crate::export_unsupported! {
                unsupported::never_allowed::<$model, Logger>;
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
