//! Units, what they are made of, and how a user may like them shown.

use serde::{Deserialize, Serialize};

/// `Unit`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unit {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "BaseUnit")]
    pub base_unit: BaseUnit,
    #[serde(rename = "DisplayUnit", skip_serializing_if = "Option::is_none")]
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
        Unit { name: unit.name.to_owned(), base_unit: BaseUnit { kg, m, s, rad }, display_unit: display_unit(unit) }
    }
}

/// Degrees for angles; none for the rest, for filters' break frequencies are given in rad/s and share that unit with
/// angular velocities.
pub fn display_unit(unit: &moris_interface::Unit) -> Option<DisplayUnit> {
    (unit.name == "rad").then(|| DisplayUnit { name: "deg".to_owned(), factor: 180.0 / std::f64::consts::PI })
}

// serde hands a reference over.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_zero(exponent: &i8) -> bool {
    *exponent == 0
}
