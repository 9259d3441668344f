//! States in which each function is allowed: the table of FMI 2.0, 4.2.4.
//!
//! The table omits the states that an instance is never in, see [`Mode`](crate::Mode). The
//! functions that are always allowed have a name only. The functions that set variables are allowed
//! wherever any variable can be set. Each variable is then checked by itself.

use crate::Mode::{Error as E, Initialization as N, Instantiated as I, StepComplete as C, Terminated as T};
use crate::abi::calling_sequence;

calling_sequence! {
    fmi2GetTypesPlatform fmi2GetVersion fmi2Instantiate fmi2FreeInstance;

    SET_DEBUG_LOGGING                 fmi2SetDebugLogging              [I N C T E];
    SETUP_EXPERIMENT                  fmi2SetupExperiment              [I];
    ENTER_INITIALIZATION_MODE         fmi2EnterInitializationMode      [I];
    EXIT_INITIALIZATION_MODE          fmi2ExitInitializationMode       [N];
    TERMINATE                         fmi2Terminate                    [C];
    RESET                             fmi2Reset                        [I N C T E];
    GET_REAL                          fmi2GetReal                      [N C T E];
    GET_INTEGER                       fmi2GetInteger                   [N C T E];
    GET_BOOLEAN                       fmi2GetBoolean                   [N C T E];
    GET_STRING                        fmi2GetString                    [N C T E];
    SET_REAL                          fmi2SetReal                      [I N C];
    SET_INTEGER                       fmi2SetInteger                   [I N C];
    SET_BOOLEAN                       fmi2SetBoolean                   [I N C];
    SET_STRING                        fmi2SetString                    [I N C];
    GET_FMU_STATE                     fmi2GetFMUstate                  [I N C T E];
    SET_FMU_STATE                     fmi2SetFMUstate                  [I N C T E];
    FREE_FMU_STATE                    fmi2FreeFMUstate                 [I N C T E];
    SERIALIZED_FMU_STATE_SIZE         fmi2SerializedFMUstateSize       [I N C T E];
    SERIALIZE_FMU_STATE               fmi2SerializeFMUstate            [I N C T E];
    DESERIALIZE_FMU_STATE             fmi2DeSerializeFMUstate          [I N C T E];
    GET_DIRECTIONAL_DERIVATIVE        fmi2GetDirectionalDerivative     [N C T];
    SET_REAL_INPUT_DERIVATIVES        fmi2SetRealInputDerivatives      [I N C];
    GET_REAL_OUTPUT_DERIVATIVES       fmi2GetRealOutputDerivatives     [C T];
    DO_STEP                           fmi2DoStep                       [C];
    CANCEL_STEP                       fmi2CancelStep                   [];
    GET_STATUS                        fmi2GetStatus                    [C T];
    GET_REAL_STATUS                   fmi2GetRealStatus                [C T];
    GET_INTEGER_STATUS                fmi2GetIntegerStatus             [C T];
    GET_BOOLEAN_STATUS                fmi2GetBooleanStatus             [C T];
    GET_STRING_STATUS                 fmi2GetStringStatus              [C T];
    ENTER_EVENT_MODE                  fmi2EnterEventMode               [];
    NEW_DISCRETE_STATES               fmi2NewDiscreteStates            [];
    ENTER_CONTINUOUS_TIME_MODE        fmi2EnterContinuousTimeMode      [];
    COMPLETED_INTEGRATOR_STEP         fmi2CompletedIntegratorStep      [];
    SET_TIME                          fmi2SetTime                      [];
    SET_CONTINUOUS_STATES             fmi2SetContinuousStates          [];
    GET_DERIVATIVES                   fmi2GetDerivatives               [];
    GET_EVENT_INDICATORS              fmi2GetEventIndicators           [];
    GET_CONTINUOUS_STATES             fmi2GetContinuousStates          [];
    GET_NOMINALS_OF_CONTINUOUS_STATES fmi2GetNominalsOfContinuousStates [];
}
