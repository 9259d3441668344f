//! The mounting as an option.

use moris_washout::motion::orientation::RollPitchYaw;
use moris_washout::nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::option_values::numbers;

/// The sensor's orientation in the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Written")]
pub enum Mounting {
    /// To be found from gravity, accelerations and bends.
    Auto,
    /// Roll, pitch and yaw of the sensor in the vehicle's axes \[rad\].
    Angles(RollPitchYaw),
}

/// The mounting in a file of conventions.
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(super) enum Written {
    /// auto
    Word(String),
    /// Roll, pitch and yaw of the sensor in the vehicle's axes, in degrees
    Angles([f64; 3]),
}

impl TryFrom<Written> for Mounting {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        match written {
            Written::Word(word) => Mounting::parse(&word),
            Written::Angles(degrees) => Mounting::of_degrees(degrees),
        }
    }
}

impl Mounting {
    /// `auto`, or `ROLL,PITCH,YAW` in degrees.
    ///
    /// # Errors
    /// The text is neither.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text.trim() == "auto" {
            return Ok(Mounting::Auto);
        }
        Self::of_degrees(numbers(text).ok_or("write auto, or ROLL,PITCH,YAW in degrees, as in 0,90,0")?)
    }

    fn of_degrees(degrees: [f64; 3]) -> Result<Self, String> {
        if degrees.iter().any(|angle| !(-360.0..=360.0).contains(angle)) {
            return Err("roll, pitch and yaw must be from -360 to 360 degrees".to_owned());
        }
        Ok(Mounting::Angles(RollPitchYaw::from_vector(Vector3::from(degrees).map(f64::to_radians))))
    }
}
