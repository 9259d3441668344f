//! Names, units and axes of a recording's columns.
//!
//! Conventions are given by options, by a small TOML file with the same words, or by the name of a
//! logger's format. Options take precedence over the file, and the file over the format. Units in
//! the recording's header take precedence over the defaults.
//!
//! ```toml
//! axes = "forward-right-down"
//! force-unit = "g"
//! rate-unit = "deg/s"
//! [columns]
//! time = "t"
//! ax = "accel_x"
//! ```

mod choices;
pub mod formats;
mod mounting;
mod options;

use std::collections::BTreeMap;

use crate::message::{Remedy, given};
pub use crate::recording::columns::Quantity;
pub use crate::recording::columns::units::{
    AngleUnit, Dimension, ForceUnit, LengthUnit, RateUnit, SpeedUnit, TimeUnit, Unit,
};
pub(super) use choices::choices;
pub use choices::{Axes, EmptyFields, Frame, Gravity, Missing};
pub use formats::Format;
pub use mounting::Mounting;
pub use options::ConventionOptions;

/// Time over which commands fade recordings in from rest \[s\]: one that is cut out of a longer
/// recording begins in motion, and the platform at rest.
pub const FADE_IN: f64 = 1.0;

/// Names, units and axes of a recording, given or by default.
#[derive(Clone, Debug, PartialEq)]
pub struct Conventions {
    /// The logger's format that the others are of.
    pub format: Option<Format>,
    /// Column names that are not the keys.
    pub columns: BTreeMap<Quantity, String>,
    /// Units that are given; the header gives the others, or the defaults hold.
    pub units: BTreeMap<Dimension, Unit>,
    pub gravity: Gravity,
    pub axes: Axes,
    /// The sensor's orientation in the vehicle; none if its axes are the vehicle's.
    pub mounting: Option<Mounting>,
    pub rate_frame: Frame,
    pub force_frame: Frame,
    pub empty_fields: EmptyFields,
    pub missing: Missing,
    /// The lap that is read of several, from 1.
    pub lap: Option<usize>,
    /// Interpolates over error values and spikes.
    pub repair: bool,
    /// Samples a second of a recording without times \[1/s\].
    pub rate: Option<f64>,
    /// Samples a second to interpolate at \[1/s\].
    pub resample: Option<f64>,
    /// Time over which the recording is faded in from rest \[s\].
    pub fade_in: f64,
    /// True if the vehicle's position is needed.
    pub position: bool,
}

impl Default for Conventions {
    fn default() -> Self {
        ConventionOptions::default().conventions()
    }
}

impl Conventions {
    /// The same with the vehicle's position, if it is needed.
    pub fn with_position(self, is_needed: bool) -> Self {
        Conventions { position: self.position || is_needed, ..self }
    }

    /// The name of a quantity's column.
    pub fn column(&self, quantity: Quantity) -> &str {
        self.columns.get(&quantity).map_or(quantity.key(), String::as_str)
    }

    /// The column with the other sign.
    pub fn turned_column(&self, quantity: Quantity) -> String {
        let name = self.column(quantity);
        name.strip_prefix('-').map_or_else(|| format!("-{name}"), str::to_owned)
    }

    /// The remedy that reads quantities from the columns of others, by their keys: `-qx` is the one
    /// of qx with the other sign.
    pub fn columns_of(&self, keys: &[&str], quantities: &[Quantity]) -> Remedy {
        let column = |(quantity, key): (&Quantity, &&str)| {
            let of = |key: &str| Quantity::of_key(key).unwrap_or(*quantity);
            let name = match key.strip_prefix('-') {
                Some(key) => self.turned_column(of(key)),
                None => self.column(of(key)).to_owned(),
            };
            format!("{}={name}", quantity.key())
        };
        given("columns", quantities.iter().zip(keys).map(column).collect::<Vec<_>>().join(","))
    }

    /// The remedy that scales columns: `scale` stands behind each name.
    pub fn scaled(&self, quantities: &[Quantity], scale: &str) -> Remedy {
        let scaled = |&quantity: &Quantity| format!("{}={} {scale}", quantity.key(), self.column(quantity));
        given("columns", format!("\"{}\"", quantities.iter().map(scaled).collect::<Vec<_>>().join(",")))
    }

    /// True for a quantity that a recording must have.
    pub fn needs(&self, quantity: Quantity) -> bool {
        let has_rate = quantity == Quantity::Time && self.rate.is_some();
        let is_required = quantity.is_required() || self.position && matches!(quantity, Quantity::Position(_));
        is_required && !self.is_at_rest(quantity) && !has_rate
    }

    /// True for a quantity that a recording must have, or whose column is named.
    pub fn expects(&self, quantity: Quantity) -> bool {
        // Speed, angles and positions help formats that have them, and no format needs them.
        let is_of_format =
            |name: &String| self.format.is_some_and(|format| format.column(quantity).as_ref() == Some(name));
        let is_named = self.columns.get(&quantity).is_some_and(|name| !is_of_format(name));
        self.needs(quantity) || is_named && !quantity.is_required()
    }

    /// True for a quantity that is as at rest where a recording lacks it. A turned
    /// sensor's is not known.
    fn is_at_rest(&self, quantity: Quantity) -> bool {
        let is_known = match quantity {
            Quantity::Rate(_) => self.mounting != Some(Mounting::Auto),
            Quantity::Force(axis) => axis > 0 && self.mounting.is_none(),
            _ => false,
        };
        is_known && self.missing == Missing::Rest
    }

    /// The unit that is given for a dimension.
    pub fn unit(&self, dimension: Dimension) -> Option<Unit> {
        self.units.get(&dimension).copied()
    }
}
