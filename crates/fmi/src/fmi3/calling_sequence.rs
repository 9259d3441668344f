//! States in which each function is allowed: FMI 3.0, 2.3 (common states) and 4.2 (co-simulation).
//!
//! The functions that are always allowed have a name only. The models have no structural
//! parameters, so there is no configuration mode. Event mode, clocks, model exchange and scheduled
//! execution are not provided; their functions are allowed in no state. `E` is the state after a
//! panic of the model. The standard has no such state and counts it as terminated.

use crate::Mode::{Error as E, Initialization as N, Instantiated as I, StepComplete as C, Terminated as T};
use crate::abi::calling_sequence;

calling_sequence! {
    fmi3GetVersion fmi3InstantiateCoSimulation fmi3InstantiateModelExchange fmi3InstantiateScheduledExecution
    fmi3FreeInstance;

    SET_DEBUG_LOGGING                 fmi3SetDebugLogging              [I N C T E];
    ENTER_INITIALIZATION_MODE         fmi3EnterInitializationMode      [I];
    EXIT_INITIALIZATION_MODE          fmi3ExitInitializationMode       [N];
    TERMINATE                         fmi3Terminate                    [C];
    RESET                             fmi3Reset                        [I N C T E];
    DO_STEP                           fmi3DoStep                       [C];
    GET_OUTPUT_DERIVATIVES            fmi3GetOutputDerivatives         [C T];

    GET_FLOAT64                       fmi3GetFloat64                   [I N C T E];
    GET_INT32                         fmi3GetInt32                     [I N C T E];
    GET_INT64                         fmi3GetInt64                     [I N C T E];
    GET_BOOLEAN                       fmi3GetBoolean                   [I N C T E];
    SET_FLOAT64                       fmi3SetFloat64                   [I N C];
    SET_INT32                         fmi3SetInt32                     [I N C];
    SET_INT64                         fmi3SetInt64                     [I N C];
    SET_BOOLEAN                       fmi3SetBoolean                   [I N C];

    GET_FLOAT32                       fmi3GetFloat32                   [I N C T E];
    GET_INT8                          fmi3GetInt8                      [I N C T E];
    GET_UINT8                         fmi3GetUInt8                     [I N C T E];
    GET_INT16                         fmi3GetInt16                     [I N C T E];
    GET_UINT16                        fmi3GetUInt16                    [I N C T E];
    GET_UINT32                        fmi3GetUInt32                    [I N C T E];
    GET_UINT64                        fmi3GetUInt64                    [I N C T E];
    GET_STRING                        fmi3GetString                    [I N C T E];
    GET_BINARY                        fmi3GetBinary                    [I N C T E];
    SET_FLOAT32                       fmi3SetFloat32                   [I N C];
    SET_INT8                          fmi3SetInt8                      [I N C];
    SET_UINT8                         fmi3SetUInt8                     [I N C];
    SET_INT16                         fmi3SetInt16                     [I N C];
    SET_UINT16                        fmi3SetUInt16                    [I N C];
    SET_UINT32                        fmi3SetUInt32                    [I N C];
    SET_UINT64                        fmi3SetUInt64                    [I N C];
    SET_STRING                        fmi3SetString                    [I N C];
    SET_BINARY                        fmi3SetBinary                    [I N C];

    GET_FMU_STATE                     fmi3GetFMUState                  [I N C T E];
    SET_FMU_STATE                     fmi3SetFMUState                  [I N C T E];
    FREE_FMU_STATE                    fmi3FreeFMUState                 [I N C T E];
    SERIALIZED_FMU_STATE_SIZE         fmi3SerializedFMUStateSize       [I N C T E];
    SERIALIZE_FMU_STATE               fmi3SerializeFMUState            [I N C T E];
    DESERIALIZE_FMU_STATE             fmi3DeserializeFMUState          [I N C T E];

    GET_NUMBER_OF_VARIABLE_DEPENDENCIES fmi3GetNumberOfVariableDependencies [I N C T];
    GET_VARIABLE_DEPENDENCIES         fmi3GetVariableDependencies      [I N C T];
    GET_DIRECTIONAL_DERIVATIVE        fmi3GetDirectionalDerivative     [N C T];
    GET_ADJOINT_DERIVATIVE            fmi3GetAdjointDerivative         [N C T];

    ENTER_CONFIGURATION_MODE          fmi3EnterConfigurationMode       [];
    EXIT_CONFIGURATION_MODE           fmi3ExitConfigurationMode        [];
    ENTER_EVENT_MODE                  fmi3EnterEventMode               [];
    EVALUATE_DISCRETE_STATES          fmi3EvaluateDiscreteStates       [];
    UPDATE_DISCRETE_STATES            fmi3UpdateDiscreteStates         [];
    ENTER_STEP_MODE                   fmi3EnterStepMode                [];
    GET_CLOCK                         fmi3GetClock                     [];
    SET_CLOCK                         fmi3SetClock                     [];
    GET_INTERVAL_DECIMAL              fmi3GetIntervalDecimal           [];
    GET_INTERVAL_FRACTION             fmi3GetIntervalFraction          [];
    GET_SHIFT_DECIMAL                 fmi3GetShiftDecimal              [];
    GET_SHIFT_FRACTION                fmi3GetShiftFraction             [];
    SET_INTERVAL_DECIMAL              fmi3SetIntervalDecimal           [];
    SET_INTERVAL_FRACTION             fmi3SetIntervalFraction          [];
    SET_SHIFT_DECIMAL                 fmi3SetShiftDecimal              [];
    SET_SHIFT_FRACTION                fmi3SetShiftFraction             [];
    ENTER_CONTINUOUS_TIME_MODE        fmi3EnterContinuousTimeMode      [];
    COMPLETED_INTEGRATOR_STEP         fmi3CompletedIntegratorStep      [];
    SET_TIME                          fmi3SetTime                      [];
    SET_CONTINUOUS_STATES             fmi3SetContinuousStates          [];
    GET_CONTINUOUS_STATE_DERIVATIVES  fmi3GetContinuousStateDerivatives [];
    GET_EVENT_INDICATORS              fmi3GetEventIndicators           [];
    GET_CONTINUOUS_STATES             fmi3GetContinuousStates          [];
    GET_NOMINALS_OF_CONTINUOUS_STATES fmi3GetNominalsOfContinuousStates [];
    GET_NUMBER_OF_EVENT_INDICATORS    fmi3GetNumberOfEventIndicators   [];
    GET_NUMBER_OF_CONTINUOUS_STATES   fmi3GetNumberOfContinuousStates  [];
    ACTIVATE_MODEL_PARTITION          fmi3ActivateModelPartition       [];
}
