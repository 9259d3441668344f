//! The functions of an instance's life, those that ask how it went, and those
//! that can never be used.

use std::ffi::{CStr, c_int};
use std::ptr::{null, null_mut};

use moris_fmu_host::api::Text;
use moris_washout::Washout;

use super::expected::{DISCARD, ERROR, Expected, OK};
use super::logger::Log;
use super::palette;
use super::player::{Player, c_string, callbacks};
use super::world::World;

/// `fmi2Instantiate`, with arguments of which one may be wrong.
pub fn instantiate(world: &mut World) {
    let choices = &mut world.choices;
    if !choices.once_in(4) {
        let name = choices.of(&["a", "%s%n", "Wäsche", " ", "two\nlines"]);
        let (with_logger, events) = (!choices.once_in(8), choices.once_in(2));
        world.players.push(Player::new(world.api, name, with_logger, events));
        return world.count("fmi2Instantiate", OK);
    }
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
    let made = unsafe { (world.api.instantiate)(name, kind, guid_pointer, null(), callbacks_pointer, 0, 1) };
    assert!(made.is_null());
    let said: Vec<_> = log.said.iter().map(|said| (said.status, said.category.as_str())).collect();
    let expected: &[_] = if callbacks_pointer.is_null() { &[] } else { &[(ERROR, "logStatusError")] };
    assert_eq!(said, expected);
    world.count("fmi2Instantiate", ERROR);
}

/// `fmi2FreeInstance`, of an instance or of none.
pub fn free_instance(world: &mut World, who: usize) {
    if world.choices.once_in(4) {
        // SAFETY: null is ignored.
        unsafe { (world.api.free_instance)(null_mut()) };
    } else {
        world.players.swap_remove(who).free(world.api);
    }
    world.count("fmi2FreeInstance", OK);
}

/// The right call to get to stepping from wherever the instance is.
pub fn towards_steps(world: &mut World, who: usize) -> i32 {
    match world.players[who].expected.state {
        'I' if world.players[who].expected.experiment.is_none() => setup_experiment(world, who),
        'I' => enter_initialization_mode(world, who),
        'N' => exit_initialization_mode(world, who),
        'T' => reset(world, who),
        _ => super::steps::do_step(world, who),
    }
}

/// Any of the functions without much of an argument, allowed or not.
pub fn any(world: &mut World, who: usize) -> i32 {
    match world.choices.below(24) {
        0..3 => setup_experiment(world, who),
        3..5 => enter_initialization_mode(world, who),
        5..7 => exit_initialization_mode(world, who),
        7 => terminate(world, who),
        8 => reset(world, who),
        9..12 => set_debug_logging(world, who),
        12 => platform_and_version(world),
        13..16 => strings(world, who),
        _ => never(world, who),
    }
}

fn setup_experiment(world: &mut World, who: usize) -> i32 {
    let choices = &mut world.choices;
    let mut start = choices.of(&[0.0, 0.0, 0.0, 1.0, -5.0, 100.0]);
    let mut tolerance = choices.of(&[1e-6, 1.0]);
    let (tolerance_defined, stop_defined) = (choices.below(2) as c_int, choices.below(2) as c_int);
    let mut stop = start + choices.of(&[0.0, 0.05, 1.0, 1000.0]);
    let mut right = OK;
    match choices.below(16) {
        0 => (start, right) = (palette::not_finite(choices), ERROR),
        1 => (stop, right) = (palette::not_finite(choices), if stop_defined != 0 { ERROR } else { OK }),
        2 => (stop, right) = (start - 1e-3, if stop_defined != 0 { ERROR } else { OK }),
        3 => {
            tolerance = choices.of(&[0.0, -1.0, f64::NAN, f64::INFINITY]);
            right = if tolerance_defined != 0 { ERROR } else { OK };
        }
        _ => {}
    }
    let player = &mut world.players[who];
    if !player.expected.allows("fmi2SetupExperiment") {
        right = ERROR;
    }
    // SAFETY: the instance is alive.
    let status = unsafe {
        (world.api.setup_experiment)(player.component, tolerance_defined, tolerance, start, stop_defined, stop)
    };
    if status == OK {
        player.expected.experiment = Some((start, if stop_defined != 0 { stop } else { f64::INFINITY }));
        player.expected.time = start;
    }
    world.accept(who, "fmi2SetupExperiment", status, &[right])
}

fn enter_initialization_mode(world: &mut World, who: usize) -> i32 {
    let player = &mut world.players[who];
    let allowed = player.expected.state == 'I' && player.expected.experiment.is_some();
    // SAFETY: the instance is alive.
    let status = unsafe { (world.api.enter_initialization_mode)(player.component) };
    if status == OK {
        player.expected.state = 'N';
    }
    world.accept(who, "fmi2EnterInitializationMode", status, &[if allowed { OK } else { ERROR }])
}

/// Validity of the parameters is the washout's own affair, but its start values are valid.
fn exit_initialization_mode(world: &mut World, who: usize) -> i32 {
    let player = &mut world.players[who];
    let right: &[_] = match player.expected.state {
        'N' if player.expected.has_start_parameters() => &[OK],
        'N' => &[OK, ERROR],
        _ => &[ERROR],
    };
    // SAFETY: the instance is alive.
    let status = unsafe { (world.api.exit_initialization_mode)(player.component) };
    if status == OK {
        player.expected.state = 'C';
        player.expected.legs = None;
    }
    world.accept(who, "fmi2ExitInitializationMode", status, right)
}

fn terminate(world: &mut World, who: usize) -> i32 {
    let player = &mut world.players[who];
    let right = if player.expected.allows("fmi2Terminate") { OK } else { ERROR };
    // SAFETY: the instance is alive.
    let status = unsafe { (world.api.terminate)(player.component) };
    if status == OK {
        player.expected.state = 'T';
    }
    world.accept(who, "fmi2Terminate", status, &[right])
}

fn reset(world: &mut World, who: usize) -> i32 {
    let player = &mut world.players[who];
    // SAFETY: the instance is alive.
    let status = unsafe { (world.api.reset)(player.component) };
    player.expected = Expected::fresh();
    world.accept(who, "fmi2Reset", status, &[OK])
}

fn set_debug_logging(world: &mut World, who: usize) -> i32 {
    const CATEGORIES: [&CStr; 6] =
        [c"logEvents", c"logAll", c"logStatusError", c"logStatusWarning", c"logStatusDiscard", c"logStatusFatal"];
    let choices = &mut world.choices;
    let on = choices.below(2) as c_int;
    let count = choices.below(3);
    let mut categories: Vec<Text> = vec![];
    let mut events = count == 0;
    for _ in 0..count {
        let category = choices.below(CATEGORIES.len());
        events |= category < 2;
        categories.push(CATEGORIES[category].as_ptr());
    }
    let wrong = count > 0 && choices.once_in(8);
    if wrong {
        categories[0] = choices.of(&[c"".as_ptr(), c"%n%n".as_ptr(), null(), c"\xfe".as_ptr()]);
    }
    let at = if choices.once_in(16) { null() } else { categories.as_ptr() };
    let right = if count > 0 && (wrong || at.is_null()) { ERROR } else { OK };
    let player = &mut world.players[who];
    // SAFETY: the instance is alive, and the pointer is null or leads to `count` strings.
    let status = unsafe { (world.api.set_debug_logging)(player.component, on, count, at) };
    if status == OK {
        player.events = on != 0 && events;
    }
    world.accept(who, "fmi2SetDebugLogging", status, &[right])
}

fn platform_and_version(world: &mut World) -> i32 {
    // SAFETY: the functions take nothing and return strings.
    unsafe {
        assert_eq!(CStr::from_ptr((world.api.get_types_platform)()), c"default");
        assert_eq!(CStr::from_ptr((world.api.get_version)()), c"2.0");
    }
    world.count("fmi2GetTypesPlatform", OK);
    world.count("fmi2GetVersion", OK);
    OK
}

/// There are no strings.
fn strings(world: &mut World, who: usize) -> i32 {
    let count = world.choices.below(3);
    let (c, api) = (world.players[who].component, world.api);
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
    world.accept(who, function, status, &[right])
}

/// Functions of model exchange, and others that cannot be used here.
fn never(world: &mut World, who: usize) -> i32 {
    let (c, api) = (world.players[who].component, world.api);
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
    world.accept(who, name, status, &[ERROR])
}

/// Status of the last step.
pub fn status(world: &mut World, who: usize) -> i32 {
    let (c, api) = (world.players[who].component, world.api);
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
    world.accept(who, name, status, &[right])
}
