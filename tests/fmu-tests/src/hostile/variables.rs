//! Getting and setting, by references and values that are right and wrong.

use std::ffi::c_int;
use std::ptr::{null, null_mut};

use moris_interface::{Causality, Variability};

use super::choices::Choices;
use super::expected::{DISCARD, ERROR, Expected, IDENTITY, OK, Type, admits};
use super::functions::{Access, Functions, Version};
use super::palette;
use super::world::World;

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

/// Most values that a call can be said to have beyond those it has.
const TOO_MANY: usize = 2;

/// The number of values that FMI 3.0 is told, of which there are `right`.
fn value_count(choices: &mut Choices, right: usize) -> usize {
    if choices.once_in(40) { choices.of(&[0, 1, right.saturating_sub(1), right + 1, right + TOO_MANY]) } else { right }
}

/// References that a call of this type could have: mostly right ones, some repeated.
pub fn references(
    functions: &Functions,
    choices: &mut Choices,
    variable_type: Type,
    wrong: usize,
    fits: impl Fn(u32) -> bool,
) -> Vec<u32> {
    let count = choices.of(&[0, 1, 1, 1, 2, 3, 11]);
    let all = IDENTITY.slots.len() as u32;
    let mut references: Vec<u32> = vec![];
    for _ in 0..count {
        let reference = match choices.below(wrong) {
            0 => choices.of(&[u32::MAX, all, 1 << 31, 100_000]),
            1 => choices.below(IDENTITY.slots.len()) as u32,
            2 => references.last().copied().unwrap_or(0),
            _ => {
                // The first that fits, from somewhere on.
                let from = choices.below(IDENTITY.slots.len()) as u32;
                let fitting = |&reference: &u32| exists_as(functions, reference, variable_type) && fits(reference);
                (from..from + all).map(|reference| reference % all).find(fitting).unwrap_or(0)
            }
        };
        references.push(reference);
    }
    references
}

/// True if there is a variable with this reference, and it has this type.
fn exists_as(functions: &Functions, reference: u32, variable_type: Type) -> bool {
    functions.slots(reference).is_some() && functions.type_of(reference as usize) == variable_type
}

/// Number of values of these variables; one for each that does not exist.
fn value_total(functions: &Functions, references: &[u32]) -> usize {
    references.iter().map(|&reference| functions.slots(reference).map_or(1, |slots| slots.len())).sum()
}

/// A call's type, references and what may be wrong with the rest of it.
struct Call {
    kind: Type,
    references: Vec<u32>,
    pointers: Pointers,
    /// Number of values that the variables have, and number that the library is told.
    total: usize,
    value_count: usize,
}

impl Call {
    fn new(functions: &Functions, choices: &mut Choices, kind: Type, references: Vec<u32>) -> Self {
        let total = value_total(functions, &references);
        Call { kind, pointers: pointers(choices), value_count: value_count(choices, total), references, total }
    }

    /// True unless the host has made a mistake with pointers or lengths.
    fn fits(&self, functions: &Functions) -> bool {
        let lengths_fit = self.value_count == self.total || matches!(functions.version, Version::Fmi2(_));
        lengths_fit && (self.references.is_empty() || self.pointers == Pointers::Right)
    }

    /// The library's arguments, with values of which there are more than it is ever told.
    fn access<'a>(&self, values: &'a mut [f64]) -> Access<'a> {
        assert!(values.len() >= self.value_count.max(self.total));
        let no_references = self.pointers == Pointers::NoReferences;
        Access {
            kind: self.kind,
            references: if no_references { null() } else { self.references.as_ptr() },
            count: self.references.len(),
            values: (self.pointers != Pointers::NoValues).then_some(values),
            value_count: self.value_count,
        }
    }
}

/// A getter's call.
pub fn get(world: &mut World, who: usize) -> i32 {
    let (functions, choices) = (world.functions, &mut world.choices);
    let kind = functions.variables[choices.below(functions.variables.len())].kind;
    let references = references(functions, choices, kind, 60, |_| true);
    let call = Call::new(functions, choices, kind, references);
    let mut values = vec![f64::NAN; call.total + TOO_MANY];
    // SAFETY: the instance is alive, and the pointers are null or lead to as many elements as are given.
    let answer = unsafe { functions.get(world.players[who].component, call.access(&mut values)) };
    let all_exist = call.references.iter().all(|&reference| exists_as(functions, reference, kind));
    let allowed = world.players[who].expected.allows(answer.0);
    let right = if allowed && call.fits(functions) && all_exist { OK } else { ERROR };
    let status = world.accept(who, answer, &[right]);
    let written = if status == OK { call.total } else { 0 };
    let (inside, beyond) = values.split_at(written);
    assert!(inside.iter().all(|value| value.is_finite()), "{}: {values:?}", answer.0);
    assert!(beyond.iter().all(|value| value.is_nan()), "{} wrote where it should not: {values:?}", answer.0);
    status
}

/// A setter's call.
pub fn set(world: &mut World, who: usize) -> i32 {
    let functions = world.functions;
    let kind = functions.variables[world.choices.below(8).saturating_sub(8 - functions.variables.len())].kind;
    let (choices, expected) = (&mut world.choices, &world.players[who].expected);
    // Half of the time only inputs, so that parameters do not all end up far off; and seldom another rig, for each is
    // surveyed for a while.
    let (inputs_only, rig_too) = (choices.once_in(2), choices.once_in(RIGS));
    // Some hosts write parameters again that cannot be set any more.
    let repeats = choices.once_in(8);
    let fits = |reference: u32| {
        let (slot, row) = (reference as usize, IDENTITY.row(reference as usize));
        (expected.settable(slot) || repeats && expected.takes(slot, expected.values[slot]))
            && (!inputs_only || row.causality == Causality::Input)
            && !row.name.starts_with("crank.")
            && (rig_too || !(row.name.starts_with("rig.") || row.name.starts_with("actuator.")))
    };
    let references = references(functions, choices, kind, 60, fits);
    let call = Call::new(functions, choices, kind, references);
    let slots: Vec<usize> = call.references.iter().filter_map(|&r| functions.slots(r)).flatten().collect();
    let mut value = |&slot: &usize| {
        if repeats && !expected.settable(slot) && !choices.once_in(8) {
            return expected.values[slot];
        }
        value(choices, kind, slot, expected)
    };
    let mut values: Vec<f64> = slots.iter().map(&mut value).collect();
    values.resize(call.total + TOO_MANY, 0.0);
    // SAFETY: the instance is alive, and the pointers are null or lead to as many elements as are given.
    let answer = unsafe { functions.set(world.players[who].component, call.access(&mut values)) };
    let exist = call.references.iter().all(|&r| exists_as(functions, r, kind));
    let mut set = slots.iter().zip(&values);
    let takes = |(&slot, &value): (&usize, &f64)| expected.takes(slot, functions.converted(kind, value));
    let right = if !expected.allows(answer.0) || !call.fits(functions) || !exist || !set.all(takes) {
        ERROR
    } else if slots.iter().zip(&values).all(|(&slot, &value)| kind == Type::Boolean || admits(slot, value)) {
        OK
    } else {
        DISCARD
    };
    let status = world.accept(who, answer, &[right]);
    if status == OK {
        let expected = &mut world.players[who].expected;
        for (slot, value) in slots.into_iter().zip(values) {
            expected.values[slot] = functions.converted(kind, value);
        }
    }
    status
}

fn value(choices: &mut Choices, kind: Type, slot: usize, expected: &Expected) -> f64 {
    match kind {
        Type::Real => palette::real(choices, expected.values[slot]),
        _ => f64::from(palette::integer(choices)),
    }
}

/// Derivatives of outputs.
pub fn output_derivatives(world: &mut World, who: usize) -> i32 {
    let (functions, choices) = (world.functions, &mut world.choices);
    let fits = |reference| has_derivative(functions, reference, Causality::Output);
    let references = references(functions, choices, Type::Real, 30, fits);
    let orders: Vec<c_int> = references.iter().map(|_| order(choices)).collect();
    let call = Call::new(functions, choices, Type::Real, references);
    let mut values = vec![f64::NAN; call.total + TOO_MANY];
    let access = call.access(&mut values);
    let to = access.values.map_or(null_mut(), <[f64]>::as_mut_ptr);
    let (variables, component) = ((access.references, access.count), world.players[who].component);
    // SAFETY: the instance is alive, and the pointers are null or lead to as many elements as are given.
    let answer =
        unsafe { functions.get_output_derivatives(component, variables, orders.as_ptr(), to, access.value_count) };
    let right = if world.players[who].expected.allows(answer.0)
        && call.fits(functions)
        && call.references.iter().all(|&r| has_derivative(functions, r, Causality::Output))
        && orders.iter().all(|&order| order == 1)
    {
        OK
    } else {
        ERROR
    };
    let status = world.accept(who, answer, &[right]);
    let written = if status == OK { call.total } else { 0 };
    let (inside, beyond) = values.split_at(written);
    assert!(inside.iter().all(|value| value.is_finite()), "{:?} {values:?}", call.references);
    assert!(beyond.iter().all(|value| value.is_nan()), "{:?} {values:?}", call.references);
    status
}

/// An order of a derivative, seldom another than the first.
pub fn order(choices: &mut Choices) -> c_int {
    if choices.once_in(40) { choices.of(&[0, 2, -1, c_int::MAX]) } else { 1 }
}

/// True if the reference is that of a variable with derivatives.
pub fn has_derivative(functions: &Functions, reference: u32, causality: Causality) -> bool {
    let is_continuous = |slot: usize| {
        let row = IDENTITY.row(slot);
        row.causality == causality && row.variability == Variability::Continuous
    };
    exists_as(functions, reference, Type::Real) && is_continuous(reference as usize)
}
