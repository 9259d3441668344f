//! Access rights of each variable, computed at compile time, so that get and set are a tight loop.

use moris_interface::{Causality, Identity, Kind, Row, Variability};

use crate::{Mode, Modes};

/// Type of a variable, for all versions of FMI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueType {
    Real,
    Integer,
    Boolean,
    Enumeration,
}

/// A value as the host has it, by one of a version's get and set functions.
pub trait Scalar: Copy {
    /// True if the version's functions apply to variables of this type.
    fn is(value_type: ValueType) -> bool;
    /// The version's name of the type.
    fn type_name(value_type: ValueType) -> &'static str;
    /// The value as a slot holds it.
    fn to_slot(self) -> f64;
    /// The value that a slot holds.
    fn from_slot(slot: f64) -> Self;
}

/// Declares a version's type of values: the types of variables that it holds, and how a slot holds
/// such a value. The version's function `type_name` has to be in scope.
macro_rules! scalar {
    ($type:ident, $($value_type:ident)|+, |$value:ident| $to_slot:expr, |$slot:ident| $from_slot:expr) => {
        impl Scalar for $type {
            #[inline]
            fn is(value_type: ValueType) -> bool {
                matches!(value_type, $(ValueType::$value_type)|+)
            }
            fn type_name(value_type: ValueType) -> &'static str {
                type_name(value_type)
            }
            #[inline]
            fn to_slot(self) -> f64 {
                let $value = self;
                $to_slot
            }
            #[inline]
            fn from_slot($slot: f64) -> Self {
                $from_slot
            }
        }
    };
}
pub(crate) use scalar;

/// Causality of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    Time,
    /// An input; a continuous one can be given time derivatives.
    Input {
        continuous: bool,
    },
    Output {
        continuous: bool,
    },
    Parameter,
}

/// Access rights of one variable.
#[derive(Clone, Copy, Debug)]
pub struct VariableInfo {
    pub value_type: ValueType,
    pub role: Role,
    /// Number of slots of the row that begins here; 0 for its other slots. FMI 3.0
    /// has a variable a row.
    pub row_slots: u32,
    /// The modes in which it can be set.
    pub settable: Modes,
    /// The smallest and the largest value that can be set; NaN and the infinities
    /// are never between them.
    lower: f64,
    upper: f64,
    /// True if only whole numbers make sense, whatever the type.
    whole: bool,
}

impl VariableInfo {
    /// Access to a row's scalar variable number `element` (from 0).
    pub const fn of(row: &Row, element: usize) -> Self {
        let value_type = match row.kind {
            Kind::Real(_) => ValueType::Real,
            Kind::Integer => ValueType::Integer,
            Kind::Boolean => ValueType::Boolean,
            Kind::Enumeration(_) => ValueType::Enumeration,
        };
        let (lower, upper) = row.bounds();
        let row_slots = if element == 0 { row.slots() as u32 } else { 0 };
        let whole = !matches!(row.kind, Kind::Real(_));
        VariableInfo {
            value_type,
            role: variable_role(row),
            row_slots,
            settable: settable_modes(row),
            lower,
            upper,
            whole,
        }
    }

    /// The same access through the functions for reals.
    const fn as_real(mut self) -> Self {
        self.value_type = ValueType::Real;
        self
    }

    /// Checks that `value` lies within the variable's range.
    #[inline]
    pub fn contains(&self, value: f64) -> bool {
        value >= self.lower && value <= self.upper
    }

    /// Checks that the variable accepts `value`. Rounding in a host must not end a simulation, so
    /// the model takes a real input beyond its range as the range's end. A fraction counts as the
    /// nearest whole number where only these make sense. A parameter has to be such a number.
    pub fn accepts(&self, value: f64) -> bool {
        let is_real_input = matches!((self.role, self.value_type), (Role::Input { .. }, ValueType::Real));
        self.contains(value) && (!self.whole || value.fract() == 0.0) || is_real_input && value.is_finite()
    }

    /// The end of the range that the model uses in place of `value`; `None` where the difference is
    /// not more than rounding.
    pub fn replacement(&self, value: f64) -> Option<f64> {
        // Rounding of a value, relative to its range.
        const RELATIVE_ROUNDING: f64 = 1e-9;
        let end = value.clamp(self.lower, self.upper);
        ((value - end).abs() > RELATIVE_ROUNDING * (self.upper - self.lower)).then_some(end)
    }
}

const fn variable_role(row: &Row) -> Role {
    let continuous = matches!(row.variability, Variability::Continuous) && matches!(row.kind, Kind::Real(_));
    match row.causality {
        Causality::Independent => Role::Time,
        Causality::Input => Role::Input { continuous },
        Causality::Output => Role::Output { continuous },
        Causality::Parameter => Role::Parameter,
    }
}

/// The modes in which the row's variables can be set. Inputs can be set before
/// initialization too, as tools do.
const fn settable_modes(row: &Row) -> Modes {
    match (row.causality, row.variability) {
        (Causality::Input, _) | (Causality::Parameter, Variability::Tunable) => {
            Modes::of(&[Mode::Instantiated, Mode::Initialization, Mode::StepComplete])
        }
        (Causality::Parameter, _) => Modes::of(&[Mode::Instantiated, Mode::Initialization]),
        (Causality::Independent | Causality::Output, _) => Modes::NONE,
    }
}

/// Access to every slot by the functions for reals.
pub(crate) const fn as_reals<const N: usize>(mut infos: [VariableInfo; N]) -> [VariableInfo; N] {
    let mut slot = 0;
    while slot < N {
        infos[slot] = infos[slot].as_real();
        slot += 1;
    }
    infos
}

/// Access to every slot. `N` is the number of slots.
pub(crate) const fn variable_infos<const N: usize>(identity: &Identity) -> [VariableInfo; N] {
    let mut infos = [VariableInfo::of(&identity.rows[0], 0); N];
    let mut slot = 0;
    while slot < N {
        let place = identity.slots[slot];
        infos[slot] = VariableInfo::of(&identity.rows[place.row as usize], place.element as usize);
        slot += 1;
    }
    infos
}
