//! Expected state of an instance after the calls so far: a second, simple model of the standard.

use moris_interface::{Causality, Identity, Kind, Model, SlotModel, Variability};
use moris_washout::Washout;

use crate::{standard2, standard3};

pub const IDENTITY: Identity = Washout::IDENTITY;

/// Status of a call, the same numbers in both versions.
pub const OK: i32 = 0;
pub const DISCARD: i32 = 2;
pub const ERROR: i32 = 3;

/// Expected state of an instance.
#[derive(Clone, Debug, PartialEq)]
pub struct Expected {
    /// The state, by the letter that it has in the calling sequences.
    pub state: char,
    /// Start and stop time, once they are set up \[s\].
    pub experiment: Option<(f64, f64)>,
    /// The present communication point \[s\].
    pub time: f64,
    /// The values of all variables; those of the outputs are not checked.
    pub values: Vec<f64>,
    /// Length and velocity of the legs after the last step, where it is known.
    pub legs: Option<([f64; 6], [f64; 6])>,
}

impl Expected {
    /// A fresh instance.
    pub fn fresh() -> Self {
        let mut values = vec![0.0; IDENTITY.slots.len()];
        Washout::start_slots(&mut values);
        Expected { state: 'I', experiment: None, time: 0.0, values, legs: None }
    }

    /// True if the function is allowed now.
    pub fn allows(&self, function: &str) -> bool {
        let mut rows = standard2::CALLING_SEQUENCE.iter().chain(standard3::CALLING_SEQUENCE);
        let (_, states) = rows.find(|(name, _)| *name == function).expect(function);
        states.contains(if function.starts_with("fmi3") && self.state == 'C' { 'S' } else { self.state })
    }

    /// True if the variable can be set now, by the rule of the standard.
    pub fn settable(&self, slot: usize) -> bool {
        let row = IDENTITY.row(slot);
        match (row.causality, row.variability) {
            (Causality::Input, _) | (Causality::Parameter, Variability::Tunable) => "INC".contains(self.state),
            (Causality::Parameter, _) => "IN".contains(self.state),
            _ => false,
        }
    }

    /// True if the variable can be set to this value now: while steps are made, a fixed parameter
    /// to the one that it has.
    pub fn takes(&self, slot: usize, value: f64) -> bool {
        let repeated = || IDENTITY.row(slot).causality == Causality::Parameter && value == self.values[slot];
        self.settable(slot) || self.state == 'C' && repeated()
    }

    /// The value of the variable of this name.
    pub fn value(&self, name: &str) -> f64 {
        self.values[slot(name)]
    }

    /// True if all parameters have their start values.
    pub fn has_start_parameters(&self) -> bool {
        let fresh = Self::fresh();
        (0..self.values.len())
            .all(|slot| IDENTITY.row(slot).causality != Causality::Parameter || self.values[slot] == fresh.values[slot])
    }
}

/// The slot of the variable of this name.
pub fn slot(name: &str) -> usize {
    IDENTITY.slot(name).expect(name)
}

/// True if the host sets the variable.
pub fn is_set_by_host(slot: usize) -> bool {
    matches!(IDENTITY.row(slot).causality, Causality::Input | Causality::Parameter)
}

/// The type of a variable. FMI 2.0 has its enumerations set and read as integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    Real,
    Integer,
    Boolean,
    Enumeration,
}

impl Type {
    /// The type of a slot's variable.
    pub fn of(slot: usize) -> Type {
        match IDENTITY.row(slot).kind {
            Kind::Real(_) => Type::Real,
            Kind::Boolean => Type::Boolean,
            Kind::Integer => Type::Integer,
            Kind::Enumeration(_) => Type::Enumeration,
        }
    }
}

/// True if the variable accepts this value: an input to any finite one, for beyond its range
/// it counts as the end.
pub fn admits(slot: usize, value: f64) -> bool {
    let row = IDENTITY.row(slot);
    let any = row.causality == Causality::Input && matches!(row.kind, Kind::Real(_));
    if any { value.is_finite() } else { row.accepts(value) }
}
