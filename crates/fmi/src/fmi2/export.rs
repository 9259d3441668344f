//! The macro that makes the library's functions.

/// Exports a [`Model`](moris_interface::Model) by all functions of fmi2Functions.h, those of model
/// exchange included, which fail. Use it once, in a `cdylib`:
///
/// ```ignore
/// moris_fmi::export_fmi2!(my_crate::MyModel);
/// ```
///
/// A packing program can replace the model's start values in the compiled library: see
/// [`embed`](crate::embed). Such a program has to make sure that the model can start with them.
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
            // Kept as a whole in the library's file, where a packing program replaces its values.
            #[used]
            static START: $crate::StartSection<SLOTS> = $crate::StartSection::own();
            static TABLES: $crate::SharedTables<SLOTS> = $crate::SharedTables::new::<$model>(&START);

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetTypesPlatform() -> fmi2String {
                c"default".as_ptr()
            }

            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn fmi2GetVersion() -> fmi2String {
                c"2.0".as_ptr()
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

            $crate::export_functions! {
                fmi2SetDebugLogging SET_DEBUG_LOGGING
                    (logging_on: fmi2Boolean, count: usize, categories: *const fmi2String)
                    => lifecycle::set_debug_logging::<$model>;
                fmi2SetupExperiment SETUP_EXPERIMENT
                    (tolerance_defined: fmi2Boolean, tolerance: fmi2Real, start_time: fmi2Real,
                     stop_time_defined: fmi2Boolean, stop_time: fmi2Real)
                    => lifecycle::setup_experiment::<$model>;
                fmi2EnterInitializationMode ENTER_INITIALIZATION_MODE ()
                    => lifecycle::enter_initialization_mode::<$model>;
                fmi2ExitInitializationMode EXIT_INITIALIZATION_MODE ()
                    => common::exit_initialization_mode::<$model, Logger>;
                fmi2Terminate TERMINATE () => common::terminate::<$model, Logger>;
                fmi2Reset RESET () => common::reset::<$model, Logger>;
                fmi2GetReal GET_REAL (references: *const fmi2ValueReference, count: usize, values: *mut fmi2Real)
                    => variables::get::<$model, fmi2Real>;
                fmi2GetInteger GET_INTEGER
                    (references: *const fmi2ValueReference, count: usize, values: *mut fmi2Integer)
                    => variables::get::<$model, fmi2Integer>;
                fmi2GetBoolean GET_BOOLEAN
                    (references: *const fmi2ValueReference, count: usize, values: *mut fmi2Boolean)
                    => variables::get::<$model, fmi2Boolean>;
                fmi2SetReal SET_REAL (references: *const fmi2ValueReference, count: usize, values: *const fmi2Real)
                    => variables::set::<$model, fmi2Real>;
                fmi2SetInteger SET_INTEGER
                    (references: *const fmi2ValueReference, count: usize, values: *const fmi2Integer)
                    => variables::set::<$model, fmi2Integer>;
                fmi2SetBoolean SET_BOOLEAN
                    (references: *const fmi2ValueReference, count: usize, values: *const fmi2Boolean)
                    => variables::set::<$model, fmi2Boolean>;
                fmi2GetFMUstate GET_FMU_STATE (state: *mut fmi2FMUstate) => fmu_state::get::<$model, Logger>;
                fmi2SetFMUstate SET_FMU_STATE (state: fmi2FMUstate) => fmu_state::set::<$model, Logger>;
                fmi2FreeFMUstate FREE_FMU_STATE (state: *mut fmi2FMUstate) => fmu_state::free::<$model, Logger>;
                fmi2SerializedFMUstateSize SERIALIZED_FMU_STATE_SIZE (state: fmi2FMUstate, size: *mut usize)
                    => fmu_state::serialized_size::<$model, Logger>;
                fmi2SerializeFMUstate SERIALIZE_FMU_STATE (state: fmi2FMUstate, bytes: *mut fmi2Byte, size: usize)
                    => fmu_state::serialize::<$model, Logger>;
                fmi2DeSerializeFMUstate DESERIALIZE_FMU_STATE
                    (bytes: *const fmi2Byte, size: usize, state: *mut fmi2FMUstate)
                    => fmu_state::deserialize::<$model, Logger>;
                // Co-simulation.
                fmi2SetRealInputDerivatives SET_REAL_INPUT_DERIVATIVES
                    (references: *const fmi2ValueReference, count: usize,
                     orders: *const fmi2Integer, values: *const fmi2Real)
                    => variables::set_real_input_derivatives::<$model>;
                fmi2GetRealOutputDerivatives GET_REAL_OUTPUT_DERIVATIVES
                    (references: *const fmi2ValueReference, count: usize,
                     orders: *const fmi2Integer, values: *mut fmi2Real)
                    => variables::get_real_output_derivatives::<$model>;
                fmi2DoStep DO_STEP (time: fmi2Real, step: fmi2Real, no_going_back: fmi2Boolean)
                    => steps::do_step::<$model>;
                fmi2GetStatus GET_STATUS (kind: c_int, value: *mut fmi2Status)
                    => steps::nothing_pending::<$model, fmi2Status>;
                fmi2GetRealStatus GET_REAL_STATUS (kind: c_int, value: *mut fmi2Real)
                    => steps::get_real_status::<$model>;
                fmi2GetIntegerStatus GET_INTEGER_STATUS (kind: c_int, value: *mut fmi2Integer)
                    => steps::nothing_pending::<$model, fmi2Integer>;
                fmi2GetBooleanStatus GET_BOOLEAN_STATUS (kind: c_int, value: *mut fmi2Boolean)
                    => steps::get_boolean_status::<$model>;
                fmi2GetStringStatus GET_STRING_STATUS (kind: c_int, value: *mut fmi2String)
                    => steps::nothing_pending::<$model, fmi2String>;
            }

            $crate::export_none_of_this_type! {
                $model;
                fmi2GetString GET_STRING (*mut fmi2String);
                fmi2SetString SET_STRING (*const fmi2String);
            }

            $crate::export_unsupported! {
                unsupported::not_provided::<$model, Logger>;
                fmi2GetDirectionalDerivative GET_DIRECTIONAL_DERIVATIVE
                    (*const fmi2ValueReference, usize, *const fmi2ValueReference, usize, *const fmi2Real, *mut fmi2Real)
                    "providesDirectionalDerivative";
            }

            $crate::export_unsupported! {
                unsupported::never_allowed::<$model, Logger>;
                fmi2CancelStep CANCEL_STEP ();
                // Model exchange.
                fmi2EnterEventMode ENTER_EVENT_MODE ();
                fmi2NewDiscreteStates NEW_DISCRETE_STATES (*mut c_void);
                fmi2EnterContinuousTimeMode ENTER_CONTINUOUS_TIME_MODE ();
                fmi2CompletedIntegratorStep COMPLETED_INTEGRATOR_STEP
                    (fmi2Boolean, *mut fmi2Boolean, *mut fmi2Boolean);
                fmi2SetTime SET_TIME (fmi2Real);
                fmi2SetContinuousStates SET_CONTINUOUS_STATES (*const fmi2Real, usize);
                fmi2GetDerivatives GET_DERIVATIVES (*mut fmi2Real, usize);
                fmi2GetEventIndicators GET_EVENT_INDICATORS (*mut fmi2Real, usize);
                fmi2GetContinuousStates GET_CONTINUOUS_STATES (*mut fmi2Real, usize);
                fmi2GetNominalsOfContinuousStates GET_NOMINALS_OF_CONTINUOUS_STATES (*mut fmi2Real, usize);
            }
        }
    };
}
