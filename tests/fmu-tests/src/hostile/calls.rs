//! The functions of an instance's life, by either version. What only one version has is in
//! [`fmi2`] and [`fmi3`].

use std::ffi::CStr;
use std::ptr::{null, null_mut};

use moris_fmu_host::api::Text;

use super::choices::Choices;
use super::expected::{ERROR, Expected, OK};
use super::functions::Version;
use super::palette;
use super::player::Player;
use super::world::World;
use super::{fmi2, fmi3};

/// Instantiation, with arguments of which one may be wrong.
pub fn instantiate(world: &mut World) {
    let choices = &mut world.choices;
    if choices.once_in(4) {
        let functions = world.functions;
        return match &functions.version {
            Version::Fmi2(api) => fmi2::refused_instantiation(world, api),
            Version::Fmi3(api, layout) => fmi3::refused_instantiation(world, api, *layout),
        };
    }
    let name = choices.of(&["a", "%s%n", "Wäsche", " a", "two\nlines"]);
    let (with_logger, logging_on) = (!choices.once_in(8), choices.once_in(2));
    let functions = world.functions;
    world.players.push(Player::new(functions, name, with_logger, logging_on));
    let function = match functions.version {
        Version::Fmi2(_) => "fmi2Instantiate",
        Version::Fmi3(..) => "fmi3InstantiateCoSimulation",
    };
    world.count(function, OK);
}

/// Freeing an instance or none.
pub fn free_instance(world: &mut World, who: usize) {
    let function = if world.choices.once_in(4) {
        // SAFETY: null is ignored.
        unsafe { world.functions.free_instance(null_mut()).0 }
    } else {
        world.players.swap_remove(who).free(world.functions)
    };
    world.count(function, OK);
}

/// The right call to get to stepping from wherever the instance is.
pub fn towards_steps(world: &mut World, who: usize) -> i32 {
    match world.players[who].expected.state {
        'I' => begin(world, who),
        'N' => exit_initialization_mode(world, who),
        'T' => reset(world, who),
        _ => super::steps::do_step(world, who),
    }
}

/// Any of the functions without much of an argument, allowed or not.
pub fn any(world: &mut World, who: usize) -> i32 {
    let functions = world.functions;
    match world.choices.below(24) {
        0..5 => begin(world, who),
        5..7 => exit_initialization_mode(world, who),
        7 => terminate(world, who),
        8 => reset(world, who),
        9..12 => set_debug_logging(world, who),
        choice => match &functions.version {
            Version::Fmi2(api) => fmi2::any(world, who, api, choice - 12),
            Version::Fmi3(api, _) => fmi3::any(world, who, api, choice - 12),
        },
    }
}

/// A call that hosts of this version make often and those of the other never.
pub fn own_of_version(world: &mut World, who: usize) -> i32 {
    let functions = world.functions;
    match &functions.version {
        Version::Fmi2(api) => fmi2::input_derivatives(world, who, api),
        Version::Fmi3(api, _) => fmi3::other_types(world, who, api),
    }
}

/// A query of the last step, or a call that is not supported.
pub fn seldom(world: &mut World, who: usize) -> i32 {
    let functions = world.functions;
    match &functions.version {
        Version::Fmi2(api) => fmi2::status(world, who, api),
        Version::Fmi3(api, _) => fmi3::never(world, who, api),
    }
}

/// The calls up to initialization mode.
fn begin(world: &mut World, who: usize) -> i32 {
    let functions = world.functions;
    match &functions.version {
        Version::Fmi2(api) => fmi2::begin(world, who, api),
        Version::Fmi3(api, _) => fmi3::enter_initialization_mode(world, who, api),
    }
}

/// Between which times a host wants to run, and with what tolerance.
pub struct Experiment {
    pub start: f64,
    pub stop_defined: bool,
    pub stop: f64,
    pub tolerance_defined: bool,
    pub tolerance: f64,
    /// The right answer where the call is allowed.
    pub right: i32,
}

impl Experiment {
    /// An experiment, of which one argument may be wrong.
    pub fn any(choices: &mut Choices) -> Experiment {
        let start = choices.of(&[0.0, 0.0, 0.0, 1.0, -5.0, 100.0]);
        let tolerance = choices.of(&[1e-6, 1.0]);
        let (tolerance_defined, stop_defined) = (choices.once_in(2), choices.once_in(2));
        let stop = start + choices.of(&[0.0, 0.05, 1.0, 1000.0]);
        let mut experiment = Experiment { start, stop_defined, stop, tolerance_defined, tolerance, right: OK };
        // What is not defined is not looked at.
        let refused_if = |defined| if defined { ERROR } else { OK };
        match choices.below(16) {
            0 => (experiment.start, experiment.right) = (palette::not_finite(choices), ERROR),
            1 => {
                experiment.stop = palette::not_finite(choices);
                experiment.right = refused_if(stop_defined && experiment.stop != f64::INFINITY);
            }
            2 => (experiment.stop, experiment.right) = (start - 1e-3, refused_if(stop_defined)),
            3 => {
                experiment.tolerance = choices.of(&[0.0, -1.0, f64::NAN, f64::INFINITY]);
                experiment.right = refused_if(tolerance_defined && experiment.tolerance != 0.0);
            }
            _ => {}
        }
        experiment
    }

    /// Makes it the expected one.
    pub fn accept(&self, expected: &mut Expected) {
        expected.experiment = Some((self.start, if self.stop_defined { self.stop } else { f64::INFINITY }));
        expected.time = self.start;
    }
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
    let answer = unsafe { world.functions.exit_initialization_mode(player.component) };
    if answer.1 == OK {
        player.expected.state = 'C';
        player.expected.legs = None;
    }
    world.accept(who, answer, right)
}

fn terminate(world: &mut World, who: usize) -> i32 {
    let player = &mut world.players[who];
    // SAFETY: the instance is alive.
    let answer = unsafe { world.functions.terminate(player.component) };
    let right = if player.expected.allows(answer.0) { OK } else { ERROR };
    if answer.1 == OK {
        player.expected.state = 'T';
    }
    world.accept(who, answer, &[right])
}

fn reset(world: &mut World, who: usize) -> i32 {
    let player = &mut world.players[who];
    // SAFETY: the instance is alive.
    let answer = unsafe { world.functions.reset(player.component) };
    player.expected = Expected::fresh();
    world.accept(who, answer, &[OK])
}

/// Switching categories of messages on or off: FMI 2.0 knows more of them, of which events
/// alone make a difference.
fn set_debug_logging(world: &mut World, who: usize) -> i32 {
    let functions = world.functions;
    let known: &[&CStr] = match functions.version {
        Version::Fmi2(_) => fmi2::LOG_CATEGORIES,
        Version::Fmi3(..) => fmi3::LOG_CATEGORIES,
    };
    let choices = &mut world.choices;
    let (on, count) = (choices.once_in(2), choices.below(3));
    let chosen: Vec<&CStr> = (0..count).map(|_| choices.of(known)).collect();
    let mut categories: Vec<Text> = chosen.iter().map(|category| category.as_ptr()).collect();
    let wrong = count > 0 && choices.once_in(8);
    if wrong {
        categories[0] = choices.of(&[c"".as_ptr(), c"%n%n".as_ptr(), null(), c"\xfe".as_ptr()]);
    }
    let at = if choices.once_in(16) { null() } else { categories.as_ptr() };
    let right = if count > 0 && (wrong || at.is_null()) { ERROR } else { OK };
    let player = &mut world.players[who];
    // SAFETY: the instance is alive, and the pointer is null or leads to `count` strings.
    let answer = unsafe { world.functions.set_debug_logging(player.component, on, count, at) };
    if answer.1 == OK {
        match functions.version {
            Version::Fmi2(_) => fmi2::switch_logging(&mut player.logged, on, &chosen),
            Version::Fmi3(..) => fmi3::switch_logging(&mut player.logged, on, &chosen),
        }
    }
    world.accept(who, answer, &[right])
}
