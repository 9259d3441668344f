//! A packet's bytes to a sample.

use moris_washout::interface::{RollPitchYaw, STANDARD_GRAVITY};
use moris_washout::motion::orientation::Orientation;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde_json::Value;

use super::line::Line;
use super::{
    Axes, ByteOrder, Field, FieldAddress, Format, Gravity, Layout, Number, Others, Player, QUANTITY_COUNT,
    QUATERNION_QUANTITIES, Quantity, SHIPPED_FORMATS, Unit,
};
use crate::motion::{Motion, Sample};

/// Reason for which a packet is dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Dropped {
    /// The packet's length is not one of the format's.
    #[error("a packet of {0} bytes")]
    Length(usize),
    /// The packet's first bytes are not the format's.
    #[error("a packet with another head")]
    Head,
    /// The packet has titles alone, or is another one of the program's.
    #[error("a packet without a sample")]
    NoSample,
    /// The packet lacks the player's number.
    #[error("a packet without the player's number")]
    Player,
    /// The packet lacks a field, or the field is no number.
    #[error("a packet without the field {0:?}")]
    Field(Quantity),
}

/// A packet, or a part of it with one sample, in the form of its layout.
enum Record<'a> {
    Binary(&'a [u8]),
    Pairs(&'a [u8]),
    Line(Line<'a>),
    Json(Value),
}

impl Format {
    /// The first sample in a packet. Numbers in it may be infinite or no numbers.
    ///
    /// # Errors
    /// The packet is not of this format.
    pub fn decode(&self, packet: &[u8]) -> Result<Sample, Dropped> {
        let mut first = None;
        self.decode_all(packet, |sample| first = first.or(Some(sample)))?;
        first.ok_or(Dropped::NoSample)
    }

    /// Gives the samples in a packet in their order: lines of text, objects in lines, and packets
    /// of one length behind each other may hold several.
    ///
    /// # Errors
    /// The packet is not of this format, from some sample on.
    pub fn decode_all(&self, packet: &[u8], mut sample: impl FnMut(Sample)) -> Result<(), Dropped> {
        match self.layout {
            Layout::Binary | Layout::Pairs => {
                let Some(part) = self.part_length(packet.len()) else {
                    let is_known = self.others.as_ref().is_some_and(|others| self.is_other(others, packet));
                    return if is_known { Ok(()) } else { Err(Dropped::Length(packet.len())) };
                };
                for part in packet.chunks(part.max(1)) {
                    let body = part.strip_prefix(self.head.as_bytes()).ok_or(Dropped::Head)?;
                    let is_binary = self.layout == Layout::Binary;
                    let record = if is_binary { Record::Binary(part) } else { Record::Pairs(body) };
                    sample(self.sample_of(&record, part.len())?);
                }
            }
            Layout::Csv => {
                let text = self.text(packet)?;
                if text.contains('=') {
                    sample(self.sample_of(&Record::Line(Line::Pairs(text)), packet.len())?);
                    return Ok(());
                }
                let mut titles = None;
                for line in text.lines().filter(|line| !line.trim().is_empty()) {
                    let line = Line::Columns { text: line, titles };
                    if line.is_titles() {
                        titles = Some(line.text());
                    } else {
                        sample(self.sample_of(&Record::Line(line), packet.len())?);
                    }
                }
            }
            Layout::Json => {
                let text = self.text(packet)?;
                let mut objects = serde_json::Deserializer::from_str(text).into_iter::<Value>();
                let first = objects.next().and_then(Result::ok).unwrap_or_default();
                for object in std::iter::once(first).chain(objects.map_while(Result::ok)) {
                    sample(self.sample_of(&Record::Json(object), packet.len())?);
                }
            }
        }
        Ok(())
    }

    /// Length of the parts of a packet, of which each is a sample: one of the format's, or the only
    /// one that divides the packet's. None for a packet of another format.
    fn part_length(&self, length: usize) -> Option<usize> {
        if self.lengths.is_empty() || self.lengths.contains(&length) {
            return Some(length);
        }
        let mut parts =
            self.lengths.iter().copied().filter(|part| *part > 0 && length > 0 && length.is_multiple_of(*part));
        // Of two lengths that divide it, neither is known.
        parts.next().filter(|_| parts.next().is_none())
    }

    /// True for a packet with the mark of the program's other packets.
    fn is_other(&self, others: &Others, packet: &[u8]) -> bool {
        let found = number(packet, others.at, others.kind, self.byte_order);
        others.values.iter().any(|value| found == Some(f64::from(*value)))
    }

    /// A packet of text, behind its head.
    fn text<'a>(&self, packet: &'a [u8]) -> Result<&'a str, Dropped> {
        if !self.lengths.is_empty() && !self.lengths.contains(&packet.len()) {
            return Err(Dropped::Length(packet.len()));
        }
        let body = packet.strip_prefix(self.head.as_bytes()).ok_or(Dropped::Head)?;
        str::from_utf8(body).map_err(|_| Dropped::Field(Quantity::Ax))
    }

    fn sample_of(&self, record: &Record, length: usize) -> Result<Sample, Dropped> {
        let mut values = [None; QUANTITY_COUNT];
        let further = self.variants.iter().filter(|variant| variant.lengths.contains(&length));
        let player = match further.clone().find_map(|variant| variant.player.as_ref()).or(self.player.as_ref()) {
            Some(player) => Some((player, self.player_of(player, record).ok_or(Dropped::Player)?)),
            None => None,
        };
        for (quantity, field) in self.fields.iter().chain(further.flat_map(|variant| &variant.fields)) {
            // Without these a packet of text says nothing.
            let is_needed = matches!(quantity, Quantity::Ax | Quantity::Ay);
            let optional = matches!(self.layout, Layout::Csv | Layout::Json) && !is_needed;
            match self.read(record, *quantity, field, player) {
                Some(value) => values[*quantity as usize] = Some(value * factor(field)),
                None if optional => (),
                None => return Err(Dropped::Field(*quantity)),
            }
        }
        Ok(self.sample(&values))
    }

    /// The player's number.
    fn player_of(&self, player: &Player, record: &Record) -> Option<usize> {
        // Most vehicles in a list.
        const MAX_PLAYERS: f64 = 1024.0;
        let found = match (&player.at, record) {
            (FieldAddress::Index(at), Record::Binary(bytes)) => number(bytes, *at, player.kind, self.byte_order),
            (FieldAddress::Index(at), Record::Line(line)) => line.column(*at),
            (FieldAddress::Key(key), Record::Json(object)) => value(at_path(object, key)?),
            _ => None,
        };
        found.filter(|number| (0.0..MAX_PLAYERS).contains(number)).map(|number| number as usize)
    }

    fn read(&self, record: &Record, quantity: Quantity, field: &Field, of: Option<(&Player, usize)>) -> Option<f64> {
        let of = of.filter(|_| field.of_player);
        let further = of.map_or(0, |(player, number)| player.first + number * player.stride);
        match (&field.at, record) {
            (FieldAddress::Index(at), Record::Binary(bytes)) => {
                number(bytes, at + further, field.kind, self.byte_order)
            }
            (FieldAddress::Index(at), Record::Pairs(body)) => paired(body, *at),
            (FieldAddress::Index(at), Record::Line(line @ Line::Columns { .. })) => line.column(at + further),
            (FieldAddress::Index(_), Record::Line(line)) => {
                line.value(quantity.word()).or_else(|| field.keys.iter().find_map(|key| line.value(key)))
            }
            (FieldAddress::Key(key), Record::Line(line)) => line.value(key),
            (FieldAddress::Key(key), Record::Json(object)) => match of {
                Some((_, number)) => value(at_path(object, &key.replace("{player}", &number.to_string()))?),
                None => value(at_path(object, key)?),
            },
            _ => None,
        }
    }

    /// Description of a packet of another format: its length, those of this format, and the shipped
    /// formats that it fits.
    pub fn explain(&self, packet: &[u8], port: u16) -> String {
        let lengths: Vec<String> = self.lengths.iter().map(usize::to_string).collect();
        let expected = match lengths.as_slice() {
            [] => String::new(),
            lengths => format!("; {} has {}", self.name, lengths.join(" or ")),
        };
        let why = match self.decode(packet) {
            Err(Dropped::Length(_)) | Ok(_) => String::new(),
            Err(dropped) => format!(" ({} expects otherwise: {dropped})", self.name),
        };
        let fitting: Vec<&str> = SHIPPED_FORMATS
            .iter()
            .filter(|(name, text)| *name != self.name && text.parse::<Format>().is_ok_and(|of| of.fits(packet)))
            .map(|(name, _)| *name)
            .collect();
        let advice = match fitting.as_slice() {
            [] => "no format of moris-live fits; write a table for it".to_owned(),
            [one] => format!("{one} fits: --format {one}"),
            some => format!("these fit: {}", some.join(", ")),
        };
        format!("{}-byte packets arrive on {port}{expected}{why}: {advice}", packet.len())
    }

    /// True if a packet has this format's length or head, and plausible numbers.
    fn fits(&self, packet: &[u8]) -> bool {
        let is_plain = self.lengths.is_empty() && self.head.is_empty() && self.layout == Layout::Binary;
        !is_plain && self.decode(packet).is_ok_and(|sample| sample.is_plausible())
    }

    fn sample(&self, values: &[Option<f64>; QUANTITY_COUNT]) -> Sample {
        use Quantity::*;
        let of = |quantity: Quantity| values[quantity as usize];
        let vector = |names: [Quantity; 3]| Vector3::from_fn(|k, _| of(names[k]).unwrap_or(0.0));
        let all = |names: [Quantity; 3]| names.into_iter().all(|name| of(name).is_some());
        let quaternion = QUATERNION_QUANTITIES.map(of);
        let has_quaternion = quaternion.iter().all(Option::is_some);
        let angles = if has_quaternion {
            angles_of(quaternion.map(Option::unwrap_or_default))
        } else {
            RollPitchYaw::from_vector(vector([Roll, Pitch, Yaw]))
        };
        let rotation = Orientation::new(angles).rotation;
        let to_body = |vector: Vector3<f64>, axes: Axes| match axes {
            Axes::Body => vector,
            Axes::World => rotation.tr_mul(&vector),
        };
        let mut force = to_body(vector([Ax, Ay, Az]), self.force_axes);
        match self.gravity {
            Gravity::Removed => force += rotation.tr_mul(&(Vector3::z() * STANDARD_GRAVITY)),
            Gravity::Included if of(Az).is_none() => force.z = STANDARD_GRAVITY,
            Gravity::Included => (),
        }
        let rates = to_body(vector([Wx, Wy, Wz]), self.rate_axes);
        let speed = of(Speed).unwrap_or_else(|| vector([Vx, Vy, Vz]).norm());
        Sample {
            time: of(Time),
            motion: Motion::new(force, rates, angles, speed),
            position: (of(X).is_some() && of(Y).is_some()).then(|| vector([X, Y, Z])),
            paused: of(Paused).is_some_and(|paused| paused != 0.0) || of(Running).is_some_and(|running| running == 0.0),
            has_angles: has_quaternion || all([Roll, Pitch, Yaw]),
        }
    }
}

/// The angles of a quaternion of any size, as of 16-bit numbers; none of one that is zero.
fn angles_of([w, x, y, z]: [f64; 4]) -> RollPitchYaw {
    let Some(quaternion) = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), f64::MIN_POSITIVE) else {
        return RollPitchYaw::new(f64::NAN, f64::NAN, f64::NAN);
    };
    let (roll, pitch, yaw) = quaternion.euler_angles();
    RollPitchYaw::new(roll, pitch, yaw)
}

/// The value of a key, or of keys in keys and numbers in lists with dots between them.
fn at_path<'a>(object: &'a Value, path: &str) -> Option<&'a Value> {
    let inner = |object: &'a Value, key: &str| match object {
        Value::Array(list) => list.get(key.parse::<usize>().ok()?),
        _ => object.get(key),
    };
    object.get(path).or_else(|| path.split('.').try_fold(object, inner))
}

/// A binary number at an offset.
fn number(packet: &[u8], at: usize, kind: Number, order: ByteOrder) -> Option<f64> {
    macro_rules! read {
        ($type:ty) => {{
            let bytes = packet.get(at..)?.first_chunk()?;
            match order {
                ByteOrder::Little => <$type>::from_le_bytes(*bytes) as f64,
                ByteOrder::Big => <$type>::from_be_bytes(*bytes) as f64,
            }
        }};
    }
    Some(match kind {
        Number::U8 => read!(u8),
        Number::I8 => read!(i8),
        Number::U16 => read!(u16),
        Number::I16 => read!(i16),
        Number::U32 => read!(u32),
        Number::I32 => read!(i32),
        Number::U64 => read!(u64),
        Number::F32 => read!(f32),
        Number::F64 => read!(f64),
    })
}

/// The float that a list of pairs has for a number.
fn paired(body: &[u8], index: usize) -> Option<f64> {
    let (pairs, _) = body.as_chunks::<8>();
    pairs.iter().find_map(|[a, b, c, d, value @ ..]| {
        let number = i32::from_le_bytes([*a, *b, *c, *d]);
        (usize::try_from(number) == Ok(index)).then(|| f64::from(f32::from_le_bytes(*value)))
    })
}

fn value(value: &Value) -> Option<f64> {
    value.as_f64().or_else(|| value.as_bool().map(f64::from))
}

/// The factor from a field's number to the washout's unit.
fn factor(field: &Field) -> f64 {
    let unit = match field.unit {
        Some(Unit::G) => STANDARD_GRAVITY,
        Some(Unit::DegreePerSecond | Unit::Degree) => std::f64::consts::PI / 180.0,
        Some(Unit::KilometrePerHour) => 1.0 / 3.6,
        Some(Unit::MilePerHour) => 0.44704,
        Some(Unit::Millisecond) => 1e-3,
        _ => 1.0,
    };
    field.scale * unit
}
