//! Every function in every state, against the standard.

use std::ffi::c_int;
use std::ptr::{null, null_mut};

use moris_fmu_host::fmi3::Api;

use crate::fixture::*;
use crate::standard::CALLING_SEQUENCE;

/// The functions of what the FMU does not provide: allowed, and refused.
const NOT_PROVIDED: [&str; 4] = [
    "fmi3GetDirectionalDerivative",
    "fmi3GetAdjointDerivative",
    "fmi3GetNumberOfVariableDependencies",
    "fmi3GetVariableDependencies",
];

/// The states that an instance can be in, with how to get there.
type State = (char, &'static str, fn() -> Instance);
const STATES: [State; 5] = [
    ('I', "instantiated", Instance::new),
    ('N', "initialization mode", initializing),
    ('S', "step mode", stepping),
    ('T', "terminated", terminated),
    ('E', "error", failed),
];

#[test]
fn every_function_is_allowed_where_the_standard_says() {
    let mut checked = 0;
    for &(function, allowed) in CALLING_SEQUENCE {
        for (letter, state, make) in STATES {
            check(function, allowed.contains(letter), state, &make());
            checked += 1;
        }
    }
    // All functions but three that instantiate and fmi3FreeInstance.
    assert_eq!(checked, (Api::SYMBOLS.len() - 4) * STATES.len());
}

fn check(function: &str, allowed: bool, state: &str, instance: &Instance) {
    let before = instance.bytes();
    let entries = instance.messages().len();
    let status = call(function, instance);
    let messages = instance.messages().split_off(entries);
    let refused = messages.iter().any(|(_, _, text)| text.contains("not allowed in state"));
    assert_eq!(!refused, allowed, "{function} in state '{state}': {messages:?}");
    if NOT_PROVIDED.contains(&function) && allowed {
        instance.assert_call_error(status, ERROR, &[function, "not provided, as provides"]);
    } else if !refused {
        assert_eq!(status, OK, "{function} in state '{state}': {messages:?}");
        return;
    } else {
        instance.assert_call_error(status, ERROR, &[&format!("{function}: "), &format!("'{state}'")]);
    }
    assert_eq!(instance.bytes(), before, "{function} in state '{state}' changed something");
}

/// Calls the function with arguments that are right.
fn call(function: &str, instance: &Instance) -> c_int {
    let (c, api) = (instance.pointer, instance.api());
    let state = instance.get_state();
    let saved = instance.serialize(state);
    let mut other = null_mut();
    let (mut real, mut integer, mut long, mut flag, mut size) = ([0.0; 3], 0, 0, 0, 0);
    let (mut event, mut terminate, mut early) = (0, 0, 0);
    let mut buffer = vec![0; saved.len()];
    let [u, y, count, offset, frozen, method] = ["u", "y", "count", "offset", "frozen", "method"].map(reference);
    let real = real.as_mut_ptr();
    // SAFETY: the instance is alive, and the pointers lead to as much as the functions want.
    let status = unsafe {
        match function {
            "fmi3GetVersion" => c_int::from(text((api.get_version)()) != "3.0"),
            "fmi3SetDebugLogging" => (api.set_debug_logging)(c, 1, 0, null()),
            "fmi3Reset" => (api.reset)(c),
            "fmi3GetFMUState" => (api.get_fmu_state)(c, &mut other),
            "fmi3SetFMUState" => (api.set_fmu_state)(c, state),
            "fmi3FreeFMUState" => (api.free_fmu_state)(c, &mut other),
            "fmi3SerializedFMUStateSize" => (api.serialized_fmu_state_size)(c, state, &mut size),
            "fmi3SerializeFMUState" => (api.serialize_fmu_state)(c, state, buffer.as_mut_ptr(), buffer.len()),
            "fmi3DeserializeFMUState" => (api.deserialize_fmu_state)(c, saved.as_ptr(), saved.len(), &mut other),
            "fmi3EnterInitializationMode" => (api.enter_initialization_mode)(c, 0, 0.0, 0.0, 0, 0.0),
            "fmi3ExitInitializationMode" => (api.exit_initialization_mode)(c),
            "fmi3Terminate" => (api.terminate)(c),
            "fmi3DoStep" => (api.do_step)(c, 0.0, 0.1, 1, &mut event, &mut terminate, &mut early, real),
            "fmi3GetOutputDerivatives" => (api.get_output_derivatives)(c, &y, 1, &1, real, 3),
            "fmi3GetDirectionalDerivative" => (api.get_directional_derivative)(c, &y, 1, &u, 1, &1.0, 1, real, 3),
            "fmi3GetAdjointDerivative" => (api.get_adjoint_derivative)(c, &y, 1, &u, 1, &1.0, 1, real, 3),
            "fmi3GetNumberOfVariableDependencies" => (api.get_number_of_variable_dependencies)(c, y, &mut size),
            "fmi3GetVariableDependencies" => {
                (api.get_variable_dependencies)(c, y, null_mut(), null_mut(), null_mut(), null_mut(), 0)
            }
            "fmi3GetFloat32" => (api.get_float32)(c, null(), 0, null_mut(), 0),
            "fmi3GetFloat64" => (api.get_float64)(c, &y, 1, real, 3),
            "fmi3GetInt8" => (api.get_int8)(c, null(), 0, null_mut(), 0),
            "fmi3GetUInt8" => (api.get_uint8)(c, null(), 0, null_mut(), 0),
            "fmi3GetInt16" => (api.get_int16)(c, null(), 0, null_mut(), 0),
            "fmi3GetUInt16" => (api.get_uint16)(c, null(), 0, null_mut(), 0),
            "fmi3GetInt32" => (api.get_int32)(c, &count, 1, &mut integer, 1),
            "fmi3GetUInt32" => (api.get_uint32)(c, null(), 0, null_mut(), 0),
            "fmi3GetInt64" => (api.get_int64)(c, &method, 1, &mut long, 1),
            "fmi3GetUInt64" => (api.get_uint64)(c, null(), 0, null_mut(), 0),
            "fmi3GetBoolean" => (api.get_boolean)(c, &frozen, 1, &mut flag, 1),
            "fmi3GetString" => (api.get_string)(c, null(), 0, null_mut(), 0),
            "fmi3GetBinary" => (api.get_binary)(c, null(), 0, null_mut(), null_mut(), 0),
            "fmi3SetFloat32" => (api.set_float32)(c, null(), 0, null(), 0),
            "fmi3SetFloat64" => (api.set_float64)(c, &u, 1, real, 3),
            "fmi3SetInt8" => (api.set_int8)(c, null(), 0, null(), 0),
            "fmi3SetUInt8" => (api.set_uint8)(c, null(), 0, null(), 0),
            "fmi3SetInt16" => (api.set_int16)(c, null(), 0, null(), 0),
            "fmi3SetUInt16" => (api.set_uint16)(c, null(), 0, null(), 0),
            "fmi3SetInt32" => (api.set_int32)(c, &offset, 1, &1, 1),
            "fmi3SetUInt32" => (api.set_uint32)(c, null(), 0, null(), 0),
            "fmi3SetInt64" => (api.set_int64)(c, &method, 1, &1, 1),
            "fmi3SetUInt64" => (api.set_uint64)(c, null(), 0, null(), 0),
            "fmi3SetBoolean" => (api.set_boolean)(c, &frozen, 1, &1, 1),
            "fmi3SetString" => (api.set_string)(c, null(), 0, null(), 0),
            "fmi3SetBinary" => (api.set_binary)(c, null(), 0, null(), null(), 0),
            "fmi3EnterConfigurationMode" => (api.enter_configuration_mode)(c),
            "fmi3ExitConfigurationMode" => (api.exit_configuration_mode)(c),
            "fmi3EnterEventMode" => (api.enter_event_mode)(c),
            "fmi3EvaluateDiscreteStates" => (api.evaluate_discrete_states)(c),
            "fmi3UpdateDiscreteStates" => {
                let (mut defined, mut changed) = (0, 0);
                let update = api.update_discrete_states;
                update(c, &mut event, &mut terminate, &mut early, &mut changed, &mut defined, real)
            }
            "fmi3EnterStepMode" => (api.enter_step_mode)(c),
            "fmi3GetClock" => (api.get_clock)(c, null(), 0, null_mut()),
            "fmi3SetClock" => (api.set_clock)(c, null(), 0, null()),
            "fmi3GetIntervalDecimal" => (api.get_interval_decimal)(c, null(), 0, null_mut(), null_mut()),
            "fmi3GetIntervalFraction" => (api.get_interval_fraction)(c, null(), 0, null_mut(), null_mut(), null_mut()),
            "fmi3GetShiftDecimal" => (api.get_shift_decimal)(c, null(), 0, null_mut()),
            "fmi3GetShiftFraction" => (api.get_shift_fraction)(c, null(), 0, null_mut(), null_mut()),
            "fmi3SetIntervalDecimal" => (api.set_interval_decimal)(c, null(), 0, null()),
            "fmi3SetIntervalFraction" => (api.set_interval_fraction)(c, null(), 0, null(), null()),
            "fmi3SetShiftDecimal" => (api.set_shift_decimal)(c, null(), 0, null()),
            "fmi3SetShiftFraction" => (api.set_shift_fraction)(c, null(), 0, null(), null()),
            "fmi3EnterContinuousTimeMode" => (api.enter_continuous_time_mode)(c),
            "fmi3CompletedIntegratorStep" => (api.completed_integrator_step)(c, 0, &mut event, &mut terminate),
            "fmi3SetTime" => (api.set_time)(c, 0.0),
            "fmi3SetContinuousStates" => (api.set_continuous_states)(c, null(), 0),
            "fmi3GetContinuousStateDerivatives" => (api.get_continuous_state_derivatives)(c, null_mut(), 0),
            "fmi3GetEventIndicators" => (api.get_event_indicators)(c, null_mut(), 0),
            "fmi3GetContinuousStates" => (api.get_continuous_states)(c, null_mut(), 0),
            "fmi3GetNominalsOfContinuousStates" => (api.get_nominals_of_continuous_states)(c, null_mut(), 0),
            "fmi3GetNumberOfEventIndicators" => (api.get_number_of_event_indicators)(c, &mut size),
            "fmi3GetNumberOfContinuousStates" => (api.get_number_of_continuous_states)(c, &mut size),
            "fmi3ActivateModelPartition" => (api.activate_model_partition)(c, 0, 0.0),
            unknown => panic!("how is {unknown} called?"),
        }
    };
    // SAFETY: as above; null is ignored.
    unsafe { (api.free_fmu_state)(c, &mut other) };
    instance.free_state(state);
    status
}

#[test]
fn no_function_needs_an_instance() {
    let library = open();
    let (api, c) = (library.api(), null_mut());
    // SAFETY: null is to be refused.
    unsafe {
        assert_eq!((api.reset)(c), ERROR);
        assert_eq!((api.get_float64)(c, null(), 0, null_mut(), 0), ERROR);
        assert_eq!((api.do_step)(c, 0.0, 0.1, 1, null_mut(), null_mut(), null_mut(), null_mut()), ERROR);
        assert_eq!((api.get_fmu_state)(c, null_mut()), ERROR);
        assert_eq!((api.get_clock)(c, null(), 0, null_mut()), ERROR);
        assert_eq!((api.get_directional_derivative)(c, null(), 0, null(), 0, null(), 0, null_mut(), 0), ERROR);
    }
}
