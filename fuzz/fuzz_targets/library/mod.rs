//! The washout's C functions, linked into the fuzzer so that it sees which code its inputs reach.

use std::mem::transmute;
use std::ptr::null;

use moris_fmu_host::Api;

moris_fmi::export_fmi2!(moris_washout::Washout);

macro_rules! api {
    ($($field:ident $function:ident;)+) => {
        Api {
            // SAFETY: the host declares the functions with the types that the standard gives them, as the library does.
            $( $field: unsafe { transmute::<*const (), _>(fmi2_functions::$function as *const ()) }, )+
        }
    };
}

/// The functions as a host has them. From here on a panic, the host's or the library's, ends the
/// process with its text.
pub fn open() -> Api {
    let api = api! {
        get_types_platform fmi2GetTypesPlatform;
        get_version fmi2GetVersion;
        set_debug_logging fmi2SetDebugLogging;
        instantiate fmi2Instantiate;
        free_instance fmi2FreeInstance;
        setup_experiment fmi2SetupExperiment;
        enter_initialization_mode fmi2EnterInitializationMode;
        exit_initialization_mode fmi2ExitInitializationMode;
        terminate fmi2Terminate;
        reset fmi2Reset;
        get_real fmi2GetReal;
        get_integer fmi2GetInteger;
        get_boolean fmi2GetBoolean;
        get_string fmi2GetString;
        set_real fmi2SetReal;
        set_integer fmi2SetInteger;
        set_boolean fmi2SetBoolean;
        set_string fmi2SetString;
        get_fmu_state fmi2GetFMUstate;
        set_fmu_state fmi2SetFMUstate;
        free_fmu_state fmi2FreeFMUstate;
        serialized_fmu_state_size fmi2SerializedFMUstateSize;
        serialize_fmu_state fmi2SerializeFMUstate;
        deserialize_fmu_state fmi2DeSerializeFMUstate;
        get_directional_derivative fmi2GetDirectionalDerivative;
        set_real_input_derivatives fmi2SetRealInputDerivatives;
        get_real_output_derivatives fmi2GetRealOutputDerivatives;
        do_step fmi2DoStep;
        cancel_step fmi2CancelStep;
        get_status fmi2GetStatus;
        get_real_status fmi2GetRealStatus;
        get_integer_status fmi2GetIntegerStatus;
        get_boolean_status fmi2GetBooleanStatus;
        get_string_status fmi2GetStringStatus;
        enter_event_mode fmi2EnterEventMode;
        new_discrete_states fmi2NewDiscreteStates;
        enter_continuous_time_mode fmi2EnterContinuousTimeMode;
        completed_integrator_step fmi2CompletedIntegratorStep;
        set_time fmi2SetTime;
        set_continuous_states fmi2SetContinuousStates;
        get_derivatives fmi2GetDerivatives;
        get_event_indicators fmi2GetEventIndicators;
        get_continuous_states fmi2GetContinuousStates;
        get_nominals_of_continuous_states fmi2GetNominalsOfContinuousStates;
    };
    // The library silences panics when it is first asked for an instance. Linked in here it has the fuzzer's own hook,
    // which is set again after that.
    let hook = std::panic::take_hook();
    // SAFETY: null is to be refused.
    let made = unsafe { (api.instantiate)(null(), 0, null(), null(), null(), 0, 0) };
    assert!(made.is_null());
    std::panic::set_hook(hook);
    api
}
