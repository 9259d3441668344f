//! The options for conventions, on the command line and in a file.

use std::collections::BTreeMap;
use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;

use super::mounting::Written;
use super::{
    AngleUnit, Axes, Conventions, Dimension, EmptyFields, ForceUnit, Format, Frame, Gravity, LengthUnit, Missing,
    Mounting, Quantity, RateUnit, SpeedUnit, TimeUnit,
};
use crate::recording::message::RecordingError;

/// Options that describe a recording.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
#[cfg_attr(feature = "clap", command(next_help_heading = "Columns of the recording"))]
pub struct ConventionOptions {
    /// Conventions of a logger, which the other options override
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME"))]
    pub format: Option<Format>,

    /// Names of columns that are not called time, ax ay az, wx wy wz: time=t,ax=accel_x. Further
    /// keys are roll pitch yaw or qw qx qy qz, speed, lean, x y. A minus sign reverses an axis:
    /// ay=-accel_x. Terms with spaces around their sign are added: "ax=accel_x + gravity_x".
    /// A number scales a column: "ax=counts_x / 16384".
    /// FILE.NAME is a column of one of several files, NAME#2 the second of two of this name.
    /// roll= without a name leaves a column out.
    /// Upper and lower case are the same
    #[cfg_attr(feature = "clap", arg(long, value_name = "KEY=NAME", value_delimiter = ',', value_parser = column_name))]
    #[serde(deserialize_with = "columns_of_table")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub columns: Vec<(Quantity, String)>,

    /// Unit of time [default: the header's, otherwise s]
    #[cfg_attr(feature = "clap", arg(long, value_name = "UNIT"))]
    pub time_unit: Option<TimeUnit>,

    /// Unit of ax ay az [default: the header's, otherwise m/s2]
    #[cfg_attr(feature = "clap", arg(long, value_name = "UNIT"))]
    pub force_unit: Option<ForceUnit>,

    /// Unit of wx wy wz [default: the header's, otherwise rad/s]
    #[cfg_attr(feature = "clap", arg(long, value_name = "UNIT"))]
    pub rate_unit: Option<RateUnit>,

    /// Unit of roll pitch yaw and lean [default: the header's, otherwise rad]
    #[cfg_attr(feature = "clap", arg(long, value_name = "UNIT"))]
    pub angle_unit: Option<AngleUnit>,

    /// Unit of speed [default: the header's, otherwise m/s]
    #[cfg_attr(feature = "clap", arg(long, value_name = "UNIT"))]
    pub speed_unit: Option<SpeedUnit>,

    /// Unit of x y [default: the header's, otherwise m]
    #[cfg_attr(feature = "clap", arg(long, value_name = "UNIT"))]
    pub length_unit: Option<LengthUnit>,

    /// Presence of gravity's reaction in ax ay az, as an accelerometer reads it [default: included]
    #[cfg_attr(feature = "clap", arg(long, value_name = "GRAVITY"))]
    pub gravity: Option<Gravity>,

    /// Directions of x, y and z [default: forward-left-up]
    #[cfg_attr(feature = "clap", arg(long, value_name = "AXES"))]
    pub axes: Option<Axes>,

    /// The sensor's roll, pitch and yaw in the vehicle's axes, in degrees; auto finds them from
    /// gravity, bends and accelerations, and from the speed where there is one
    #[cfg_attr(feature = "clap", arg(long, value_name = "ROLL,PITCH,YAW|auto", value_parser = Mounting::parse, allow_hyphen_values = true))]
    #[schemars(with = "Option<Written>")]
    pub mounting: Option<Mounting>,

    /// The axes of wx wy wz [default: body]
    #[cfg_attr(feature = "clap", arg(long, value_name = "AXES"))]
    pub rate_frame: Option<Frame>,

    /// The axes of ax ay az [default: body]; those of the world are turned by roll, pitch and yaw
    #[cfg_attr(feature = "clap", arg(long, value_name = "AXES"))]
    pub force_frame: Option<Frame>,

    /// Fields that are empty [default: error]
    #[cfg_attr(feature = "clap", arg(long, value_name = "EMPTY"))]
    pub empty_fields: Option<EmptyFields>,

    /// Columns of ay az wx wy wz that a recording lacks [default: error]
    #[cfg_attr(feature = "clap", arg(long, value_name = "MISSING"))]
    pub missing: Option<Missing>,

    /// Lap to read, from 1, of a recording whose time restarts with each lap
    #[cfg_attr(feature = "clap", arg(long, value_name = "NUMBER"))]
    pub lap: Option<f64>,

    /// Read the vehicle's position, the columns x and y in fixed axes, or latitude and longitude;
    /// --learn does so, too
    #[cfg_attr(feature = "clap", arg(long))]
    pub position: bool,

    /// Interpolate over a logger's error values and isolated spikes
    #[cfg_attr(feature = "clap", arg(long))]
    pub repair: bool,

    /// Sample rate of a recording without a time column, or in place of its times
    #[cfg_attr(feature = "clap", arg(long, value_name = "HERTZ"))]
    pub rate: Option<f64>,

    /// Resample a recording with unequal steps to this rate, by linear interpolation
    #[cfg_attr(feature = "clap", arg(long, value_name = "HERTZ"))]
    pub resample: Option<f64>,

    /// Fade in a recording that does not begin at rest, over this time
    #[cfg_attr(feature = "clap", arg(long, value_name = "SECONDS", allow_negative_numbers = true))]
    pub fade_in: Option<f64>,

    /// TOML file with these options by the same names (force-unit = "g"); names of columns
    /// are in its table columns
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE"))]
    #[serde(skip)]
    pub conventions: Option<PathBuf>,
}

impl ConventionOptions {
    /// The conventions: the options' over the file's over the defaults.
    ///
    /// # Errors
    /// The file cannot be read or has an unknown word or value.
    pub fn load(&self) -> Result<Conventions, RecordingError> {
        self.load_or_fade_in(0.0)
    }

    /// The conventions, with a time to fade recordings in where neither the options nor
    /// the file give one \[s\].
    ///
    /// # Errors
    /// As [`ConventionOptions::load`].
    pub fn load_or_fade_in(&self, fade_in: f64) -> Result<Conventions, RecordingError> {
        let given = self.with_file()?;
        let given = given.format.map_or(given.clone(), |format| given.over(format.options()));
        ConventionOptions { fade_in: given.fade_in.or(Some(fade_in)), ..given }.checked()
    }

    /// The options over the file's, if there is one.
    fn with_file(&self) -> Result<ConventionOptions, RecordingError> {
        let Some(file) = &self.conventions else { return Ok(self.clone()) };
        let text = moris_fmu_host::files::text(file, moris_fmu_host::files::MAX_TEXT_SIZE)
            .map_err(|reason| RecordingError::Read { file: file.clone(), reason })?;
        let given = toml::from_str(&text).map_err(|error| RecordingError::whole(file, error.to_string()))?;
        Ok(self.over(given))
    }

    /// The options over others.
    fn over(&self, under: ConventionOptions) -> ConventionOptions {
        let columns = under.columns.into_iter().chain(self.columns.iter().cloned()).collect();
        // A format's mounting is that of the sensor whose columns it names: what a receiver computes is not turned.
        let names_others = self.missing == Some(Missing::Rest)
            && self.columns.iter().any(|(quantity, _)| matches!(quantity, Quantity::Force(_)));
        let (position, repair) = (self.position || under.position, self.repair || under.repair);
        let mounting = self.mounting.or(under.mounting.filter(|_| !names_others));
        let conventions = self.conventions.clone();
        /// The options over others, of fields that are absent where they are not given.
        macro_rules! given {
            ($($field:ident)*) => {
                ConventionOptions { columns, position, repair, mounting, conventions, $( $field: self.$field.or(under.$field), )* }
            };
        }
        given! { format time_unit force_unit rate_unit angle_unit speed_unit length_unit gravity axes rate_frame force_frame
        empty_fields missing lap rate resample fade_in }
    }

    fn checked(&self) -> Result<Conventions, RecordingError> {
        let allowed = [
            ("rate", self.rate, 1.0..=1e5, "samples a second"),
            ("resample", self.resample, 1.0..=1e4, "samples a second"),
            ("lap", self.lap, 1.0..=1e6, "and whole"),
            ("fade-in", self.fade_in, 0.0..=1e3, "seconds"),
        ];
        for (name, given, range, unit) in allowed {
            let is_whole = |value: f64| name != "lap" || value.fract() == 0.0;
            if let Some(value) = given.filter(|value| !range.contains(value) || !is_whole(*value)) {
                return Err(RecordingError::Option { name, value, min: *range.start(), max: *range.end(), unit });
            }
        }
        Ok(self.conventions())
    }

    pub(super) fn conventions(&self) -> Conventions {
        let units = [
            (Dimension::Time, self.time_unit.map(TimeUnit::unit)),
            (Dimension::Force, self.force_unit.map(ForceUnit::unit)),
            (Dimension::Rate, self.rate_unit.map(RateUnit::unit)),
            (Dimension::Angle, self.angle_unit.map(AngleUnit::unit)),
            (Dimension::Speed, self.speed_unit.map(SpeedUnit::unit)),
            (Dimension::Length, self.length_unit.map(LengthUnit::unit)),
        ];
        Conventions {
            format: self.format,
            columns: self.columns.iter().cloned().collect(),
            units: units.into_iter().filter_map(|(dimension, unit)| Some((dimension, unit?))).collect(),
            gravity: self.gravity.unwrap_or(Gravity::Included),
            axes: self.axes.unwrap_or(Axes::ForwardLeftUp),
            mounting: self.mounting,
            rate_frame: self.rate_frame.unwrap_or(Frame::Body),
            force_frame: self.force_frame.unwrap_or(Frame::Body),
            empty_fields: self.empty_fields.unwrap_or(EmptyFields::Error),
            missing: self.missing.unwrap_or(Missing::Error),
            lap: self.lap.map(|lap| lap as usize),
            repair: self.repair,
            rate: self.rate,
            resample: self.resample,
            fade_in: self.fade_in.unwrap_or(0.0),
            position: self.position,
        }
    }
}

/// `key=name` of an option.
fn column_name(text: &str) -> Result<(Quantity, String), String> {
    let (key, name) = text
        .split_once('=')
        .ok_or("write KEY=NAME, as in ax=accel_x; a name with a comma is given by its part before it")?;
    Ok((Quantity::of_key(key.trim())?, name.trim().to_owned()))
}

/// Columns as a table, or in a text as on the command line.
fn columns_of_table<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Vec<(Quantity, String)>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "columns must be names by key, or a text such as \"time=t,ax=accel_x\"")]
    enum Given {
        Table(BTreeMap<String, String>),
        Text(String),
    }
    let named: Result<_, String> = match Given::deserialize(deserializer)? {
        Given::Table(table) => table.into_iter().map(|(key, name)| Ok((Quantity::of_key(&key)?, name))).collect(),
        Given::Text(text) => text.split(',').map(column_name).collect(),
    };
    named.map_err(serde::de::Error::custom)
}
