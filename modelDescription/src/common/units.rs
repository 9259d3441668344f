//! Units that a model's variables have.

use moris_interface::{Identity, Kind, Unit};

use super::xml::Element;

/// Exponents of the SI base units that are not zero.
pub fn exponents(unit: &Unit) -> impl Iterator<Item = (&'static str, i8)> {
    let base = unit.base;
    [("kg", base.kg), ("m", base.m), ("s", base.s), ("rad", base.rad)].into_iter().filter(|&(_, power)| power != 0)
}

/// Adds the name of the unit for display.
pub(crate) fn with_display(element: Element, unit: &Unit) -> Element {
    element.with_some("displayUnit", unit.display.map(|display| display.name))
}

/// Adds the nominal value; none where it is 1, which is the standard's default.
pub(crate) fn with_nominal(element: Element, unit: &Unit) -> Element {
    element.with_some("nominal", (unit.nominal != 1.0).then_some(unit.nominal))
}

/// Every unit that a row has, once for each quantity, in the order in which they appear.
pub fn units(identity: &Identity) -> Vec<&'static Unit> {
    let mut found: Vec<&Unit> = Vec::new();
    for row in identity.rows {
        if let Kind::Real(unit) = row.kind
            && !unit.name.is_empty()
            && !found.contains(&unit)
        {
            found.push(unit);
        }
    }
    found
}
