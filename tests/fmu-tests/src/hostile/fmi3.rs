//! Calls that only a host of FMI 3.0 makes.

use std::ffi::CStr;
use std::ptr::{null, null_mut};

use moris_fmi::fmi3::Layout;
use moris_fmu_host::api::Component;
use moris_fmu_host::fmi3::Api;
use moris_washout::Washout;

use super::calls::Experiment;
use super::expected::{ERROR, OK};
use super::functions::Answer;
use super::logger::Log;
use super::player::{Logged, c_string, fmi3_callback};
use super::world::World;

pub const LOG_CATEGORIES: &[&CStr] = &[c"logEvents", c"logStatusWarning", c"logStatusDiscard", c"logStatusError"];

/// Effect of fmi3SetDebugLogging: without categories all of them, but errors go off by name only.
pub fn switch_logging(logged: &mut Logged, on: bool, categories: &[&CStr]) {
    let named = |category: &CStr| categories.contains(&category);
    let all = categories.is_empty();
    for (category, logs) in [
        (LOG_CATEGORIES[0], &mut logged.events),
        (LOG_CATEGORIES[1], &mut logged.warnings),
        (LOG_CATEGORIES[2], &mut logged.discards),
        (LOG_CATEGORIES[3], &mut logged.errors),
    ] {
        if named(category) || all && (on || category != LOG_CATEGORIES[3]) {
            *logs = on;
        }
    }
}

/// Any of the functions without much of an argument.
pub fn any(world: &mut World, who: usize, api: &Api, choice: usize) -> i32 {
    match choice {
        0 => {
            // SAFETY: the function takes nothing and returns a string.
            assert_eq!(unsafe { CStr::from_ptr((api.get_version)()) }, c"3.0");
            world.count("fmi3GetVersion", OK);
            OK
        }
        1..4 => other_types(world, who, api),
        _ => never(world, who, api),
    }
}

/// Instantiation with one argument that is wrong, or of another kind.
pub fn refused_instantiation(world: &mut World, api: &Api, layout: Layout) {
    let choices = &mut world.choices;
    let right_token = c_string(&layout.token(&moris_interface::guid::<Washout>()));
    let mut log = Log::default();
    let (callback, environment) = fmi3_callback(Some(&mut log));
    let (mut name, mut token, mut event_mode, mut intermediate) = (c"refused".as_ptr(), right_token.as_ptr(), 0, 0);
    let kind = choices.below(8);
    match kind {
        0 => token = null(),
        1 => token = choices.of(&[c"", c"{", c"{%s%s%s%n}", c"\xff"]).as_ptr(),
        2 => name = null(),
        3 => name = choices.of(&[c"", c"  "]).as_ptr(),
        4 => event_mode = 1,
        5 => intermediate = 1,
        _ => {}
    }
    // SAFETY: the strings live during the call, and there is one reference.
    let (function, made) = unsafe {
        match kind {
            6 => {
                let made = (api.instantiate_model_exchange)(name, token, null(), 0, 1, environment, callback);
                ("fmi3InstantiateModelExchange", made)
            }
            7 => {
                let instantiate = api.instantiate_scheduled_execution;
                let made = instantiate(name, token, null(), 0, 1, environment, callback, None, None, None);
                ("fmi3InstantiateScheduledExecution", made)
            }
            _ => {
                let (instantiate, within) = (api.instantiate_co_simulation, [1].as_ptr());
                let made = instantiate(
                    name,
                    token,
                    null(),
                    0,
                    1,
                    event_mode,
                    0,
                    within,
                    intermediate,
                    environment,
                    callback,
                    None,
                );
                ("fmi3InstantiateCoSimulation", made)
            }
        }
    };
    assert!(made.is_null());
    let messages: Vec<_> = log.messages.iter().map(|message| (message.status, message.category.as_str())).collect();
    assert_eq!(messages, [(ERROR, "logStatusError")]);
    world.count(function, ERROR);
}

pub fn enter_initialization_mode(world: &mut World, who: usize, api: &Api) -> i32 {
    const FUNCTION: &str = "fmi3EnterInitializationMode";
    let experiment = Experiment::any(&mut world.choices);
    let Experiment { start, stop_defined, stop, tolerance_defined, tolerance, right } = experiment;
    let (stop_defined, tolerance_defined) = (u8::from(stop_defined), u8::from(tolerance_defined));
    let player = &mut world.players[who];
    let right = if player.expected.allows(FUNCTION) { right } else { ERROR };
    // SAFETY: the instance is alive.
    let status = unsafe {
        let enter = api.enter_initialization_mode;
        enter(player.component, tolerance_defined, tolerance, start, stop_defined, stop)
    };
    if status == OK {
        experiment.accept(&mut player.expected);
        player.expected.state = 'N';
    }
    world.accept(who, (FUNCTION, status), &[right])
}

/// Getting and setting by types that no variable has: right for no variables.
pub fn other_types(world: &mut World, who: usize, api: &Api) -> i32 {
    let (count, choice) = (world.choices.below(2), world.choices.below(22));
    let answer = other_type(api, world.players[who].component, count, choice);
    let right = if world.players[who].expected.allows(answer.0) && count == 0 { OK } else { ERROR };
    world.accept(who, answer, &[right])
}

/// One of the functions, for one variable or none.
fn other_type(api: &Api, c: Component, n: usize, choice: usize) -> Answer {
    let (mut float, mut string, mut binary, mut size) = (0f32, null(), null(), 0);
    let (mut i8, mut u8, mut i16, mut u16, mut u32, mut u64) = (0i8, 0u8, 0i16, 0u16, 0u32, 0u64);
    // SAFETY: the instance is alive, and there is one value of each type.
    let answer = unsafe {
        match choice {
            0 => ("fmi3GetFloat32", (api.get_float32)(c, &0, n, &mut float, n)),
            1 => ("fmi3GetInt8", (api.get_int8)(c, &0, n, &mut i8, n)),
            2 => ("fmi3GetUInt8", (api.get_uint8)(c, &0, n, &mut u8, n)),
            3 => ("fmi3GetInt16", (api.get_int16)(c, &0, n, &mut i16, n)),
            4 => ("fmi3GetUInt16", (api.get_uint16)(c, &0, n, &mut u16, n)),
            5 => ("fmi3GetUInt32", (api.get_uint32)(c, &0, n, &mut u32, n)),
            6 => ("fmi3GetUInt64", (api.get_uint64)(c, &0, n, &mut u64, n)),
            7 => ("fmi3GetString", (api.get_string)(c, &0, n, &mut string, n)),
            8 => ("fmi3GetBinary", (api.get_binary)(c, &0, n, &mut size, &mut binary, n)),
            9 => ("fmi3SetFloat32", (api.set_float32)(c, &0, n, &float, n)),
            10 => ("fmi3SetInt8", (api.set_int8)(c, &0, n, &i8, n)),
            11 => ("fmi3SetUInt8", (api.set_uint8)(c, &0, n, &u8, n)),
            12 => ("fmi3SetInt16", (api.set_int16)(c, &0, n, &i16, n)),
            13 => ("fmi3SetUInt16", (api.set_uint16)(c, &0, n, &u16, n)),
            14 => ("fmi3SetUInt32", (api.set_uint32)(c, &0, n, &u32, n)),
            15 => ("fmi3SetUInt64", (api.set_uint64)(c, &0, n, &u64, n)),
            16 => ("fmi3SetString", (api.set_string)(c, &0, n, &string, n)),
            17 => ("fmi3SetBinary", (api.set_binary)(c, &0, n, &size, &binary, n)),
            // The types that variables have, for none of them and nowhere.
            18 => ("fmi3GetFloat64", (api.get_float64)(c, null(), n, null_mut(), n)),
            19 => ("fmi3GetInt64", (api.get_int64)(c, null(), n, null_mut(), n)),
            20 => ("fmi3SetInt32", (api.set_int32)(c, null(), n, null(), n)),
            _ => ("fmi3SetBoolean", (api.set_boolean)(c, null(), n, null(), n)),
        }
    };
    let untouched = float == 0.0 && string.is_null() && binary.is_null() && size == 0;
    let untouched = untouched && (i8, u8, i16, u16, u32, u64) == (0, 0, 0, 0, 0, 0);
    assert!(untouched, "{} wrote something", answer.0);
    answer
}

/// Functions of what the FMU does not have: other interfaces, events, clocks, dependencies.
pub fn never(world: &mut World, who: usize, api: &Api) -> i32 {
    let choice = world.choices.below(31);
    let answer = refused(api, world.players[who].component, choice);
    world.accept(who, answer, &[ERROR])
}

fn refused(api: &Api, c: Component, choice: usize) -> Answer {
    let (mut reals, mut size, mut integer, mut flag, mut whole) = ([0.0; 2], 0usize, 0, 0u8, 0u64);
    let (mut flags, mut intervals, mut kinds): ([u8; 5], _, _) = ([0; 5], [0.0], [0]);
    let to = reals.as_mut_ptr();
    // SAFETY: the instance is alive, and the pointers lead to more than is asked for, or are null for nothing.
    let answer = unsafe {
        match choice {
            0 => ("fmi3EnterEventMode", (api.enter_event_mode)(c)),
            1 => ("fmi3EvaluateDiscreteStates", (api.evaluate_discrete_states)(c)),
            2 => ("fmi3UpdateDiscreteStates", {
                let [a, b, d, e, f] = &mut flags;
                (api.update_discrete_states)(c, a, b, d, e, f, to)
            }),
            3 => ("fmi3EnterStepMode", (api.enter_step_mode)(c)),
            4 => ("fmi3EnterConfigurationMode", (api.enter_configuration_mode)(c)),
            5 => ("fmi3ExitConfigurationMode", (api.exit_configuration_mode)(c)),
            6 => ("fmi3GetClock", (api.get_clock)(c, &0, 1, &mut flag)),
            7 => ("fmi3SetClock", (api.set_clock)(c, &0, 1, &flag)),
            8 => {
                let function = api.get_interval_decimal;
                ("fmi3GetIntervalDecimal", function(c, &0, 1, intervals.as_mut_ptr(), kinds.as_mut_ptr()))
            }
            9 => {
                let function = api.get_interval_fraction;
                ("fmi3GetIntervalFraction", function(c, &0, 1, &mut whole, to.cast(), &mut integer))
            }
            10 => ("fmi3GetShiftDecimal", (api.get_shift_decimal)(c, &0, 1, to)),
            11 => ("fmi3GetShiftFraction", (api.get_shift_fraction)(c, &0, 1, &mut whole, to.cast())),
            12 => ("fmi3SetIntervalDecimal", (api.set_interval_decimal)(c, &0, 1, &0.1)),
            13 => ("fmi3SetIntervalFraction", (api.set_interval_fraction)(c, &0, 1, &1, &10)),
            14 => ("fmi3SetShiftDecimal", (api.set_shift_decimal)(c, &0, 1, &0.1)),
            15 => ("fmi3SetShiftFraction", (api.set_shift_fraction)(c, &0, 1, &1, &10)),
            16 => ("fmi3EnterContinuousTimeMode", (api.enter_continuous_time_mode)(c)),
            17 => {
                let [enter, terminate, ..] = &mut flags;
                ("fmi3CompletedIntegratorStep", (api.completed_integrator_step)(c, 0, enter, terminate))
            }
            18 => ("fmi3SetTime", (api.set_time)(c, 0.0)),
            19 => ("fmi3SetContinuousStates", (api.set_continuous_states)(c, to, 2)),
            20 => ("fmi3GetContinuousStateDerivatives", (api.get_continuous_state_derivatives)(c, to, 2)),
            21 => ("fmi3GetEventIndicators", (api.get_event_indicators)(c, to, 2)),
            22 => ("fmi3GetContinuousStates", (api.get_continuous_states)(c, to, 2)),
            23 => ("fmi3GetNominalsOfContinuousStates", (api.get_nominals_of_continuous_states)(c, to, 2)),
            24 => ("fmi3GetNumberOfEventIndicators", (api.get_number_of_event_indicators)(c, &mut size)),
            25 => ("fmi3GetNumberOfContinuousStates", (api.get_number_of_continuous_states)(c, &mut size)),
            26 => ("fmi3ActivateModelPartition", (api.activate_model_partition)(c, 0, 0.0)),
            27 => {
                let function = api.get_number_of_variable_dependencies;
                ("fmi3GetNumberOfVariableDependencies", function(c, 20, &mut size))
            }
            28 => {
                let function = api.get_variable_dependencies;
                ("fmi3GetVariableDependencies", function(c, 20, &mut size, &mut 0, &mut 0, &mut integer, 1))
            }
            29 => {
                let function = api.get_directional_derivative;
                ("fmi3GetDirectionalDerivative", function(c, &20, 1, &1, 1, &1.0, 1, to, 1))
            }
            _ => {
                let function = api.get_adjoint_derivative;
                ("fmi3GetAdjointDerivative", function(c, &20, 1, &1, 1, &1.0, 1, to, 1))
            }
        }
    };
    let untouched = reals == [0.0; 2] && (size, integer, flag, whole) == (0, 0, 0, 0);
    assert!(untouched && flags == [0; 5] && intervals == [0.0] && kinds == [0], "{} wrote something", answer.0);
    answer
}
