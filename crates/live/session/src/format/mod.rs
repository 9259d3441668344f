//! Packets of telemetry, described by tables in TOML.
//!
//! A table says where a packet holds which quantity. Field names are those of the washout's axes: x
//! forward, y left, z up, positive pitch nose down. The sign of a field's `scale` turns the
//! source's axis to these.
//!
//! ```
//! let format: moris_live::format::Format = r#"
//!     name = "own"
//!     about = "three floats"
//!     note = "an example"
//!     layout = "binary"
//!     gravity = "removed"
//!     lengths = [12]
//!     [fields]
//!     ax = { at = 0, type = "f32", unit = "g" }
//!     ay = { at = 4, type = "f32", unit = "g", scale = -1 }
//!     az = { at = 8, type = "f32", unit = "g" }
//! "#.parse()?;
//! let sample = format.decode(&[0, 0, 0, 63, 0, 0, 0, 0, 0, 0, 0, 0])?;
//! assert_eq!(sample.motion.force().x, 0.5 * 9.80665);
//! assert_eq!(sample.motion.force().z, 9.80665);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod decode;
mod line;

use std::collections::BTreeMap;
use std::str::FromStr;

use serde::Deserialize;

use crate::tables::{check, shipped_tables};
pub use decode::Dropped;

/// A table of a packet's fields.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Format {
    /// Name of the format.
    pub name: String,
    /// The program that sends it.
    pub about: String,
    /// Sources of the table, and what no real packet has verified.
    pub note: String,
    /// Layout of a packet.
    pub layout: Layout,
    /// Vehicle of the program.
    #[serde(default)]
    pub vehicle: Vehicle,
    /// Port to which the program sends by default, for the reader of the table.
    pub port: Option<u16>,
    /// Lengths that a packet may have \[bytes\]; any if empty.
    #[serde(default)]
    pub lengths: Vec<usize>,
    /// First characters of a packet.
    #[serde(default)]
    pub head: String,
    /// Byte order of numbers.
    #[serde(default)]
    pub byte_order: ByteOrder,
    /// Gravity in the acceleration.
    pub gravity: Gravity,
    /// Axes of the acceleration.
    #[serde(default)]
    pub force_axes: Axes,
    /// Axes of the angular velocity.
    #[serde(default)]
    pub rate_axes: Axes,
    /// The player's place in a list of vehicles.
    pub player: Option<Player>,
    /// Mark of the program's other packets, which are skipped without a word.
    pub others: Option<Others>,
    /// Subscription that the program must receive first.
    pub subscribe: Option<Subscribe>,
    /// The fields.
    pub fields: BTreeMap<Quantity, Field>,
    /// Further fields of packets with some lengths.
    #[serde(default, alias = "of-lengths")]
    pub variants: Vec<Variant>,
}

/// Fields of packets with some lengths alone.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Variant {
    /// The lengths \[bytes\].
    pub lengths: Vec<usize>,
    /// The player's place, if it is another one.
    pub player: Option<Player>,
    /// The fields.
    pub fields: BTreeMap<Quantity, Field>,
}

/// Numbers that mark packets of other lengths as the program's own: a game sends its lap times to
/// the same port.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Others {
    /// Offset of the number \[bytes\].
    pub at: usize,
    /// Type of the number.
    #[serde(rename = "type", default = "byte")]
    pub kind: Number,
    /// Values that it may have.
    pub values: Vec<u32>,
}
/// The player's number in a list of vehicles, and where each of them is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Player {
    /// Place of the number, from 0: an offset, a column, or a key.
    pub at: FieldAddress,
    /// Type of a binary number.
    #[serde(rename = "type", default = "byte")]
    pub kind: Number,
    /// Offset or column of the first vehicle, from which the places of its fields count.
    #[serde(default)]
    pub first: usize,
    /// Bytes or columns from a vehicle to the next one.
    #[serde(default)]
    pub stride: usize,
}

fn byte() -> Number {
    Number::U8
}
/// Request by which a program is asked for values: packets of bytes, or X-Plane's RREF for each
/// field with a dataref.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Subscribe {
    /// Port to which it is sent.
    pub port: u16,
    /// Values a second, of X-Plane.
    #[serde(default)]
    pub rate: i32,
    /// Packets that are sent as they are.
    #[serde(default)]
    pub packets: Vec<Vec<u8>>,
}

/// A field of a packet.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Field {
    /// Offset \[bytes\], column, number or key.
    pub at: FieldAddress,
    /// Type of a binary number.
    #[serde(rename = "type", default)]
    pub kind: Number,
    /// Unit of the value in the packet, by default the SI unit of the quantity.
    pub unit: Option<Unit>,
    /// Factor; a negative one turns the axis round.
    #[serde(default = "one")]
    pub scale: f64,
    /// Name by which X-Plane is asked for the value.
    pub dataref: Option<String>,
    /// Keys of the value in text of pairs, beside the quantity's own name.
    #[serde(default)]
    pub keys: Vec<String>,
    /// `at` is that of the first vehicle; the player's is as many strides further.
    #[serde(default)]
    pub of_player: bool,
}

fn one() -> f64 {
    1.0
}

/// Address of a field in a packet.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum FieldAddress {
    /// An offset, a column or a number.
    Index(usize),
    /// Key of a JSON object.
    Key(String),
}

macro_rules! words {
    ($( $(#[$attribute:meta])* $type:ident { $( $(#[$item_attribute:meta])* $item:ident $word:literal, )+ } )+) => { $(
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
        pub enum $type { $( #[doc = $word] #[serde(rename = $word)] $(#[$item_attribute])* $item, )+ }

        impl $type {
            /// The word in a table.
            pub fn word(self) -> &'static str {
                match self { $( $type::$item => $word, )+ }
            }
        }
    )+ };
}

words! {
    /// Layout of a packet.
    Layout {
        /// Numbers at offsets.
        Binary "binary",
        /// A head, then pairs of an i32 and an f32; `at` is the i32.
        Pairs "pairs",
        /// Lines of numbers with semicolons, tabs or commas between them, each a sample, or pairs
        /// like `ax=1.5`. `at` is the column, from 0, its title, or the key.
        Csv "csv",
        /// An object; `at` is the path of keys.
        Json "json",
    }

    /// Vehicle of a source: one that leans into its turns, or any; or one that does not lean.
    #[derive(Default)]
    Vehicle { #[default] Motorcycle "motorcycle", Car "car", }

    /// Byte order of numbers: the least significant byte first, or the most significant one.
    #[derive(Default)]
    ByteOrder { #[default] Little "little", Big "big", }

    /// Gravity in the acceleration: as an accelerometer measures, +g upward at rest; or zero at
    /// rest, and gravity's reaction is added by the attitude.
    Gravity { Included "included", Removed "removed", }

    /// Axes of a vector: the vehicle's, or the world's, in which the attitude is given.
    #[derive(Default)]
    Axes { #[default] Body "body", World "world", }

    /// Quantity of a field.
    Quantity {
        Time "time", Ax "ax", Ay "ay", Az "az", Wx "wx", Wy "wy", Wz "wz", Roll "roll", Pitch "pitch", Yaw "yaw",
        X "x", Y "y", Z "z", Vx "vx", Vy "vy", Vz "vz", Speed "speed", Paused "paused", Running "running",
        Qw "qw", Qx "qx", Qy "qy", Qz "qz",
    }

    /// Type of a binary number.
    #[derive(Default)]
    Number {
        U8 "u8", I8 "i8", U16 "u16", I16 "i16", U32 "u32", I32 "i32", U64 "u64",
        #[default]
        F32 "f32",
        F64 "f64",
    }

    /// Unit of a field.
    Unit {
        MetrePerSecond2 "m/s2", G "g", RadianPerSecond "rad/s", DegreePerSecond "deg/s", Radian "rad", Degree "deg",
        MetrePerSecond "m/s", KilometrePerHour "km/h", MilePerHour "mph", Metre "m", Second "s", Millisecond "ms",
    }
}

impl Quantity {
    /// The quantity's kind, and the units that its field may have: the washout's first.
    fn kind(self) -> (&'static str, &'static [Unit]) {
        use Quantity::*;
        match self {
            Time => ("a time", &[Unit::Second, Unit::Millisecond]),
            Ax | Ay | Az => ("a specific force", &[Unit::MetrePerSecond2, Unit::G]),
            Wx | Wy | Wz => ("an angular velocity", &[Unit::RadianPerSecond, Unit::DegreePerSecond]),
            Roll | Pitch | Yaw => ("an angle", &[Unit::Radian, Unit::Degree]),
            X | Y | Z => ("a position", &[Unit::Metre]),
            Vx | Vy | Vz | Speed => ("a velocity", &[Unit::MetrePerSecond, Unit::KilometrePerHour, Unit::MilePerHour]),
            Paused | Running => ("a flag", &[]),
            Qw | Qx | Qy | Qz => ("a quaternion", &[]),
        }
    }
}

/// Number of quantities.
const QUANTITY_COUNT: usize = Quantity::Qz as usize + 1;

/// Quantities of an attitude as a quaternion of any size, which turns the body's axes to the
/// world's.
const QUATERNION_QUANTITIES: [Quantity; 4] = [Quantity::Qw, Quantity::Qx, Quantity::Qy, Quantity::Qz];

/// Reason for which a table cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FormatError {
    /// The text is not TOML, or has unknown words.
    #[error("{0}")]
    Toml(#[from] toml::de::Error),
    /// A field does not fit the layout.
    #[error("field {}: {}", .0.word(), .1)]
    Field(Quantity, &'static str),
    /// A field has a unit of another quantity.
    #[error("{}", unit_refusal(*.0, *.1))]
    Unit(Quantity, Unit),
    /// The whole does not fit together.
    #[error("{0}")]
    Whole(&'static str),
}

fn unit_refusal(quantity: Quantity, unit: Unit) -> String {
    let (kind, units) = quantity.kind();
    let remedy = match units.iter().map(|unit| format!("`{}`", unit.word())).collect::<Vec<_>>().as_slice() {
        [] => "leave `unit` out".to_owned(),
        allowed => format!("write {}", allowed.join(" or ")),
    };
    format!("field {}: `{}` is not a unit of {kind}: {remedy}", quantity.word(), unit.word())
}

impl FromStr for Format {
    type Err = FormatError;

    fn from_str(text: &str) -> Result<Self, FormatError> {
        // Most fields of a table, and largest offset.
        const MAX_FIELDS: usize = 4096;
        let format: Format = toml::from_str(text)?;
        let further = format.variants.iter().flat_map(|variant| &variant.fields);
        for (quantity, field) in format.fields.iter().chain(further) {
            let (fits, form) = match (&field.at, format.layout) {
                (FieldAddress::Key(_), Layout::Json) => (true, ""),
                (FieldAddress::Index(_), Layout::Json) => (false, "`at` must be a key"),
                (FieldAddress::Key(_), layout) => (layout == Layout::Csv, "`at` must be a number below 4096"),
                (FieldAddress::Index(index), _) => (*index < MAX_FIELDS, "`at` must be a number below 4096"),
            };
            let conditions = [
                (fits, form),
                (
                    !field.of_player || format.player.is_some(),
                    "`of-player` needs a line `player` with the place of the player's number",
                ),
                (field.scale.is_finite() && field.scale != 0.0, "`scale` must be a number other than zero"),
            ];
            check(&conditions, |reason| FormatError::Field(*quantity, reason))?;
            if let Some(unit) = field.unit.filter(|unit| !quantity.kind().1.contains(unit)) {
                return Err(FormatError::Unit(*quantity, unit));
            }
        }
        let has = |quantity| format.fields.contains_key(&quantity);
        let quaternion = QUATERNION_QUANTITIES.map(has);
        let has_attitude =
            [Quantity::Roll, Quantity::Pitch, Quantity::Yaw].into_iter().all(has) || !quaternion.contains(&false);
        let players = format.variants.iter().filter_map(|variant| variant.player.as_ref()).chain(&format.player);
        let fits = |player: &Player| match player.at {
            FieldAddress::Index(at) => {
                let offsets = at.max(player.first) < MAX_FIELDS && (1..MAX_FIELDS).contains(&player.stride);
                offsets && format.layout != Layout::Json
            }
            FieldAddress::Key(_) => true,
        };
        let conditions = [
            (has(Quantity::Ax) && has(Quantity::Ay), "fields ax and ay are needed"),
            (quaternion.iter().all(|has| *has == quaternion[0]), "a quaternion needs qw, qx, qy and qz"),
            (
                players.into_iter().all(fits),
                "player needs `at`, `first` and `stride` below 4096; in JSON `at` is a key",
            ),
            (format.others.is_none() || format.layout == Layout::Binary, "`others` is for the layout binary"),
            (
                [format.force_axes, format.rate_axes] == [Axes::Body; 2] || has_attitude,
                "vectors in the world's axes need roll, pitch and yaw, or a quaternion",
            ),
        ];
        check(&conditions, FormatError::Whole)?;
        Ok(format)
    }
}

/// The shipped tables, each with its name and text.
pub const SHIPPED_FORMATS: &[(&str, &str)] = shipped_tables!(
    "json" "csv" "packed" "outsim" "motionsim" "forza" "codemasters" "f1" "assetto-corsa" "project-cars-2" "rfactor"
    "iracing" "piboso" "x-plane"
);

impl Format {
    /// True if some of its packets have the vehicle's place.
    pub fn has_position(&self) -> bool {
        let further = self.variants.iter().map(|variant| &variant.fields);
        further
            .chain([&self.fields])
            .any(|fields| [Quantity::X, Quantity::Y].iter().all(|axis| fields.contains_key(axis)))
    }

    /// The packets that ask the program for values; empty if it sends them by itself.
    pub fn subscriptions(&self) -> Vec<Vec<u8>> {
        let Some(subscribe) = &self.subscribe else { return Vec::new() };
        let request = |field: &Field| {
            let (FieldAddress::Index(index), Some(dataref)) = (&field.at, &field.dataref) else { return None };
            let mut packet = b"RREF\0".to_vec();
            packet.extend(subscribe.rate.to_le_bytes());
            packet.extend((*index as i32).to_le_bytes());
            packet.extend(dataref.bytes().take(399));
            packet.resize(413, 0);
            Some(packet)
        };
        subscribe.packets.iter().cloned().chain(self.fields.values().filter_map(request)).collect()
    }
}
