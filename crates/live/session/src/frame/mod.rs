//! Frames to actuators, described by templates in TOML.
//!
//! A template is a string of tokens between spaces:
//!
//! | token | bytes |
//! |---|---|
//! | `FF` | one byte, in hexadecimal digits |
//! | `'text'` | its characters |
//! | `leg1:u16` | position of the first actuator, 0 to 1 spread over `range`: u8, u16, u24 or u32, big-endian; `u16le` and so on little-endian |
//! | `leg1:hi`, `leg1:lo` | the high and the low byte of `leg1:u16` |
//! | `leg1:i16` | the same as a signed number, spread over all of its range without `range`: i8 to i32 |
//! | `leg1:dec` | the same in decimal digits |
//! | `length1:6`, `x:1*1000` | a quantity, times a factor, with so many decimals: see [`FRAME_QUANTITIES`] |
//! | `degrees1:2`, `radians1`, `pulse1`, `steps1` | the angle of a crank's motor as a quantity: see [`Frames::zero_degrees`] |
//! | `x:i16*1000` | a quantity times a factor as a whole number, signed or not; the nearest one at its ends |
//! | `count:u8` | the number of the frame, which begins at 0 again |
//! | `sum:u8`, `xor:u8` | sum or exclusive or of the bytes before it; `sum@2:u8`: from the third one on |
//! | `x:f64le*1000` | a quantity times a factor as a number: `f32` or `f64` big-endian, `f32le` or `f64le` little-endian |
//!
//! ```
//! use moris_live::frame::{Encoder, Message, Values};
//! use moris_washout::Rig;
//!
//! let text = r#"
//!     name = "own"
//!     about = "two legs in decimal digits"
//!     note = "an example"
//!     range = [0, 1000]
//!     reversed = [2]
//!     frame = "'A' leg1:dec 'B' leg2:dec 0A"
//!     stop = "'X' 0A"
//! "#;
//! let encoder = Encoder::new(&text.parse()?, &Rig::default())?;
//! let mut frame = Vec::new();
//! encoder.write(Message::Frame, &Values { length: [1.15; 6], ..Values::default() }, &mut frame);
//! assert_eq!(frame, b"A250B750\n");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod encode;
mod motors;
mod report;

use std::str::FromStr;

use moris_washout::Rig;
use serde::Deserialize;

use crate::tables::{check, shipped_tables};
pub use encode::{Encoder, FRAME_QUANTITIES, Message, Values};

/// A template of frames.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Frames {
    /// Name of the format.
    pub name: String,
    /// The device.
    pub about: String,
    /// Sources of the template, and what no device has verified.
    pub note: String,
    /// Numbers for the shortest and the longest actuator: 0 and 65,535 by default, or the ends of
    /// signed numbers.
    pub range: Option<[i64; 2]>,
    /// Actuators, from 1, whose numbers fall with their length; cranks whose motor turns against
    /// its arm.
    #[serde(default)]
    pub reversed: Vec<usize>,
    /// Angle of each crank's motor while the arm is level \[deg\]; the motor's angle is this one
    /// plus that of the arm, or minus it where the crank is reversed.
    #[serde(default)]
    pub zero_degrees: [f64; 6],
    /// Servo pulse at a motor's angle of 0 \[us\].
    #[serde(default = "usual_pulse_centre")]
    pub pulse_centre: f64,
    /// Change of the servo pulse with the motor's angle \[us/deg\]; needed for `pulse1`.
    pub pulse_per_degree: Option<f64>,
    /// Steps of a motor in a turn of the arm, its gear included; needed for `steps1`.
    pub steps_per_turn: Option<f64>,
    /// Time between frames \[s\].
    #[serde(default = "millisecond")]
    pub interval: f64,
    /// Time without frames after which the controller stops by itself \[s\].
    pub time_out: Option<f64>,
    /// Speed of a leg with which the controller goes from anywhere to its first length \[m/s\], if
    /// it limits that by itself.
    pub slow_start: Option<f64>,
    /// Sent before a start: asks for the legs' positions, which [`Encoder::reported`]
    /// reads from the answer.
    #[serde(default)]
    pub ask: String,
    /// Sent when the platform starts.
    #[serde(default)]
    pub start: String,
    /// Sent at each interval.
    pub frame: String,
    /// Sent when the platform has come to its lowest pose.
    #[serde(default)]
    pub park: String,
    /// Sent at the end.
    #[serde(default)]
    pub stop: String,
}

fn millisecond() -> f64 {
    1e-3
}

fn usual_pulse_centre() -> f64 {
    1500.0
}

/// Reason for which a template cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FramesError {
    /// The text is not TOML, or has unknown words.
    #[error("{0}")]
    Toml(#[from] toml::de::Error),
    /// A token is unknown.
    #[error("the token {0} is none of moris-live's")]
    Token(String),
    /// A number is out of its range, or missing.
    #[error("{0}")]
    Range(&'static str),
    /// Angles for a rig that has none.
    #[error("the frames have angles of cranks, but this rig has legs: use length1 or leg1, or a rig with cranks")]
    Angles,
}

impl FromStr for Frames {
    type Err = FramesError;

    fn from_str(text: &str) -> Result<Self, FramesError> {
        let frames: Frames = toml::from_str(text)?;
        let factors = [frames.pulse_per_degree, frames.steps_per_turn];
        let conditions = [
            ((1e-3..=1.0).contains(&frames.interval), "interval must be from 0.001 to 1 s"),
            (
                frames.time_out.is_none_or(|time| (frames.interval..=10.0).contains(&time)),
                "time-out must be from the interval to 10 s",
            ),
            (
                frames.slow_start.is_none_or(|speed| (0.001..=1.0).contains(&speed)),
                "slow-start must be from 0.001 to 1 m/s",
            ),
            (frames.reversed.iter().all(|leg| (1..=6).contains(leg)), "reversed has actuators from 1 to 6"),
            (
                frames.range.iter().flatten().all(|end| (-(1 << 40)..=1 << 40).contains(end)),
                "range has numbers of at most 40 bits",
            ),
            (
                factors.into_iter().flatten().all(|factor| (1e-3..=1e9).contains(&factor)),
                "pulse-per-degree and steps-per-turn must be from 0.001 to 1e9",
            ),
            (
                frames.zero_degrees.iter().chain([&frames.pulse_centre]).all(|number| (-1e5..=1e5).contains(number)),
                "zero-degrees and pulse-centre must be from -1e5 to 1e5",
            ),
        ];
        check(&conditions, FramesError::Range)?;
        Encoder::of_any_rig(&frames, &Rig::default())?;
        Ok(frames)
    }
}

/// The shipped templates, each with its name and text.
pub const SHIPPED_FRAMES: &[(&str, &str)] =
    shipped_tables!("json" "csv" "amc-aasd15a" "motion4sim" "bff" "simtools" "servos" "vr-pose");
