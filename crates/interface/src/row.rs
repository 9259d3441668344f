//! A row of the interface: one field of a struct, one or several scalar variables.

use alloc::{
    borrow::ToOwned,
    format,
    string::{String, ToString},
    vec,
    vec::Vec,
};
use core::ops::RangeInclusive;

use crate::shown::{Shown, shown};
use crate::{Field, ParameterError, Unit};

/// The side that sets a variable (FMI 2.0, 2.2.7).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Causality {
    Independent,
    Input,
    Output,
    Parameter,
}

impl Causality {
    /// The name in a model description.
    pub const fn name(self) -> &'static str {
        match self {
            Causality::Independent => "independent",
            Causality::Input => "input",
            Causality::Output => "output",
            Causality::Parameter => "parameter",
        }
    }
}

/// When a variable may change (FMI 2.0, 2.2.7).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Variability {
    Continuous,
    Discrete,
    Tunable,
    Fixed,
}

impl Variability {
    /// The name in a model description.
    pub const fn name(self) -> &'static str {
        match self {
            Variability::Continuous => "continuous",
            Variability::Discrete => "discrete",
            Variability::Tunable => "tunable",
            Variability::Fixed => "fixed",
        }
    }
}

/// Type of a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Real(&'static Unit),
    Integer,
    Boolean,
    Enumeration(&'static Enumeration),
}

impl Kind {
    /// The kind with the unit that a row names; only reals have one.
    pub const fn in_unit(self, unit: &'static Unit) -> Self {
        match self {
            Kind::Real(_) => Kind::Real(unit),
            other => other,
        }
    }
}

/// An enumeration; its items count from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Enumeration {
    pub name: &'static str,
    pub text: &'static str,
    pub items: &'static [Item],
}

/// One choice of an enumeration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Item {
    pub name: &'static str,
    pub text: &'static str,
}

/// One line of the interface.
///
/// In `name`, `#` stands for the 1-based index of an array and `@` for the component. For example,
/// `rig.base[#].@` with `count` 6 and components x, y, z is eighteen variables,
/// `rig.base[1].x` to `rig.base[6].z`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    pub name: &'static str,
    pub causality: Causality,
    pub variability: Variability,
    pub kind: Kind,
    /// Number of elements of the array; 1 for a row that is not an array.
    pub count: usize,
    /// Components of an element: `["x", "y", "z"]`, say, or `[""]`.
    pub components: &'static [&'static str],
    /// The smallest and the largest value allowed, both inclusive. An input beyond them counts as
    /// the nearer one. For other variables such values are rejected.
    pub range: Option<(f64, f64)>,
    text: &'static str,
    /// The smallest and the largest value of practice: the ends of sliders and of searches.
    pub usual: Option<(f64, f64)>,
    /// Name of the group of rows that a search changes together.
    pub tuning_group: Option<&'static str>,
    /// Heading below which people find the row. Rows without one are found by name.
    pub heading: Option<&'static str>,
    /// Rank among the parameters that matter most, from 1. Descriptions list them first.
    pub importance_rank: Option<u8>,
    conditions: [Option<Condition>; 2],
    /// Beginnings of the names of inputs and parameters on which an output depends before the first
    /// step; `None`: on all of them.
    start_knowns: Option<&'static [&'static str]>,
}

/// A condition without which a row has no effect: another variable has one of these values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Name of the other variable.
    pub variable: &'static str,
    /// Items of its enumeration, or whole numbers.
    pub values: &'static [&'static str],
    /// Components of the row that depend on it.
    components: &'static [&'static str],
}

impl Condition {
    /// True for the same variable and values.
    pub fn is_same(&self, other: &Self) -> bool {
        (self.variable, self.values) == (other.variable, other.values)
    }
}

impl Row {
    #[doc(hidden)] // for `interface!`
    #[allow(clippy::too_many_arguments)]
    pub const fn new(
        name: &'static str,
        causality: Causality,
        variability: Variability,
        kind: Kind,
        count: usize,
        components: &'static [&'static str],
        range: Option<(f64, f64)>,
        text: &'static str,
    ) -> Self {
        // Only reals are continuous. Booleans, integers and enumerations are discrete instead.
        let variability = match (kind, variability) {
            (Kind::Boolean | Kind::Integer | Kind::Enumeration(_), Variability::Continuous) => Variability::Discrete,
            (_, variability) => variability,
        };
        let (usual, tuning_group, heading, importance_rank, conditions, start_knowns) =
            (None, None, None, None, [None; 2], None);
        Row {
            name,
            causality,
            variability,
            kind,
            count,
            components,
            range,
            text,
            usual,
            tuning_group,
            heading,
            importance_rank,
            conditions,
            start_knowns,
        }
    }

    /// The row with this usual range.
    ///
    /// # Panics
    /// The range exceeds the row's. In a constant this is a compile error.
    pub const fn usual(mut self, range: RangeInclusive<f64>) -> Self {
        let (least, greatest) = self.bounds();
        assert!(least <= *range.start() && *range.start() < *range.end() && *range.end() <= greatest);
        self.usual = Some((*range.start(), *range.end()));
        self
    }

    /// The row as one of a group that a search changes together.
    pub const fn tuning_group(mut self, name: &'static str) -> Self {
        self.tuning_group = Some(name);
        self
    }

    /// The row below a heading.
    pub const fn heading(mut self, heading: &'static str) -> Self {
        self.heading = Some(heading);
        self
    }

    /// The row at this rank among the parameters that matter most.
    pub const fn importance_rank(mut self, rank: u8) -> Self {
        self.importance_rank = Some(rank);
        self
    }

    /// The row of an output that depends, before the first step, on inputs and parameters
    /// alone whose names begin with one of these. What a row itself says counts before
    /// what its struct says.
    pub const fn start_depends_on(mut self, names: &'static [&'static str]) -> Self {
        if self.start_knowns.is_none() {
            self.start_knowns = Some(names);
        }
        self
    }

    /// True if this output depends on the other row's input or parameter before the first step.
    pub fn starts_depending_on(&self, other: &Row) -> bool {
        matches!(other.causality, Causality::Input | Causality::Parameter)
            && self.start_knowns.is_none_or(|names| names.iter().any(|name| other.name.starts_with(name)))
    }

    /// The row with a condition of its effect: `variable` has one of `values`.
    pub const fn used_if(self, variable: &'static str, values: &'static [&'static str]) -> Self {
        let components = self.components;
        self.partly_used_if(components, variable, values)
    }

    /// The row with a condition of the effect of some of its components.
    ///
    /// # Panics
    /// The row has two conditions already.
    pub const fn partly_used_if(
        mut self,
        components: &'static [&'static str],
        variable: &'static str,
        values: &'static [&'static str],
    ) -> Self {
        assert!(self.conditions[1].is_none());
        self.conditions = [Some(Condition { variable, values, components }), self.conditions[0]];
        self
    }

    /// The conditions without which the row's scalar variable number `element` has no effect; those
    /// of its struct first.
    pub fn conditions(&self, element: usize) -> impl Iterator<Item = &Condition> {
        let component = self.components[element % self.components.len()];
        self.conditions.iter().flatten().filter(move |condition| condition.components.contains(&component))
    }

    /// The smallest and the largest value; those of the type where the row has no range. NaN and
    /// the infinities are never within them.
    pub const fn bounds(&self) -> (f64, f64) {
        match (self.range, self.kind) {
            (Some(range), _) => range,
            (None, Kind::Real(_)) => (f64::MIN, f64::MAX),
            (None, Kind::Integer) => (i32::MIN as f64, i32::MAX as f64),
            (None, Kind::Boolean) => (0.0, 1.0),
            (None, Kind::Enumeration(enumeration)) => (1.0, enumeration.items.len() as f64),
        }
    }

    /// True for a value that is finite and within the row's range.
    pub fn accepts(&self, value: f64) -> bool {
        let (min, max) = self.bounds();
        (min..=max).contains(&value)
    }

    /// The reason why the row's scalar variable cannot have this value, as text
    /// that follows its name.
    pub fn reason(&self, value: f64) -> String {
        let expected = match (self.kind, self.range) {
            (Kind::Enumeration(enumeration), _) => {
                let items = enumeration.items.iter().zip(1..);
                let items: Vec<_> = items.map(|(item, number)| format!("{number} ({})", item.name)).collect();
                format!("one of {}", items.join(", "))
            }
            (Kind::Boolean, _) => "0 or 1".to_owned(),
            (_, None) => "a finite number".to_owned(),
            (kind, Some((min, max))) => {
                let number = match kind {
                    _ if !value.is_finite() => "a finite number ",
                    Kind::Integer if value % 1.0 != 0.0 => "a whole number ",
                    _ => "",
                };
                format!("{number}from {} to {}", Shown(min), Shown(max))
            }
        };
        let hint = self.degrees_hint(value, self.usual.or(self.range).unwrap_or_default());
        format!("is {}, but must be {expected}{hint}", Shown(value))
    }

    /// True for a value beyond the usual range. 0 switches off, and is usual.
    pub fn is_unusual(&self, value: f64) -> bool {
        self.usual.is_some_and(|(least, greatest)| value != 0.0 && !(least..=greatest).contains(&value))
    }

    /// A sentence about the row's scalar variable of this name, if its value is beyond the usual
    /// range.
    pub fn unusual_value(&self, name: &str, value: f64) -> Option<String> {
        let (least, greatest) = self.usual.filter(|_| self.is_unusual(value))?;
        let Kind::Real(unit) = self.kind else { return None };
        let with_unit = |value: f64| [shown(value).as_str(), unit.name].join(" ").trim_end().to_owned();
        Some(format!(
            "{name} is {}, but the usual range is {} to {}{}",
            with_unit(value),
            Shown(least),
            with_unit(greatest),
            self.degrees_hint(value, (least, greatest))
        ))
    }

    /// The end of a message about a value that would be within `range` if it were in degrees;
    /// otherwise empty.
    pub fn degrees_hint(&self, value: f64, (least, greatest): (f64, f64)) -> String {
        let in_radians = value.to_radians();
        match self.kind {
            Kind::Real(unit) if unit.name.starts_with("rad") && (least..=greatest).contains(&in_radians) => {
                format!("; in degrees it would be {} {}", Shown(four_decimals(in_radians)), unit.name)
            }
            _ => String::new(),
        }
    }

    /// The error about the first scalar variable of a field that is outside the row's range.
    #[doc(hidden)] // for `interface!`
    #[cold]
    pub fn range_error<F: Field>(&self, field: F) -> ParameterError {
        let mut slots = vec![0.0; self.slots()];
        field.write(&mut slots);
        let element = slots.iter().position(|&value| !self.accepts(value)).unwrap_or(0);
        ParameterError { variable: self.variable_name(element), reason: self.reason(slots[element]) }
    }

    /// Number of scalar variables in the row.
    pub const fn slots(&self) -> usize {
        self.count * self.components.len()
    }

    /// The sentence that describes the row.
    pub fn text(&self) -> &'static str {
        self.text.trim()
    }

    /// The name of the row's scalar variable number `element` (from 0).
    pub fn variable_name(&self, element: usize) -> String {
        let index = element / self.components.len() + 1;
        let component = self.components[element % self.components.len()];
        self.name.replace('#', &index.to_string()).replace('@', component)
    }

    /// The name of the row as one array variable: the template without the placeholders
    /// for index and component.
    pub fn array_name(&self) -> String {
        self.name.replace("[#]", "").replace(".@", "")
    }
}

/// A value to four digits behind the point.
pub fn four_decimals(value: f64) -> f64 {
    libm::round(1e4 * value) / 1e4
}

/// The smallest and the largest value of the row of this name.
///
/// # Panics
/// If no row has this name. In a constant this is a compile error.
pub const fn bounds_of(rows: &[Row], name: &str) -> (f64, f64) {
    let mut r = 0;
    while r < rows.len() {
        if is_same(rows[r].name.as_bytes(), name.as_bytes()) {
            return rows[r].bounds();
        }
        r += 1;
    }
    panic!("no row has this name")
}

/// The rows, with those of these names made tunable and given these [ranks](Row::importance_rank).
/// For a model that reuses another model's struct but can change more of its parameters in flight.
///
/// # Panics
/// If no row has one of the names. In a constant this is a compile error.
pub const fn with_tunable<const N: usize>(mut rows: [Row; N], names: &[(&str, u8)]) -> [Row; N] {
    let mut n = 0;
    while n < names.len() {
        let mut r = 0;
        while !is_same(rows[r].name.as_bytes(), names[n].0.as_bytes()) {
            r += 1;
        }
        rows[r].variability = Variability::Tunable;
        rows[r].importance_rank = Some(names[n].1);
        n += 1;
    }
    rows
}

/// `==` for a constant.
const fn is_same(a: &[u8], b: &[u8]) -> bool {
    let mut k = 0;
    while k < a.len() && k < b.len() && a[k] == b[k] {
        k += 1;
    }
    k == a.len() && k == b.len()
}

/// Total number of rows of the groups.
pub const fn row_count(groups: &[&[Row]]) -> usize {
    let mut count = 0;
    let mut g = 0;
    while g < groups.len() {
        count += groups[g].len();
        g += 1;
    }
    count
}

/// The groups' rows, one after another. `N` is [`row_count`] of them.
pub const fn concat_rows<const N: usize>(groups: &[&[Row]]) -> [Row; N] {
    let mut rows = [groups[0][0]; N];
    let (mut g, mut n) = (0, 0);
    while g < groups.len() {
        let mut k = 0;
        while k < groups[g].len() {
            rows[n] = groups[g][k];
            n += 1;
            k += 1;
        }
        g += 1;
    }
    rows
}
