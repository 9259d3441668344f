//! Every function in every state, against the table of the standard.

use std::ptr::{null, null_mut};

use moris_fmu_host::{Instance, Status};

use crate::fixture::*;
use crate::standard::CALLING_SEQUENCE;

/// The states that an instance can be in, with how to get there.
type State = (&'static str, &'static str, fn() -> Instance);
const STATES: [State; 5] = [
    ("I", "instantiated", instantiated),
    ("N", "initialization mode", || {
        let mut instance = initializing();
        // What makes leaving initialization mode fail must not hide whether it is allowed.
        instance.set("gain", 2.0).unwrap();
        instance
    }),
    ("C", "step complete", || stepping(&[])),
    ("T", "terminated", terminated),
    ("E", "error", failed),
];

#[test]
fn every_function_is_allowed_where_the_standard_says() {
    let mut checked = 0;
    for (function, allowed) in CALLING_SEQUENCE {
        for (letter, state, make) in STATES {
            check(function, allowed, letter, state, make());
            checked += 1;
        }
    }
    // All functions but fmi2Instantiate and fmi2FreeInstance.
    assert_eq!(checked, (moris_fmu_host::Api::SYMBOLS.len() - 2) * STATES.len());
}

fn check(function: &str, states: &str, letter: &str, state: &str, mut instance: Instance) {
    let allowed = states.contains(letter);
    let before = bytes(&mut instance);
    let entries = instance.messages().len();
    let status = call(function, &mut instance);
    let messages = instance.messages().split_off(entries);
    let refused = messages.iter().any(|message| message.text.contains("not allowed in state"));
    assert_eq!(!refused, allowed, "{function} in state '{state}': {messages:?}");
    if refused {
        assert_eq!(status, 3, "{function} in state '{state}'");
        let text = &messages.last().unwrap().text;
        assert!(text.starts_with(function) && text.contains(&format!("'{state}'")), "{text}");
        let expected: Vec<_> =
            STATES.iter().filter(|(letter, ..)| states.contains(letter)).map(|(_, name, _)| *name).collect();
        let expected = if expected.is_empty() { "none".into() } else { expected.join(", ") };
        assert!(text.ends_with(&expected), "{text}");
        assert_eq!(bytes(&mut instance), before, "{function} in state '{state}' changed something");
    } else if function != "fmi2GetDirectionalDerivative" {
        // Discard: asking for a status that is not known.
        assert!(status == 0 || status == 2, "{function} in state '{state}': {messages:?}");
    }
}

/// Calls the function with arguments that are right.
fn call(function: &str, instance: &mut Instance) -> i32 {
    let c = instance.component();
    let state = instance.get_state().unwrap();
    let saved = instance.serialize(&state).unwrap();
    let mut other = null_mut();
    let (mut real, mut integer, mut string, mut size) = (0.0, 0, null(), 0);
    let mut buffer = vec![0; saved.len()];
    let [u, y, count, offset, frozen, rising] = ["u", "y", "count", "offset", "frozen", "rising"].map(reference);
    let api = instance.api();
    // SAFETY: the component is alive, and the pointers lead to as much as the functions want.
    let status = unsafe {
        match function {
            "fmi2GetTypesPlatform" => i32::from(text((api.get_types_platform)()) != "default"),
            "fmi2GetVersion" => i32::from(text((api.get_version)()) != "2.0"),
            "fmi2SetDebugLogging" => (api.set_debug_logging)(c, 1, 0, null()),
            "fmi2SetupExperiment" => (api.setup_experiment)(c, 0, 0.0, 0.0, 0, 0.0),
            "fmi2EnterInitializationMode" => {
                (api.setup_experiment)(c, 0, 0.0, 0.0, 0, 0.0);
                (api.enter_initialization_mode)(c)
            }
            "fmi2ExitInitializationMode" => (api.exit_initialization_mode)(c),
            "fmi2Terminate" => (api.terminate)(c),
            "fmi2Reset" => (api.reset)(c),
            "fmi2GetReal" => (api.get_real)(c, &y, 1, &mut real),
            "fmi2GetInteger" => (api.get_integer)(c, &count, 1, &mut integer),
            "fmi2GetBoolean" => (api.get_boolean)(c, &rising, 1, &mut integer),
            "fmi2GetString" => (api.get_string)(c, null(), 0, null_mut()),
            "fmi2SetReal" => (api.set_real)(c, &u, 1, &1.0),
            "fmi2SetInteger" => (api.set_integer)(c, &offset, 1, &1),
            "fmi2SetBoolean" => (api.set_boolean)(c, &frozen, 1, &1),
            "fmi2SetString" => (api.set_string)(c, null(), 0, null()),
            "fmi2GetFMUstate" => (api.get_fmu_state)(c, &mut other),
            "fmi2SetFMUstate" => (api.set_fmu_state)(c, state.pointer()),
            "fmi2FreeFMUstate" => (api.free_fmu_state)(c, &mut other),
            "fmi2SerializedFMUstateSize" => (api.serialized_fmu_state_size)(c, state.pointer(), &mut size),
            "fmi2SerializeFMUstate" => (api.serialize_fmu_state)(c, state.pointer(), buffer.as_mut_ptr(), buffer.len()),
            "fmi2DeSerializeFMUstate" => (api.deserialize_fmu_state)(c, saved.as_ptr(), saved.len(), &mut other),
            "fmi2GetDirectionalDerivative" => (api.get_directional_derivative)(c, &y, 1, &u, 1, &1.0, &mut real),
            "fmi2SetRealInputDerivatives" => (api.set_real_input_derivatives)(c, &u, 1, &1, &1.0),
            "fmi2GetRealOutputDerivatives" => (api.get_real_output_derivatives)(c, &y, 1, &1, &mut real),
            "fmi2DoStep" => (api.do_step)(c, 0.0, 0.1, 1),
            "fmi2CancelStep" => (api.cancel_step)(c),
            "fmi2GetStatus" => (api.get_status)(c, 0, &mut integer),
            "fmi2GetRealStatus" => (api.get_real_status)(c, 2, &mut real),
            "fmi2GetIntegerStatus" => (api.get_integer_status)(c, 0, &mut integer),
            "fmi2GetBooleanStatus" => (api.get_boolean_status)(c, 3, &mut integer),
            "fmi2GetStringStatus" => (api.get_string_status)(c, 1, &mut string),
            "fmi2EnterEventMode" => (api.enter_event_mode)(c),
            "fmi2NewDiscreteStates" => (api.new_discrete_states)(c, null_mut()),
            "fmi2EnterContinuousTimeMode" => (api.enter_continuous_time_mode)(c),
            "fmi2CompletedIntegratorStep" => (api.completed_integrator_step)(c, 0, &mut 0, &mut 0),
            "fmi2SetTime" => (api.set_time)(c, 0.0),
            "fmi2SetContinuousStates" => (api.set_continuous_states)(c, null(), 0),
            "fmi2GetDerivatives" => (api.get_derivatives)(c, null_mut(), 0),
            "fmi2GetEventIndicators" => (api.get_event_indicators)(c, null_mut(), 0),
            "fmi2GetContinuousStates" => (api.get_continuous_states)(c, null_mut(), 0),
            "fmi2GetNominalsOfContinuousStates" => (api.get_nominals_of_continuous_states)(c, null_mut(), 0),
            unknown => panic!("how is {unknown} called?"),
        }
    };
    // SAFETY: as above; null is ignored.
    unsafe { (api.free_fmu_state)(c, &mut other) };
    instance.free_state(state);
    status
}

#[test]
fn initialization_wants_an_experiment_and_wants_it_again_after_reset() {
    let mut instance = instantiated();
    let status = instance.enter_initialization_mode();
    assert_call_error(&instance, status, Status::Error, &["fmi2EnterInitializationMode", "fmi2SetupExperiment"]);
    instance.initialize(&[], None).unwrap();
    assert_eq!(instance.reset(), Status::Ok);
    assert_eq!(instance.enter_initialization_mode(), Status::Error);
    instance.initialize(&[], None).unwrap();
}
