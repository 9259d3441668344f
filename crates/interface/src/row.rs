//! A row of the interface: one field of a struct, one or several scalar variables.

use crate::Unit;

/// Who sets a variable (FMI 2.0, 2.2.7).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Causality {
    Independent,
    Input,
    Output,
    Parameter,
}

/// When a variable may change (FMI 2.0, 2.2.7).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Variability {
    Continuous,
    Discrete,
    Tunable,
    Fixed,
}

/// What a variable's values are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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
/// In `name`, `#` stands for the 1-based index of an array and `@` for the component: `rig.base[#].@` with `count` 6
/// and components x, y, z is eighteen variables, `rig.base[1].x` to `rig.base[6].z`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    pub name: &'static str,
    pub causality: Causality,
    pub variability: Variability,
    pub kind: Kind,
    /// Elements of the array; 1 for a row that is none.
    pub count: usize,
    /// Components of an element: `["x", "y", "z"]`, say, or `[""]`.
    pub components: &'static [&'static str],
    /// The smallest and the largest value allowed, both inclusive.
    pub range: Option<(f64, f64)>,
    text: &'static str,
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
        // Only reals are continuous; booleans and whole numbers among them are discrete.
        let variability = match (kind, variability) {
            (Kind::Boolean | Kind::Integer | Kind::Enumeration(_), Variability::Continuous) => Variability::Discrete,
            (_, variability) => variability,
        };
        Row { name, causality, variability, kind, count, components, range, text }
    }

    /// How many scalar variables the row is.
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

    /// The name of the row as one array variable: the template without its places for index and component.
    pub fn array_name(&self) -> String {
        self.name.replace("[#]", "").replace(".@", "")
    }
}

/// How many rows the groups have together.
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
