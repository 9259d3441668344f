//! The C functions of an FMU, as the standard declares them.

use std::ffi::{c_char, c_int, c_void};

/// Status of a call: fmi2Status.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    Ok,
    Warning,
    Discard,
    Error,
    Fatal,
    Pending,
    /// A number that the standard does not know.
    Unknown(c_int),
}

impl From<c_int> for Status {
    fn from(status: c_int) -> Self {
        match status {
            0 => Status::Ok,
            1 => Status::Warning,
            2 => Status::Discard,
            3 => Status::Error,
            4 => Status::Fatal,
            5 => Status::Pending,
            unknown => Status::Unknown(unknown),
        }
    }
}

/// An instance, as the FMU hands it out: fmi2Component.
pub type Component = *mut c_void;
/// A saved state, as the FMU hands it out: fmi2FMUstate.
pub type FmuState = *mut c_void;
/// fmi2String
pub type Text = *const c_char;
/// fmi2Type of co-simulation.
pub const CO_SIMULATION: c_int = 1;

/// The host's function for messages. The standard's has a variable number of arguments, which Rust
/// cannot write; the only ones here are strings, of which one is enough.
pub type Logger = unsafe extern "C" fn(
    environment: *mut c_void,
    instance_name: Text,
    status: c_int,
    category: Text,
    message: Text,
    argument: Text,
);

/// The host's functions: fmi2CallbackFunctions.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Callbacks {
    pub logger: Option<Logger>,
    pub allocate_memory: Option<unsafe extern "C" fn(count: usize, size: usize) -> *mut c_void>,
    pub free_memory: Option<unsafe extern "C" fn(memory: *mut c_void)>,
    pub step_finished: Option<unsafe extern "C" fn(environment: *mut c_void, status: c_int)>,
    pub environment: *mut c_void,
}

/// Functions of FMI 2.0 that only model exchange needs.
pub(crate) const OF_MODEL_EXCHANGE: [&str; 10] = [
    "fmi2EnterEventMode",
    "fmi2NewDiscreteStates",
    "fmi2EnterContinuousTimeMode",
    "fmi2CompletedIntegratorStep",
    "fmi2SetTime",
    "fmi2SetContinuousStates",
    "fmi2GetDerivatives",
    "fmi2GetEventIndicators",
    "fmi2GetContinuousStates",
    "fmi2GetNominalsOfContinuousStates",
];

/// Value that a function returns which the library lacks.
pub(crate) trait Absent {
    /// An error, or nothing.
    fn absent() -> Self;
}

impl Absent for c_int {
    fn absent() -> Self {
        3
    }
}

impl Absent for () {
    fn absent() -> Self {}
}

impl<T> Absent for *const T {
    fn absent() -> Self {
        std::ptr::null()
    }
}

impl<T> Absent for *mut T {
    fn absent() -> Self {
        std::ptr::null_mut()
    }
}

/// Declares the functions, and how they are found. The functions of another version are declared by
/// it too.
macro_rules! api {
    ($($field:ident $symbol:ident ($($argument:ty),*) $(-> $result:ty)?;)+) => {
        /// The C functions of an FMU. Calling one is as safe as the FMU and the arguments are.
        #[derive(Clone, Copy)]
        pub struct Api {
            $( #[doc = concat!("`", stringify!($symbol), "`")] pub $field: unsafe extern "C" fn($($argument),*) $(-> $result)?, )+
        }

        impl Api {
            /// The names of the functions in the library.
            pub const SYMBOLS: &[&str] = &[$(stringify!($symbol)),+];

            /// Finds the functions in a library, which has to live as long as they are used. Those
            /// of model exchange, which a library for co-simulation may lack, fail then.
            pub(crate) fn load(library: &libloading::Library) -> Result<Self, libloading::Error> {
                $(
                    let $field = {
                        unsafe extern "C" fn absent($(_: $argument),*) $(-> $result)? {
                            $crate::api::Absent::absent()
                        }
                        type Function = unsafe extern "C" fn($($argument),*) $(-> $result)?;
                        // SAFETY: under these names, every library has functions of these types.
                        match unsafe { library.get::<Function>(concat!(stringify!($symbol), "\0").as_bytes()) } {
                            Ok(function) => *function,
                            Err(_) if $crate::api::OF_MODEL_EXCHANGE.contains(&stringify!($symbol)) => absent,
                            Err(error) => return Err(error),
                        }
                    };
                )+
                Ok(Api { $($field),+ })
            }
        }
    };
}
pub(crate) use api;

/// Passes the functions of FMI 2.0 to a macro: each with a field's name, its own name, and its
/// type.
#[macro_export]
macro_rules! fmi2_functions {
    ($to:ident) => {
        $to! {
            get_types_platform fmi2GetTypesPlatform() -> Text;
            get_version fmi2GetVersion() -> Text;
            set_debug_logging fmi2SetDebugLogging(Component, c_int, usize, *const Text) -> c_int;
            instantiate fmi2Instantiate(Text, c_int, Text, Text, *const Callbacks, c_int, c_int) -> Component;
            free_instance fmi2FreeInstance(Component);
            setup_experiment fmi2SetupExperiment(Component, c_int, f64, f64, c_int, f64) -> c_int;
            enter_initialization_mode fmi2EnterInitializationMode(Component) -> c_int;
            exit_initialization_mode fmi2ExitInitializationMode(Component) -> c_int;
            terminate fmi2Terminate(Component) -> c_int;
            reset fmi2Reset(Component) -> c_int;
            get_real fmi2GetReal(Component, *const u32, usize, *mut f64) -> c_int;
            get_integer fmi2GetInteger(Component, *const u32, usize, *mut c_int) -> c_int;
            get_boolean fmi2GetBoolean(Component, *const u32, usize, *mut c_int) -> c_int;
            get_string fmi2GetString(Component, *const u32, usize, *mut Text) -> c_int;
            set_real fmi2SetReal(Component, *const u32, usize, *const f64) -> c_int;
            set_integer fmi2SetInteger(Component, *const u32, usize, *const c_int) -> c_int;
            set_boolean fmi2SetBoolean(Component, *const u32, usize, *const c_int) -> c_int;
            set_string fmi2SetString(Component, *const u32, usize, *const Text) -> c_int;
            get_fmu_state fmi2GetFMUstate(Component, *mut FmuState) -> c_int;
            set_fmu_state fmi2SetFMUstate(Component, FmuState) -> c_int;
            free_fmu_state fmi2FreeFMUstate(Component, *mut FmuState) -> c_int;
            serialized_fmu_state_size fmi2SerializedFMUstateSize(Component, FmuState, *mut usize) -> c_int;
            serialize_fmu_state fmi2SerializeFMUstate(Component, FmuState, *mut u8, usize) -> c_int;
            deserialize_fmu_state fmi2DeSerializeFMUstate(Component, *const u8, usize, *mut FmuState) -> c_int;
            get_directional_derivative fmi2GetDirectionalDerivative(Component, *const u32, usize, *const u32, usize, *const f64, *mut f64) -> c_int;
            set_real_input_derivatives fmi2SetRealInputDerivatives(Component, *const u32, usize, *const c_int, *const f64) -> c_int;
            get_real_output_derivatives fmi2GetRealOutputDerivatives(Component, *const u32, usize, *const c_int, *mut f64) -> c_int;
            do_step fmi2DoStep(Component, f64, f64, c_int) -> c_int;
            cancel_step fmi2CancelStep(Component) -> c_int;
            get_status fmi2GetStatus(Component, c_int, *mut c_int) -> c_int;
            get_real_status fmi2GetRealStatus(Component, c_int, *mut f64) -> c_int;
            get_integer_status fmi2GetIntegerStatus(Component, c_int, *mut c_int) -> c_int;
            get_boolean_status fmi2GetBooleanStatus(Component, c_int, *mut c_int) -> c_int;
            get_string_status fmi2GetStringStatus(Component, c_int, *mut Text) -> c_int;
            enter_event_mode fmi2EnterEventMode(Component) -> c_int;
            new_discrete_states fmi2NewDiscreteStates(Component, *mut c_void) -> c_int;
            enter_continuous_time_mode fmi2EnterContinuousTimeMode(Component) -> c_int;
            completed_integrator_step fmi2CompletedIntegratorStep(Component, c_int, *mut c_int, *mut c_int) -> c_int;
            set_time fmi2SetTime(Component, f64) -> c_int;
            set_continuous_states fmi2SetContinuousStates(Component, *const f64, usize) -> c_int;
            get_derivatives fmi2GetDerivatives(Component, *mut f64, usize) -> c_int;
            get_event_indicators fmi2GetEventIndicators(Component, *mut f64, usize) -> c_int;
            get_continuous_states fmi2GetContinuousStates(Component, *mut f64, usize) -> c_int;
            get_nominals_of_continuous_states fmi2GetNominalsOfContinuousStates(Component, *mut f64, usize) -> c_int;
        }
    };
}

fmi2_functions!(api);
