//! The C functions of an FMU of FMI 3.0, as the standard declares them: for tests that load its
//! shared library and do right and wrong with it.

use std::ffi::{c_char, c_int, c_void};
use std::path::Path;

use libloading::Library as SharedLibrary;

use crate::HostError;
use crate::api::api;

/// An instance, as the FMU hands it out: fmi3Instance.
pub type Instance = *mut c_void;
/// A saved state, as the FMU hands it out: fmi3FMUState.
pub type FmuState = *mut c_void;
/// fmi3String
pub type Text = *const c_char;
/// fmi3Boolean: C's `bool`, of which 0 is false.
pub type Boolean = u8;
/// Value references.
pub type References = *const u32;

/// The host's function for messages.
pub type LogMessage = unsafe extern "C" fn(environment: *mut c_void, status: c_int, category: Text, message: Text);
/// A function of the host's that co-simulation without intermediate update never calls.
pub type Unused = Option<unsafe extern "C" fn()>;

/// The shared library of an FMU of FMI 3.0.
pub struct Library {
    api: Api,
    _library: SharedLibrary,
}

impl Library {
    /// Loads the library.
    ///
    /// # Errors
    /// The library cannot be loaded, or lacks a function of FMI 3.0.
    pub fn open(path: &Path) -> Result<Library, HostError> {
        let library_error = |source| HostError::Library { path: path.into(), source };
        // SAFETY: what loading the library runs is the FMU's; to open an FMU is to trust it.
        let library = unsafe { SharedLibrary::new(path) }.map_err(library_error)?;
        let api = Api::load(&library).map_err(library_error)?;
        Ok(Library { api, _library: library })
    }

    /// The library's functions.
    pub fn api(&self) -> &Api {
        &self.api
    }
}

/// Passes the functions of FMI 3.0 to a macro: each with a field's name, its own name, and its
/// type.
#[macro_export]
macro_rules! fmi3_functions {
    ($to:ident) => {
        $to! {
            get_version fmi3GetVersion() -> Text;
            set_debug_logging fmi3SetDebugLogging(Instance, Boolean, usize, *const Text) -> c_int;
            instantiate_model_exchange fmi3InstantiateModelExchange(Text, Text, Text, Boolean, Boolean, *mut c_void, Option<LogMessage>) -> Instance;
            instantiate_co_simulation fmi3InstantiateCoSimulation(Text, Text, Text, Boolean, Boolean, Boolean, Boolean, References, usize, *mut c_void, Option<LogMessage>, Unused) -> Instance;
            instantiate_scheduled_execution fmi3InstantiateScheduledExecution(Text, Text, Text, Boolean, Boolean, *mut c_void, Option<LogMessage>, Unused, Unused, Unused) -> Instance;
            free_instance fmi3FreeInstance(Instance);
            enter_initialization_mode fmi3EnterInitializationMode(Instance, Boolean, f64, f64, Boolean, f64) -> c_int;
            exit_initialization_mode fmi3ExitInitializationMode(Instance) -> c_int;
            enter_event_mode fmi3EnterEventMode(Instance) -> c_int;
            terminate fmi3Terminate(Instance) -> c_int;
            reset fmi3Reset(Instance) -> c_int;
            get_float32 fmi3GetFloat32(Instance, References, usize, *mut f32, usize) -> c_int;
            get_float64 fmi3GetFloat64(Instance, References, usize, *mut f64, usize) -> c_int;
            get_int8 fmi3GetInt8(Instance, References, usize, *mut i8, usize) -> c_int;
            get_uint8 fmi3GetUInt8(Instance, References, usize, *mut u8, usize) -> c_int;
            get_int16 fmi3GetInt16(Instance, References, usize, *mut i16, usize) -> c_int;
            get_uint16 fmi3GetUInt16(Instance, References, usize, *mut u16, usize) -> c_int;
            get_int32 fmi3GetInt32(Instance, References, usize, *mut i32, usize) -> c_int;
            get_uint32 fmi3GetUInt32(Instance, References, usize, *mut u32, usize) -> c_int;
            get_int64 fmi3GetInt64(Instance, References, usize, *mut i64, usize) -> c_int;
            get_uint64 fmi3GetUInt64(Instance, References, usize, *mut u64, usize) -> c_int;
            get_boolean fmi3GetBoolean(Instance, References, usize, *mut Boolean, usize) -> c_int;
            get_string fmi3GetString(Instance, References, usize, *mut Text, usize) -> c_int;
            get_binary fmi3GetBinary(Instance, References, usize, *mut usize, *mut *const u8, usize) -> c_int;
            get_clock fmi3GetClock(Instance, References, usize, *mut Boolean) -> c_int;
            set_float32 fmi3SetFloat32(Instance, References, usize, *const f32, usize) -> c_int;
            set_float64 fmi3SetFloat64(Instance, References, usize, *const f64, usize) -> c_int;
            set_int8 fmi3SetInt8(Instance, References, usize, *const i8, usize) -> c_int;
            set_uint8 fmi3SetUInt8(Instance, References, usize, *const u8, usize) -> c_int;
            set_int16 fmi3SetInt16(Instance, References, usize, *const i16, usize) -> c_int;
            set_uint16 fmi3SetUInt16(Instance, References, usize, *const u16, usize) -> c_int;
            set_int32 fmi3SetInt32(Instance, References, usize, *const i32, usize) -> c_int;
            set_uint32 fmi3SetUInt32(Instance, References, usize, *const u32, usize) -> c_int;
            set_int64 fmi3SetInt64(Instance, References, usize, *const i64, usize) -> c_int;
            set_uint64 fmi3SetUInt64(Instance, References, usize, *const u64, usize) -> c_int;
            set_boolean fmi3SetBoolean(Instance, References, usize, *const Boolean, usize) -> c_int;
            set_string fmi3SetString(Instance, References, usize, *const Text, usize) -> c_int;
            set_binary fmi3SetBinary(Instance, References, usize, *const usize, *const *const u8, usize) -> c_int;
            set_clock fmi3SetClock(Instance, References, usize, *const Boolean) -> c_int;
            get_number_of_variable_dependencies fmi3GetNumberOfVariableDependencies(Instance, u32, *mut usize) -> c_int;
            get_variable_dependencies fmi3GetVariableDependencies(Instance, u32, *mut usize, *mut u32, *mut usize, *mut c_int, usize) -> c_int;
            get_fmu_state fmi3GetFMUState(Instance, *mut FmuState) -> c_int;
            set_fmu_state fmi3SetFMUState(Instance, FmuState) -> c_int;
            free_fmu_state fmi3FreeFMUState(Instance, *mut FmuState) -> c_int;
            serialized_fmu_state_size fmi3SerializedFMUStateSize(Instance, FmuState, *mut usize) -> c_int;
            serialize_fmu_state fmi3SerializeFMUState(Instance, FmuState, *mut u8, usize) -> c_int;
            deserialize_fmu_state fmi3DeserializeFMUState(Instance, *const u8, usize, *mut FmuState) -> c_int;
            get_directional_derivative fmi3GetDirectionalDerivative(Instance, References, usize, References, usize, *const f64, usize, *mut f64, usize) -> c_int;
            get_adjoint_derivative fmi3GetAdjointDerivative(Instance, References, usize, References, usize, *const f64, usize, *mut f64, usize) -> c_int;
            enter_configuration_mode fmi3EnterConfigurationMode(Instance) -> c_int;
            exit_configuration_mode fmi3ExitConfigurationMode(Instance) -> c_int;
            get_interval_decimal fmi3GetIntervalDecimal(Instance, References, usize, *mut f64, *mut c_int) -> c_int;
            get_interval_fraction fmi3GetIntervalFraction(Instance, References, usize, *mut u64, *mut u64, *mut c_int) -> c_int;
            get_shift_decimal fmi3GetShiftDecimal(Instance, References, usize, *mut f64) -> c_int;
            get_shift_fraction fmi3GetShiftFraction(Instance, References, usize, *mut u64, *mut u64) -> c_int;
            set_interval_decimal fmi3SetIntervalDecimal(Instance, References, usize, *const f64) -> c_int;
            set_interval_fraction fmi3SetIntervalFraction(Instance, References, usize, *const u64, *const u64) -> c_int;
            set_shift_decimal fmi3SetShiftDecimal(Instance, References, usize, *const f64) -> c_int;
            set_shift_fraction fmi3SetShiftFraction(Instance, References, usize, *const u64, *const u64) -> c_int;
            evaluate_discrete_states fmi3EvaluateDiscreteStates(Instance) -> c_int;
            update_discrete_states fmi3UpdateDiscreteStates(Instance, *mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut f64) -> c_int;
            enter_continuous_time_mode fmi3EnterContinuousTimeMode(Instance) -> c_int;
            completed_integrator_step fmi3CompletedIntegratorStep(Instance, Boolean, *mut Boolean, *mut Boolean) -> c_int;
            set_time fmi3SetTime(Instance, f64) -> c_int;
            set_continuous_states fmi3SetContinuousStates(Instance, *const f64, usize) -> c_int;
            get_continuous_state_derivatives fmi3GetContinuousStateDerivatives(Instance, *mut f64, usize) -> c_int;
            get_event_indicators fmi3GetEventIndicators(Instance, *mut f64, usize) -> c_int;
            get_continuous_states fmi3GetContinuousStates(Instance, *mut f64, usize) -> c_int;
            get_nominals_of_continuous_states fmi3GetNominalsOfContinuousStates(Instance, *mut f64, usize) -> c_int;
            get_number_of_event_indicators fmi3GetNumberOfEventIndicators(Instance, *mut usize) -> c_int;
            get_number_of_continuous_states fmi3GetNumberOfContinuousStates(Instance, *mut usize) -> c_int;
            enter_step_mode fmi3EnterStepMode(Instance) -> c_int;
            get_output_derivatives fmi3GetOutputDerivatives(Instance, References, usize, *const i32, *mut f64, usize) -> c_int;
            do_step fmi3DoStep(Instance, f64, f64, Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut f64) -> c_int;
            activate_model_partition fmi3ActivateModelPartition(Instance, u32, f64) -> c_int;
        }
    };
}

fmi3_functions!(api);
