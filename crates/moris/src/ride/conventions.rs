//! Names, units and axes of a recording's columns.
//!
//! They are given by options, by a small TOML file with the same words, or by both: options take
//! precedence over the file. Units in the recording's header take precedence over the defaults.
//!
//! ```toml
//! axes = "forward-right-down"
//! force-unit = "g"
//! rate-unit = "deg/s"
//! [columns]
//! time = "t"
//! ax = "accel_x"
//! ```

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

use clap::ValueEnum;
use moris_washout::interface::AngularVelocityFrame;
use serde::Deserialize;

use super::RideError;
use super::units::choices;
pub use super::units::{AngleUnit, Dimension, ForceUnit, RateUnit, SpeedUnit, TimeUnit, Unit};

/// A quantity that a recording may hold, by the key under which its column is named.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    Time,
    Force(usize),
    Rate(usize),
    Angle(usize),
    Speed,
    Lean,
}

impl Quantity {
    /// Every quantity with its key, which is also its column's name unless another is given.
    pub const ALL: [(Quantity, &'static str); 12] = [
        (Quantity::Time, "time"),
        (Quantity::Force(0), "ax"),
        (Quantity::Force(1), "ay"),
        (Quantity::Force(2), "az"),
        (Quantity::Rate(0), "wx"),
        (Quantity::Rate(1), "wy"),
        (Quantity::Rate(2), "wz"),
        (Quantity::Angle(0), "roll"),
        (Quantity::Angle(1), "pitch"),
        (Quantity::Angle(2), "yaw"),
        (Quantity::Speed, "speed"),
        (Quantity::Lean, "lean"),
    ];

    /// True for time, specific force and rates, which every recording must have.
    pub fn is_required(self) -> bool {
        matches!(self, Quantity::Time | Quantity::Force(_) | Quantity::Rate(_))
    }

    /// The dimension of its units.
    pub fn dimension(self) -> Dimension {
        match self {
            Quantity::Time => Dimension::Time,
            Quantity::Force(_) => Dimension::Force,
            Quantity::Rate(_) => Dimension::Rate,
            Quantity::Angle(_) | Quantity::Lean => Dimension::Angle,
            Quantity::Speed => Dimension::Speed,
        }
    }

    /// The quantity's key.
    pub fn key(self) -> &'static str {
        let found = Self::ALL.iter().find(|(quantity, _)| *quantity == self);
        found.map_or("", |(_, key)| key)
    }
}

choices! {
    /// Presence of gravity's reaction in the accelerations.
    Gravity {
        /// Gravity's reaction is in: (0, 0, +9.81) at rest, what an accelerometer reads
        "included" Included,
        /// Gravity has been taken out: (0, 0, 0) at rest
        "removed" Removed,
    }
}

choices! {
    /// Directions of x, y and z.
    Axes {
        /// x forward, y left, z up (ISO 8855)
        "forward-left-up" ForwardLeftUp,
        /// x forward, y right, z down (aviation, SAE J670)
        "forward-right-down" ForwardRightDown,
    }
}

choices! {
    /// The axes in which the angular velocity is given.
    RateFrame {
        /// The vehicle's own: what gyroscopes measure
        "body" Body,
        /// The world's
        "world" World,
    }
}

impl Axes {
    /// Factors that turn x, y and z into x forward, y left, z up.
    pub fn signs(self) -> [f64; 3] {
        match self {
            Axes::ForwardLeftUp => [1.0, 1.0, 1.0],
            Axes::ForwardRightDown => [1.0, -1.0, -1.0],
        }
    }
}

impl From<RateFrame> for AngularVelocityFrame {
    fn from(frame: RateFrame) -> Self {
        match frame {
            RateFrame::Body => AngularVelocityFrame::Body,
            RateFrame::World => AngularVelocityFrame::World,
        }
    }
}

/// Options that describe a recording.
#[derive(Clone, Debug, Default, PartialEq, clap::Args, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
#[command(next_help_heading = "Columns of the recording")]
pub struct ConventionOptions {
    /// Names of columns that are not called time, ax ay az, wx wy wz (and, where there are any,
    /// roll pitch yaw, speed, lean): time=t,ax=accel_x. Upper and lower case are the same
    #[arg(long, value_name = "KEY=NAME", value_delimiter = ',', value_parser = column_name)]
    #[serde(deserialize_with = "columns_of_table")]
    pub columns: Vec<(Quantity, String)>,

    /// Unit of time [default: the header's, otherwise s]
    #[arg(long, value_name = "UNIT")]
    pub time_unit: Option<TimeUnit>,

    /// Unit of ax ay az [default: the header's, otherwise m/s2]
    #[arg(long, value_name = "UNIT")]
    pub force_unit: Option<ForceUnit>,

    /// Unit of wx wy wz [default: the header's, otherwise rad/s]
    #[arg(long, value_name = "UNIT")]
    pub rate_unit: Option<RateUnit>,

    /// Unit of roll pitch yaw and lean [default: the header's, otherwise rad]
    #[arg(long, value_name = "UNIT")]
    pub angle_unit: Option<AngleUnit>,

    /// Unit of speed [default: the header's, otherwise m/s]
    #[arg(long, value_name = "UNIT")]
    pub speed_unit: Option<SpeedUnit>,

    /// Presence of gravity's reaction in ax ay az, as an accelerometer reads it [default: included]
    #[arg(long, value_name = "GRAVITY")]
    pub gravity: Option<Gravity>,

    /// Directions of x, y and z [default: forward-left-up]
    #[arg(long, value_name = "AXES")]
    pub axes: Option<Axes>,

    /// The axes of wx wy wz [default: body]
    #[arg(long, value_name = "AXES")]
    pub rate_frame: Option<RateFrame>,

    /// Interpolate linearly at this rate a recording whose samples do not come at equal steps
    #[arg(long, value_name = "HERTZ")]
    pub resample: Option<f64>,

    /// Fade in a recording that does not begin at rest, over this time
    #[arg(long, value_name = "SECONDS")]
    pub fade_in: Option<f64>,

    /// TOML file with these options by the same names (force-unit = "g"), the names of
    /// columns under columns
    #[arg(long, value_name = "FILE")]
    #[serde(skip)]
    pub conventions: Option<PathBuf>,
}

/// Names, units and axes of a recording, given or by default.
#[derive(Clone, Debug, PartialEq)]
pub struct Conventions {
    /// Column names that are not the keys.
    pub columns: BTreeMap<Quantity, String>,
    /// Units that are given; the header gives the others, or the defaults hold.
    pub units: BTreeMap<Dimension, Unit>,
    pub gravity: Gravity,
    pub axes: Axes,
    pub rate_frame: RateFrame,
    /// Samples a second to interpolate at \[1/s\].
    pub resample: Option<f64>,
    /// Time over which the recording is faded in from rest \[s\].
    pub fade_in: f64,
}

impl Default for Conventions {
    fn default() -> Self {
        ConventionOptions::default().conventions()
    }
}

impl Conventions {
    /// The name of a quantity's column.
    pub fn column(&self, quantity: Quantity) -> &str {
        self.columns.get(&quantity).map_or(quantity.key(), String::as_str)
    }

    /// The unit that is given for a dimension.
    pub fn unit(&self, dimension: Dimension) -> Option<Unit> {
        self.units.get(&dimension).copied()
    }
}

impl ConventionOptions {
    /// The conventions: the options' over the file's over the defaults.
    ///
    /// # Errors
    /// The file cannot be read or has an unknown word or value.
    pub fn load(&self) -> Result<Conventions, RideError> {
        self.load_or_fade_in(0.0)
    }

    /// The conventions, with a time to fade recordings in where neither the options nor
    /// the file give one \[s\].
    ///
    /// # Errors
    /// As [`ConventionOptions::load`].
    pub fn load_or_fade_in(&self, fade_in: f64) -> Result<Conventions, RideError> {
        let given = self.with_file()?;
        ConventionOptions { fade_in: given.fade_in.or(Some(fade_in)), ..given }.checked()
    }

    /// The options over the file's, if there is one.
    fn with_file(&self) -> Result<ConventionOptions, RideError> {
        let Some(file) = &self.conventions else { return Ok(self.clone()) };
        let text = fs::read_to_string(file).map_err(|reason| RideError::Read { file: file.clone(), reason })?;
        let given: ConventionOptions = toml::from_str(&text)
            .map_err(|error| RideError::Conventions { file: file.clone(), reason: error.to_string() })?;
        Ok(self.over(given))
    }

    /// These options over others.
    fn over(&self, under: ConventionOptions) -> ConventionOptions {
        let columns = under.columns.into_iter().chain(self.columns.iter().cloned()).collect();
        ConventionOptions {
            columns,
            time_unit: self.time_unit.or(under.time_unit),
            force_unit: self.force_unit.or(under.force_unit),
            rate_unit: self.rate_unit.or(under.rate_unit),
            angle_unit: self.angle_unit.or(under.angle_unit),
            speed_unit: self.speed_unit.or(under.speed_unit),
            gravity: self.gravity.or(under.gravity),
            axes: self.axes.or(under.axes),
            rate_frame: self.rate_frame.or(under.rate_frame),
            resample: self.resample.or(under.resample),
            fade_in: self.fade_in.or(under.fade_in),
            conventions: self.conventions.clone(),
        }
    }

    fn checked(&self) -> Result<Conventions, RideError> {
        let allowed = [
            ("resample", self.resample, 1.0..=1e5, "samples a second"),
            ("fade-in", self.fade_in, 0.0..=1e3, "seconds"),
        ];
        for (name, given, range, unit) in allowed {
            if let Some(value) = given.filter(|value| !range.contains(value)) {
                return Err(RideError::Option { name, value, min: *range.start(), max: *range.end(), unit });
            }
        }
        Ok(self.conventions())
    }

    fn conventions(&self) -> Conventions {
        let units = [
            (Dimension::Time, self.time_unit.map(TimeUnit::unit)),
            (Dimension::Force, self.force_unit.map(ForceUnit::unit)),
            (Dimension::Rate, self.rate_unit.map(RateUnit::unit)),
            (Dimension::Angle, self.angle_unit.map(AngleUnit::unit)),
            (Dimension::Speed, self.speed_unit.map(SpeedUnit::unit)),
        ];
        Conventions {
            columns: self.columns.iter().cloned().collect(),
            units: units.into_iter().filter_map(|(dimension, unit)| Some((dimension, unit?))).collect(),
            gravity: self.gravity.unwrap_or(Gravity::Included),
            axes: self.axes.unwrap_or(Axes::ForwardLeftUp),
            rate_frame: self.rate_frame.unwrap_or(RateFrame::Body),
            resample: self.resample,
            fade_in: self.fade_in.unwrap_or(0.0),
        }
    }
}

/// `key=name` of an option.
fn column_name(text: &str) -> Result<(Quantity, String), String> {
    let (key, name) = text.split_once('=').ok_or("write KEY=NAME, as in ax=accel_x")?;
    Ok((quantity(key.trim())?, name.trim().to_owned()))
}

/// The quantity of a key.
fn quantity(key: &str) -> Result<Quantity, String> {
    let found = Quantity::ALL.iter().find(|(_, known)| *known == key);
    let keys = || Quantity::ALL.map(|(_, key)| key).join(", ");
    found.map(|(quantity, _)| *quantity).ok_or_else(|| format!("there is no key {key}; there are {}", keys()))
}

fn columns_of_table<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Vec<(Quantity, String)>, D::Error> {
    let table = BTreeMap::<String, String>::deserialize(deserializer)?;
    let named = table.into_iter().map(|(key, name)| Ok((quantity(&key)?, name)));
    named.collect::<Result<_, String>>().map_err(serde::de::Error::custom)
}
