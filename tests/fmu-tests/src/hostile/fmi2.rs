//! Calls that only a host of FMI 2.0 makes.

use std::ffi::{CStr, c_int};
use std::ptr::{null, null_mut};

use moris_fmu_host::Api;
use moris_interface::Causality;
use moris_washout::Washout;

use super::calls::Experiment;
use super::expected::{DISCARD, ERROR, OK, Type};
use super::logger::Log;
use super::palette;
use super::player::{Logged, c_string, callbacks};
use super::variables::{has_derivative, order, references};
use super::world::World;

pub const LOG_CATEGORIES: &[&CStr] =
    &[c"logEvents", c"logAll", c"logStatusError", c"logStatusWarning", c"logStatusDiscard", c"logStatusFatal"];

/// Effect of fmi2SetDebugLogging: warnings and errors are always sent.
pub fn switch_logging(logged: &mut Logged, on: bool, categories: &[&CStr]) {
    let events = |category: &&CStr| [c"logEvents", c"logAll"].contains(category);
    logged.events = on && (categories.is_empty() || categories.iter().any(events));
}

/// Any of the functions without much of an argument.
pub fn any(world: &mut World, who: usize, api: &Api, choice: usize) -> i32 {
    match choice {
        0 => platform_and_version(world, api),
        1..4 => strings(world, who, api),
        _ => never(world, who, api),
    }
}

/// The calls up to initialization mode: the experiment seldom twice, its absence seldom.
pub fn begin(world: &mut World, who: usize, api: &Api) -> i32 {
    let is_set_up = world.players[who].expected.experiment.is_some();
    if is_set_up != world.choices.once_in(6) {
        enter_initialization_mode(world, who, api)
    } else {
        setup_experiment(world, who, api)
    }
}

/// Instantiation with one argument that is wrong.
pub fn refused_instantiation(world: &mut World, api: &Api) {
    let choices = &mut world.choices;
    let guid = c_string(&moris_interface::guid::<Washout>());
    let mut log = Log { name: "refused".into(), ..Log::default() };
    let callbacks = callbacks(Some(&mut log));
    let (mut name, mut kind, mut guid_pointer, mut callbacks_pointer) =
        (c"refused".as_ptr(), 1, guid.as_ptr(), &raw const callbacks);
    match choices.below(6) {
        0 => kind = choices.of(&[0, 2, -1, c_int::MAX]),
        1 => guid_pointer = null(),
        2 => guid_pointer = choices.of(&[c"", c"{", c"{%s%s%s%n}", c"\xff"]).as_ptr(),
        3 => callbacks_pointer = null(),
        4 => (name, log.name) = (null(), String::new()),
        _ => (name, log.name) = (c"".as_ptr(), String::new()),
    }
    // SAFETY: strings and callbacks live during the call.
    let made = unsafe { (api.instantiate)(name, kind, guid_pointer, null(), callbacks_pointer, 0, 1) };
    assert!(made.is_null());
    let messages: Vec<_> = log.messages.iter().map(|message| (message.status, message.category.as_str())).collect();
    let expected: &[_] = if callbacks_pointer.is_null() { &[] } else { &[(ERROR, "logStatusError")] };
    assert_eq!(messages, expected);
    world.count("fmi2Instantiate", ERROR);
}

fn setup_experiment(world: &mut World, who: usize, api: &Api) -> i32 {
    let experiment = Experiment::any(&mut world.choices);
    let Experiment { start, stop_defined, stop, tolerance_defined, tolerance, right } = experiment;
    let (stop_defined, tolerance_defined) = (c_int::from(stop_defined), c_int::from(tolerance_defined));
    let player = &mut world.players[who];
    let right = if player.expected.allows("fmi2SetupExperiment") { right } else { ERROR };
    // SAFETY: the instance is alive.
    let status =
        unsafe { (api.setup_experiment)(player.component, tolerance_defined, tolerance, start, stop_defined, stop) };
    if status == OK {
        experiment.accept(&mut player.expected);
    }
    world.accept(who, ("fmi2SetupExperiment", status), &[right])
}

fn enter_initialization_mode(world: &mut World, who: usize, api: &Api) -> i32 {
    let player = &mut world.players[who];
    let allowed = player.expected.state == 'I' && player.expected.experiment.is_some();
    // SAFETY: the instance is alive.
    let status = unsafe { (api.enter_initialization_mode)(player.component) };
    if status == OK {
        player.expected.state = 'N';
    }
    world.accept(who, ("fmi2EnterInitializationMode", status), &[if allowed { OK } else { ERROR }])
}

fn platform_and_version(world: &mut World, api: &Api) -> i32 {
    // SAFETY: the functions take nothing and return strings.
    unsafe {
        assert_eq!(CStr::from_ptr((api.get_types_platform)()), c"default");
        assert_eq!(CStr::from_ptr((api.get_version)()), c"2.0");
    }
    world.count("fmi2GetTypesPlatform", OK);
    world.count("fmi2GetVersion", OK);
    OK
}

/// There are no strings.
fn strings(world: &mut World, who: usize, api: &Api) -> i32 {
    let count = world.choices.below(3);
    let c = world.players[who].component;
    let mut values = [null(); 2];
    let get = world.choices.once_in(2);
    // SAFETY: the instance is alive, and the arrays have two elements.
    let (function, status) = unsafe {
        if get {
            ("fmi2GetString", (api.get_string)(c, [0, 1].as_ptr(), count, values.as_mut_ptr()))
        } else {
            ("fmi2SetString", (api.set_string)(c, [0, 1].as_ptr(), count, values.as_ptr()))
        }
    };
    let right = if world.players[who].expected.allows(function) && count == 0 { OK } else { ERROR };
    world.accept(who, (function, status), &[right])
}

/// Functions of model exchange, and others that cannot be used here.
fn never(world: &mut World, who: usize, api: &Api) -> i32 {
    let c = world.players[who].component;
    let mut reals = [0.0; 2];
    let (mut integer, at) = (0, reals.as_mut_ptr());
    let function = world.choices.below(12);
    // SAFETY: the instance is alive, and the pointers lead to more than is asked for.
    let (name, status) = unsafe {
        match function {
            0 => ("fmi2CancelStep", (api.cancel_step)(c)),
            1 => ("fmi2EnterEventMode", (api.enter_event_mode)(c)),
            2 => ("fmi2NewDiscreteStates", (api.new_discrete_states)(c, null_mut())),
            3 => ("fmi2EnterContinuousTimeMode", (api.enter_continuous_time_mode)(c)),
            4 => {
                let mut terminate = 0;
                let status = (api.completed_integrator_step)(c, 0, &mut integer, &mut terminate);
                ("fmi2CompletedIntegratorStep", status)
            }
            5 => ("fmi2SetTime", (api.set_time)(c, 0.0)),
            6 => ("fmi2SetContinuousStates", (api.set_continuous_states)(c, at, 2)),
            7 => ("fmi2GetDerivatives", (api.get_derivatives)(c, at, 2)),
            8 => ("fmi2GetEventIndicators", (api.get_event_indicators)(c, at, 2)),
            9 => ("fmi2GetContinuousStates", (api.get_continuous_states)(c, at, 2)),
            10 => ("fmi2GetNominalsOfContinuousStates", (api.get_nominals_of_continuous_states)(c, at, 2)),
            _ => {
                let status = (api.get_directional_derivative)(c, &20, 1, &1, 1, &1.0, at);
                ("fmi2GetDirectionalDerivative", status)
            }
        }
    };
    assert_eq!((reals, integer), ([0.0; 2], 0), "{name} wrote something");
    world.accept(who, (name, status), &[ERROR])
}

/// Status of the last step.
pub fn status(world: &mut World, who: usize, api: &Api) -> i32 {
    let c = world.players[who].component;
    let kind = world.choices.of(&[0, 1, 2, 3, 4, -1, c_int::MAX]);
    let (mut integer, mut real, mut string) = (-7, f64::NAN, null());
    let function = world.choices.below(5);
    // SAFETY: the instance is alive, and the pointers lead to one element.
    let (name, status, known) = unsafe {
        match function {
            0 => ("fmi2GetStatus", (api.get_status)(c, kind, &mut integer), false),
            1 => ("fmi2GetRealStatus", (api.get_real_status)(c, kind, &mut real), kind == 2),
            2 => ("fmi2GetIntegerStatus", (api.get_integer_status)(c, kind, &mut integer), false),
            3 => ("fmi2GetBooleanStatus", (api.get_boolean_status)(c, kind, &mut integer), kind == 3),
            _ => ("fmi2GetStringStatus", (api.get_string_status)(c, kind, &mut string), false),
        }
    };
    let expected = &world.players[who].expected;
    let right = match expected.allows(name) {
        true if known => OK,
        true => DISCARD,
        false => ERROR,
    };
    if status == OK {
        assert!(if function == 1 { real == expected.time } else { integer == 0 }, "{name}: {real} {integer}");
    } else {
        assert!(real.is_nan() && integer == -7 && string.is_null(), "{name} wrote something");
    }
    world.accept(who, (name, status), &[right])
}

/// `fmi2SetRealInputDerivatives`
pub fn input_derivatives(world: &mut World, who: usize, api: &Api) -> i32 {
    const FUNCTION: &str = "fmi2SetRealInputDerivatives";
    let choices = &mut world.choices;
    let functions = world.functions;
    let fits = |reference| has_derivative(functions, reference, Causality::Input);
    let references = references(functions, choices, Type::Real, 30, fits);
    let orders: Vec<c_int> = references.iter().map(|_| order(choices)).collect();
    let values: Vec<f64> = references.iter().map(|_| palette::real(choices, 0.0)).collect();
    let no_orders = choices.once_in(40);
    let mut right = OK;
    if !world.players[who].expected.allows(FUNCTION)
        || no_orders && !references.is_empty()
        || !references.iter().all(|&r| has_derivative(world.functions, r, Causality::Input))
        || orders.iter().any(|&order| order != 1)
    {
        right = ERROR;
    } else if !values.iter().all(|value| value.is_finite()) {
        right = DISCARD;
    }
    let at = if no_orders { null() } else { orders.as_ptr() };
    // SAFETY: the instance is alive, and the pointers are null or lead to as many elements as are given.
    let status = unsafe {
        let function = api.set_real_input_derivatives;
        function(world.players[who].component, references.as_ptr(), references.len(), at, values.as_ptr())
    };
    world.accept(who, (FUNCTION, status), &[right])
}
