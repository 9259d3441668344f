//! Getting and setting, by references and values that are right and wrong.

use std::ffi::c_int;
use std::ptr::{null, null_mut};

use moris_interface::{Causality, Variability};

use super::choices::Choices;
use super::expected::{DISCARD, ERROR, Expected, IDENTITY, OK, Type, admits, type_of};
use super::palette;
use super::world::World;

const GETTERS: [&str; 3] = ["fmi2GetReal", "fmi2GetInteger", "fmi2GetBoolean"];
const SETTERS: [&str; 3] = ["fmi2SetReal", "fmi2SetInteger", "fmi2SetBoolean"];

/// One setter in this many may change the rig.
const RIGS: usize = 200;

/// Defects of a call's pointers.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pointers {
    Right,
    NoReferences,
    NoValues,
}

fn pointers(choices: &mut Choices) -> Pointers {
    match choices.below(40) {
        0 => Pointers::NoReferences,
        1 => Pointers::NoValues,
        _ => Pointers::Right,
    }
}

/// References that a call of this type could have: mostly right ones, some repeated.
fn references(choices: &mut Choices, wanted: Type, wrong: usize, fits: impl Fn(usize) -> bool) -> Vec<u32> {
    let count = choices.of(&[0, 1, 1, 1, 2, 3, 11]);
    let mut references: Vec<u32> = vec![];
    for _ in 0..count {
        let reference = match choices.below(wrong) {
            0 => choices.of(&[u32::MAX, IDENTITY.slots.len() as u32, 1 << 31, 100_000]),
            1 => choices.below(IDENTITY.slots.len()) as u32,
            2 => references.last().copied().unwrap_or(0),
            _ => {
                // The first that fits, from somewhere on.
                let (all, from) = (IDENTITY.slots.len(), choices.below(IDENTITY.slots.len()));
                let fitting = |&slot: &usize| type_of(slot) == wanted && fits(slot);
                (from..from + all).map(|slot| slot % all).find(fitting).unwrap_or(0) as u32
            }
        };
        references.push(reference);
    }
    references
}

fn exists_as(reference: u32, wanted: Type) -> bool {
    (reference as usize) < IDENTITY.slots.len() && type_of(reference as usize) == wanted
}

/// A getter's call.
pub fn get(world: &mut World, who: usize) -> i32 {
    let kind = world.choices.below(3);
    let wanted = [Type::Real, Type::Integer, Type::Boolean][kind];
    let references = references(&mut world.choices, wanted, 60, |_| true);
    let pointers = pointers(&mut world.choices);
    let function = GETTERS[kind];
    let mut right = OK;
    if !world.players[who].expected.allows(function)
        || !references.is_empty() && pointers != Pointers::Right
        || !references.iter().all(|&reference| exists_as(reference, wanted))
    {
        right = ERROR;
    }
    let count = references.len();
    let (mut reals, mut integers) = (vec![f64::NAN; count], vec![c_int::MIN; count]);
    let at = if pointers == Pointers::NoReferences { null() } else { references.as_ptr() };
    let no_values = pointers == Pointers::NoValues;
    let real = if no_values { null_mut() } else { reals.as_mut_ptr() };
    let integer = if no_values { null_mut() } else { integers.as_mut_ptr() };
    let (c, api) = (world.players[who].component, world.api);
    // SAFETY: the instance is alive, and the pointers are null or lead to `count` elements.
    let status = unsafe {
        match wanted {
            Type::Real => (api.get_real)(c, at, count, real),
            Type::Integer => (api.get_integer)(c, at, count, integer),
            Type::Boolean => (api.get_boolean)(c, at, count, integer),
        }
    };
    world.accept(who, function, status, &[right]);
    let untouched = reals.iter().all(|value| value.is_nan()) && integers.iter().all(|&value| value == c_int::MIN);
    assert!(status == OK || untouched, "{function} was refused and wrote something");
    status
}

/// A setter's call.
pub fn set(world: &mut World, who: usize) -> i32 {
    let kind = world.choices.below(8).saturating_sub(5);
    let wanted = [Type::Real, Type::Integer, Type::Boolean][kind];
    let function = SETTERS[kind];
    let (choices, expected) = (&mut world.choices, &world.players[who].expected);
    // Half of the time only inputs, so that parameters do not all end up far off; and seldom another rig, for each is
    // surveyed for a while.
    let (inputs_only, rig_too) = (choices.once_in(2), choices.once_in(RIGS));
    let fits = |slot: usize| {
        let row = IDENTITY.row(slot);
        expected.settable(slot)
            && (!inputs_only || row.causality == Causality::Input)
            && (rig_too || !(row.name.starts_with("rig.") || row.name.starts_with("actuator.")))
    };
    let references = references(choices, wanted, 60, fits);
    let values: Vec<f64> = references.iter().map(|&reference| value(choices, wanted, reference, expected)).collect();
    let pointers = pointers(choices);
    let mut right = OK;
    let existing = references.iter().all(|&r| exists_as(r, wanted) && expected.settable(r as usize));
    if !expected.allows(function) || !references.is_empty() && pointers != Pointers::Right || !existing {
        right = ERROR;
    } else if !references.iter().zip(&values).all(|(&r, &value)| wanted == Type::Boolean || admits(r as usize, value)) {
        right = DISCARD;
    }
    let count = references.len();
    let integers: Vec<c_int> = values.iter().map(|&value| value as c_int).collect();
    let at = if pointers == Pointers::NoReferences { null() } else { references.as_ptr() };
    let no_values = pointers == Pointers::NoValues;
    let real = if no_values { null() } else { values.as_ptr() };
    let integer = if no_values { null() } else { integers.as_ptr() };
    let (c, api) = (world.players[who].component, world.api);
    // SAFETY: the instance is alive, and the pointers are null or lead to `count` elements.
    let status = unsafe {
        match wanted {
            Type::Real => (api.set_real)(c, at, count, real),
            Type::Integer => (api.set_integer)(c, at, count, integer),
            Type::Boolean => (api.set_boolean)(c, at, count, integer),
        }
    };
    world.accept(who, function, status, &[right]);
    if status == OK {
        let expected = &mut world.players[who].expected;
        for (&reference, &value) in references.iter().zip(&values) {
            expected.values[reference as usize] = if wanted == Type::Boolean { f64::from(value != 0.0) } else { value };
        }
    }
    status
}

fn value(choices: &mut Choices, wanted: Type, reference: u32, expected: &Expected) -> f64 {
    let present = expected.values.get(reference as usize).copied().unwrap_or(0.0);
    match wanted {
        Type::Real => palette::real(choices, present),
        _ => f64::from(palette::integer(choices)),
    }
}

/// `fmi2SetRealInputDerivatives`
pub fn input_derivatives(world: &mut World, who: usize) -> i32 {
    const FUNCTION: &str = "fmi2SetRealInputDerivatives";
    let choices = &mut world.choices;
    let references = references(choices, Type::Real, 30, |slot| has_derivative(slot, Causality::Input));
    let orders: Vec<c_int> = references.iter().map(|_| order(choices)).collect();
    let values: Vec<f64> = references.iter().map(|_| palette::real(choices, 0.0)).collect();
    let no_orders = choices.once_in(40);
    let mut right = OK;
    if !world.players[who].expected.allows(FUNCTION)
        || no_orders && !references.is_empty()
        || !references.iter().all(|&r| exists_as(r, Type::Real) && has_derivative(r as usize, Causality::Input))
        || orders.iter().any(|&order| order != 1)
    {
        right = ERROR;
    } else if !values.iter().all(|value| value.is_finite()) {
        right = DISCARD;
    }
    let at = if no_orders { null() } else { orders.as_ptr() };
    // SAFETY: the instance is alive, and the pointers are null or lead to as many elements as are given.
    let status = unsafe {
        let function = world.api.set_real_input_derivatives;
        function(world.players[who].component, references.as_ptr(), references.len(), at, values.as_ptr())
    };
    world.accept(who, FUNCTION, status, &[right])
}

/// `fmi2GetRealOutputDerivatives`
pub fn output_derivatives(world: &mut World, who: usize) -> i32 {
    const FUNCTION: &str = "fmi2GetRealOutputDerivatives";
    let choices = &mut world.choices;
    let references = references(choices, Type::Real, 30, |slot| has_derivative(slot, Causality::Output));
    let orders: Vec<c_int> = references.iter().map(|_| order(choices)).collect();
    let no_values = choices.once_in(40);
    let mut right = OK;
    if !world.players[who].expected.allows(FUNCTION)
        || no_values && !references.is_empty()
        || !references.iter().all(|&r| exists_as(r, Type::Real) && has_derivative(r as usize, Causality::Output))
        || orders.iter().any(|&order| order != 1)
    {
        right = ERROR;
    }
    let mut values = vec![f64::NAN; references.len()];
    let to = if no_values { null_mut() } else { values.as_mut_ptr() };
    // SAFETY: the instance is alive, and the pointers are null or lead to as many elements as are given.
    let status = unsafe {
        let function = world.api.get_real_output_derivatives;
        function(world.players[who].component, references.as_ptr(), references.len(), orders.as_ptr(), to)
    };
    world.accept(who, FUNCTION, status, &[right]);
    let written = values.iter().all(|value| value.is_finite());
    let untouched = values.iter().all(|value| value.is_nan());
    assert!(if status == OK { written } else { untouched }, "{references:?} {values:?}");
    status
}

fn order(choices: &mut Choices) -> c_int {
    if choices.once_in(40) { choices.of(&[0, 2, -1, c_int::MAX]) } else { 1 }
}

fn has_derivative(slot: usize, causality: Causality) -> bool {
    let row = IDENTITY.row(slot);
    row.causality == causality && row.variability == Variability::Continuous && type_of(slot) == Type::Real
}
