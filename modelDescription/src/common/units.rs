//! Units, what they are made of, and how a user may like them shown.

use moris_interface::{Identity, Kind};
use serde::{Deserialize, Serialize};

/// `Unit`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unit {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "BaseUnit")]
    pub base_unit: BaseUnit,
    #[serde(rename = "DisplayUnit", default, skip_serializing_if = "Option::is_none")]
    pub display_unit: Option<DisplayUnit>,
}

/// `BaseUnit`: exponents of the SI base units; those that are zero are left out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BaseUnit {
    #[serde(rename = "@kg", skip_serializing_if = "is_zero")]
    pub kg: i8,
    #[serde(rename = "@m", skip_serializing_if = "is_zero")]
    pub m: i8,
    #[serde(rename = "@s", skip_serializing_if = "is_zero")]
    pub s: i8,
    #[serde(rename = "@rad", skip_serializing_if = "is_zero")]
    pub rad: i8,
}

/// `DisplayUnit`: a value in it is `factor` times the value in the unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DisplayUnit {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@factor")]
    pub factor: f64,
}

impl From<&moris_interface::Unit> for Unit {
    fn from(unit: &moris_interface::Unit) -> Self {
        let moris_interface::BaseUnit { kg, m, s, rad } = unit.base;
        let display_unit =
            unit.display.map(|display| DisplayUnit { name: display.name.to_owned(), factor: display.factor });
        Unit { name: unit.name.to_owned(), base_unit: BaseUnit { kg, m, s, rad }, display_unit }
    }
}

/// Unit and quantity of a real variable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RealAttributes {
    pub quantity: Option<String>,
    /// None: dimensionless.
    pub unit: Option<String>,
    pub display_unit: Option<String>,
    /// None: 1, which is the standard's default.
    pub nominal: Option<f64>,
}

impl From<&moris_interface::Unit> for RealAttributes {
    fn from(unit: &moris_interface::Unit) -> Self {
        let text = |text: &str| (!text.is_empty()).then(|| text.to_owned());
        RealAttributes {
            quantity: text(unit.quantity),
            unit: text(unit.name),
            display_unit: unit.display.map(|display| display.name.to_owned()),
            nominal: (unit.nominal != 1.0).then_some(unit.nominal),
        }
    }
}

/// Every unit that a row has, once for each quantity, in the order in which they appear.
pub fn units(identity: &Identity) -> Vec<&'static moris_interface::Unit> {
    let mut found: Vec<&moris_interface::Unit> = Vec::new();
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

// serde hands a reference over.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_zero(exponent: &i8) -> bool {
    *exponent == 0
}
