//! Names, units and axes of a recording's columns.
//!
//! Said by options, or by a small TOML file with the same words, or both: options stand over the file.
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
    /// Every quantity with its key, which is also its column's name unless another is said.
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

    /// True for a required column: time, specific force and rates.
    pub fn is_required(self) -> bool {
        matches!(self, Quantity::Time | Quantity::Force(_) | Quantity::Rate(_))
    }

    /// The quantity's key.
    pub fn key(self) -> &'static str {
        let found = Self::ALL.iter().find(|(quantity, _)| *quantity == self);
        found.map_or("", |(_, key)| key)
    }
}

/// Declares an enumeration whose items users write, on the command line and in TOML alike.
macro_rules! choices {
    ($(#[$attribute:meta])* $name:ident { $( $(#[doc = $text:literal])+ $word:literal $item:ident, )+ }) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Deserialize)]
        pub enum $name {
            $( $(#[doc = $text])+ #[value(name = $word)] #[serde(rename = $word)] $item, )+
        }

        impl $name {
            /// The word that users write.
            pub fn word(self) -> &'static str {
                match self { $( $name::$item => $word, )+ }
            }
        }
    };
}

choices! {
    /// Unit of the time.
    TimeUnit {
        /// Seconds
        "s" Second,
        /// Milliseconds
        "ms" Millisecond,
        /// Microseconds
        "us" Microsecond,
        /// Nanoseconds
        "ns" Nanosecond,
    }
}

choices! {
    /// Unit of the specific force.
    ForceUnit {
        /// Metres per second squared
        "m/s2" MetrePerSecondSquared,
        /// Standard gravity, 9.80665 m/s2
        "g" Gravity,
    }
}

choices! {
    /// Unit of the angular velocity.
    RateUnit {
        /// Radians per second
        "rad/s" RadianPerSecond,
        /// Degrees per second
        "deg/s" DegreePerSecond,
    }
}

choices! {
    /// Unit of the angles.
    AngleUnit {
        /// Radians
        "rad" Radian,
        /// Degrees
        "deg" Degree,
    }
}

choices! {
    /// True if the accelerations are specific forces.
    Gravity {
        /// Gravity's reaction is in: (0, 0, +9.81) at rest, what an accelerometer reads
        "included" Included,
        /// Gravity has been taken out: (0, 0, 0) at rest
        "removed" Removed,
    }
}

choices! {
    /// Where x, y and z point.
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

impl TimeUnit {
    /// \[s\]
    pub fn in_si(self) -> f64 {
        match self {
            TimeUnit::Second => 1.0,
            TimeUnit::Millisecond => 1e-3,
            TimeUnit::Microsecond => 1e-6,
            TimeUnit::Nanosecond => 1e-9,
        }
    }
}

impl ForceUnit {
    /// \[m/s2\]
    pub fn in_si(self) -> f64 {
        match self {
            ForceUnit::MetrePerSecondSquared => 1.0,
            ForceUnit::Gravity => moris_washout::interface::STANDARD_GRAVITY,
        }
    }
}

impl RateUnit {
    /// \[rad/s\]
    pub fn in_si(self) -> f64 {
        match self {
            RateUnit::RadianPerSecond => 1.0,
            RateUnit::DegreePerSecond => 1f64.to_radians(),
        }
    }
}

impl AngleUnit {
    /// \[rad\]
    pub fn in_si(self) -> f64 {
        match self {
            AngleUnit::Radian => 1.0,
            AngleUnit::Degree => 1f64.to_radians(),
        }
    }
}

impl Axes {
    /// By what x, y and z are multiplied to be x forward, y left, z up.
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

/// Conventions of a recording, each given or left to the default.
#[derive(Clone, Debug, Default, PartialEq, clap::Args, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
#[command(next_help_heading = "What the recording's columns are")]
pub struct ConventionOptions {
    /// Names of columns that are not called time, ax ay az, wx wy wz (and, where there are any, roll pitch yaw, speed,
    /// lean): time=t,ax=accel_x
    #[arg(long, value_name = "KEY=NAME", value_delimiter = ',', value_parser = column_name)]
    #[serde(deserialize_with = "columns_of_table")]
    pub columns: Vec<(Quantity, String)>,

    /// Unit of time [default: s]
    #[arg(long, value_name = "UNIT")]
    pub time_unit: Option<TimeUnit>,

    /// Unit of ax ay az [default: m/s2]
    #[arg(long, value_name = "UNIT")]
    pub force_unit: Option<ForceUnit>,

    /// Unit of wx wy wz [default: rad/s]
    #[arg(long, value_name = "UNIT")]
    pub rate_unit: Option<RateUnit>,

    /// Unit of roll pitch yaw and lean [default: rad]
    #[arg(long, value_name = "UNIT")]
    pub angle_unit: Option<AngleUnit>,

    /// Gravity in ax ay az: included, as an accelerometer measures it, or not [default: included]
    #[arg(long, value_name = "WHETHER")]
    pub gravity: Option<Gravity>,

    /// Where x, y and z point [default: forward-left-up]
    #[arg(long, value_name = "AXES")]
    pub axes: Option<Axes>,

    /// The axes of wx wy wz [default: body]
    #[arg(long, value_name = "AXES")]
    pub rate_frame: Option<RateFrame>,

    /// Interpolate a recording with unequal steps linearly, at this many samples a second
    #[arg(long, value_name = "HERTZ")]
    pub resample: Option<f64>,

    /// Fade in a recording that does not begin at rest, over this many seconds
    #[arg(long, value_name = "SECONDS")]
    pub fade_in: Option<f64>,

    /// TOML file with the same options (force-unit = "g"), names of columns under columns
    #[arg(long, value_name = "FILE")]
    #[serde(skip)]
    pub conventions: Option<PathBuf>,
}

/// Conventions of a recording that is read.
#[derive(Clone, Debug, PartialEq)]
pub struct Conventions {
    /// Column names that are not the keys.
    pub columns: BTreeMap<Quantity, String>,
    pub time_unit: TimeUnit,
    pub force_unit: ForceUnit,
    pub rate_unit: RateUnit,
    pub angle_unit: AngleUnit,
    pub gravity: Gravity,
    pub axes: Axes,
    pub rate_frame: RateFrame,
    /// Samples a second to interpolate at \[1/s\].
    pub resample: Option<f64>,
    /// Time over which the recording is led in from rest \[s\].
    pub fade_in: f64,
}

impl Default for Conventions {
    fn default() -> Self {
        ConventionOptions::default().said()
    }
}

impl Conventions {
    /// The name of a quantity's column.
    pub fn column(&self, quantity: Quantity) -> &str {
        self.columns.get(&quantity).map_or(quantity.key(), String::as_str)
    }
}

impl ConventionOptions {
    /// The given conventions: options over file over defaults.
    ///
    /// # Errors
    /// The file cannot be read or says something that cannot be said.
    pub fn load(&self) -> Result<Conventions, RideError> {
        self.load_or_fade_in(0.0)
    }

    /// The same, with another time to lead recordings in where neither the options nor the file say one \[s\].
    ///
    /// # Errors
    /// As [`ConventionOptions::load`].
    pub fn load_or_fade_in(&self, fade_in: f64) -> Result<Conventions, RideError> {
        let said = self.with_file()?;
        ConventionOptions { fade_in: said.fade_in.or(Some(fade_in)), ..said }.checked()
    }

    /// The options over what the file says, if there is one.
    fn with_file(&self) -> Result<ConventionOptions, RideError> {
        let Some(file) = &self.conventions else { return Ok(self.clone()) };
        let text = fs::read_to_string(file).map_err(|reason| RideError::Read { file: file.clone(), reason })?;
        let said: ConventionOptions = toml::from_str(&text)
            .map_err(|error| RideError::Conventions { file: file.clone(), reason: error.to_string() })?;
        Ok(self.over(said))
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
        for (name, said, range, unit) in allowed {
            if let Some(value) = said.filter(|value| !range.contains(value)) {
                return Err(RideError::Option { name, value, min: *range.start(), max: *range.end(), unit });
            }
        }
        Ok(self.said())
    }

    fn said(&self) -> Conventions {
        Conventions {
            columns: self.columns.iter().cloned().collect(),
            time_unit: self.time_unit.unwrap_or(TimeUnit::Second),
            force_unit: self.force_unit.unwrap_or(ForceUnit::MetrePerSecondSquared),
            rate_unit: self.rate_unit.unwrap_or(RateUnit::RadianPerSecond),
            angle_unit: self.angle_unit.unwrap_or(AngleUnit::Radian),
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

/// The quantity of a key, or which keys there are.
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
