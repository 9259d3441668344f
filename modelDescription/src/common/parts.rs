//! Small parts of the file that are the same in FMI 2.0 and 3.0.

use moris_interface::Identity;
use serde::{Deserialize, Serialize};

use super::units::{self, Unit};

/// `UnitDefinitions`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UnitDefinitions {
    #[serde(rename = "Unit")]
    pub units: Vec<Unit>,
}

/// `LogCategories`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LogCategories {
    #[serde(rename = "Category")]
    pub categories: Vec<Category>,
}

/// A kind of message that a host can ask for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Category {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@description")]
    pub description: String,
}

/// `DefaultExperiment`: what a host runs when its user says nothing; times in seconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DefaultExperiment {
    #[serde(rename = "@startTime")]
    pub start_time: f64,
    #[serde(rename = "@stopTime")]
    pub stop_time: f64,
    #[serde(rename = "@tolerance")]
    pub tolerance: f64,
    #[serde(rename = "@stepSize")]
    pub step_size: f64,
}

/// Relative tolerance for tools that ask for one. The models step without error control: runs with
/// different communication steps agree to this.
const TOLERANCE: f64 = 1e-3;

impl UnitDefinitions {
    /// Every unit that a row has, once, in the order in which they appear; with the unit for
    /// display that any of these rows has. None without units.
    pub fn of(identity: &Identity) -> Option<Self> {
        let mut units: Vec<Unit> = Vec::new();
        for unit in units::units(identity).into_iter().map(Unit::from) {
            match units.iter_mut().find(|known| known.name == unit.name) {
                Some(known) => known.display_unit = known.display_unit.take().or(unit.display_unit),
                None => units.push(unit),
            }
        }
        (!units.is_empty()).then_some(UnitDefinitions { units })
    }
}

impl LogCategories {
    /// From pairs of a name and a description.
    pub fn of<'a>(categories: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        let category =
            |(name, description): (&str, &str)| Category { name: name.to_owned(), description: description.to_owned() };
        LogCategories { categories: categories.into_iter().map(category).collect() }
    }
}

impl From<&Identity> for DefaultExperiment {
    fn from(identity: &Identity) -> Self {
        DefaultExperiment {
            start_time: 0.0,
            stop_time: identity.stop_time,
            tolerance: TOLERANCE,
            step_size: identity.step_size,
        }
    }
}
