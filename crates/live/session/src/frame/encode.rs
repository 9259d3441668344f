//! A template's tokens to bytes.

use std::io::Write;
use std::ops::Range;

use moris_washout::Rig;
use nalgebra::Vector3;

use super::motors::{MOTOR_UNITS, Motors};
use super::report::report;
use super::{Frames, FramesError};
use crate::session::Commands;

/// Quantities of a frame besides the actuators' positions, in SI units. A length is the arc of the
/// arm's end of a crank, and a velocity its rate. Angles of a crank's motor, such as `degrees1`,
/// are quantities as well: radians, degrees, pulse and steps.
pub const FRAME_QUANTITIES: &str = "time length1 length2 length3 length4 length5 length6 \
    velocity1 velocity2 velocity3 velocity4 velocity5 velocity6 x y z roll pitch yaw fx fy fz heave own_x own_y own_z";
/// Place of the first motor's angle, which follow the quantities: six of each unit.
const FIRST_ANGLE_PLACE: usize = 26;

/// Values of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Values {
    /// Time \[s\].
    pub time: f64,
    /// Lengths of the actuators, or arcs of the cranks' arms \[m\].
    pub length: [f64; 6],
    /// Rates of the lengths \[m/s\].
    pub velocity: [f64; 6],
    /// Position of the platform \[m\], its roll, pitch and yaw \[rad\].
    pub pose: [f64; 6],
    /// Felt specific force \[m/s2\].
    pub force: [f64; 3],
    /// Height of the platform above neutral \[m\].
    pub heave: f64,
    /// The same without the way between the lowest pose and neutral \[m\], for a base that goes it
    /// by itself.
    pub heave_above: f64,
    /// Displacement of the platform from neutral in its own turned axes \[m\].
    pub own: [f64; 3],
    /// Number of the frame, from 0.
    pub count: u32,
}

impl From<&Commands> for Values {
    fn from(commands: &Commands) -> Self {
        let Commands { time, length, velocity, pose, heave, washout, .. } = commands;
        let (p, o) = (pose.position, pose.orientation.angles);
        Values {
            time: *time,
            length: *length,
            velocity: *velocity,
            pose: [p.x, p.y, p.z, o.roll, o.pitch, o.yaw],
            force: washout.felt_specific_force.into(),
            heave: *heave,
            heave_above: heave - (p.z - washout.position.z),
            own: pose.orientation.rotation.tr_mul(&Vector3::new(p.x, p.y, *heave)).into(),
            count: 0,
        }
    }
}

impl Values {
    fn quantity(&self, place: usize) -> f64 {
        let values = self.length.iter().chain(&self.velocity).chain(&self.pose).chain(&self.force).chain([&self.heave]);
        let values = values.chain(&self.own);
        std::iter::once(&self.time).chain(values).nth(place).copied().unwrap_or_default()
    }
}

/// A part of a frame.
#[derive(Clone, Debug, PartialEq)]
enum Token {
    Bytes(Vec<u8>),
    Number(Source, Form),
}

/// Meaning of a number in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    /// An actuator's position in its stroke, spread over the range.
    Leg(usize),
    /// A quantity by its place, times a factor.
    Quantity(usize, f64),
    /// The number of the frame.
    Count,
    /// The sum of the frame's bytes before it, from this one on.
    Sum(usize),
    /// The same by the exclusive or.
    ExclusiveOr(usize),
}

/// Written form of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    Whole(Whole),
    /// A number of 32 or 64 bits.
    Float {
        is_double: bool,
        little: bool,
    },
    /// Digits with so many decimals.
    Decimals(usize),
}

impl Token {
    /// The place of its quantity.
    fn place(&self) -> Option<usize> {
        if let Token::Number(Source::Quantity(place, _), _) = self { Some(*place) } else { None }
    }
}

/// Form of a whole number.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Whole {
    /// Number of its bytes.
    width: usize,
    is_signed: bool,
    little: bool,
    /// The one of its bytes that is sent, the most significant first; none: all.
    half: Option<usize>,
}

impl Whole {
    /// The type's smallest and largest number.
    fn ends(self) -> [i64; 2] {
        let bits = 8 * self.width;
        if self.is_signed { [-(1 << (bits - 1)), (1 << (bits - 1)) - 1] } else { [0, (1 << bits) - 1] }
    }
}

impl Form {
    /// The form of a word such as `u16`, `i16le`, `f64`, `6`.
    fn of(word: &str) -> Option<Form> {
        const MAX_DECIMALS: usize = 15;
        let (kind, little) = word.strip_suffix("le").map_or((word, false), |kind| (kind, true));
        let is_signed = kind.starts_with('i');
        let width = match kind {
            "f32" | "f64" => return Some(Form::Float { is_double: kind == "f64", little }),
            "u8" | "i8" => 1,
            "u16" | "i16" => 2,
            "u24" | "i24" => 3,
            "u32" | "i32" => 4,
            _ => return word.parse().ok().filter(|count| *count <= MAX_DECIMALS).map(Form::Decimals),
        };
        Some(Form::Whole(Whole { width, is_signed, little, half: None }))
    }

    /// Adds the number, or the nearest one that the form has.
    fn push(self, number: f64, out: &mut Vec<u8>) {
        let from = out.len();
        let is_little = match self {
            Form::Whole(whole) => {
                let [least, most] = whole.ends();
                let digits = (number.round() as i64).clamp(least, most).to_be_bytes();
                let digits = &digits[digits.len() - whole.width..];
                out.extend(whole.half.map_or(digits, |half| &digits[half..=half]));
                whole.little
            }
            Form::Float { is_double, little } => {
                let (double, single) = (number.to_be_bytes(), (number as f32).to_be_bytes());
                out.extend(if is_double { &double[..] } else { &single });
                little
            }
            Form::Decimals(decimals) => {
                drop(write!(out, "{number:.decimals$}"));
                false
            }
        };
        if is_little {
            out[from..].reverse();
        }
    }
}

/// A message to a device, which is a string of a template.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Message {
    /// The question for the legs' lengths.
    Ask,
    /// The start string.
    Start,
    /// The same to actuators that are where the first frame has them, as is known.
    Begin,
    /// A frame of actuator positions.
    Frame,
    /// The park string.
    Park,
    /// The stop string.
    Stop,
}

/// A template, ready to be filled in.
#[derive(Clone, Debug, PartialEq)]
pub struct Encoder {
    /// The strings by [`Message`].
    strings: Vec<Vec<Token>>,
    /// Numbers for the shortest and the longest actuator; none: all that a whole number has.
    range: Option<[f64; 2]>,
    reversed: [bool; 6],
    stroke: [f64; 2],
    motors: Motors,
}

impl Encoder {
    /// The encoder for a rig's actuators.
    ///
    /// # Errors
    /// A token is unknown, or has angles for a rig with legs.
    pub fn new(frames: &Frames, rig: &Rig) -> Result<Self, FramesError> {
        let encoder = Self::of_any_rig(frames, rig)?;
        if !rig.has_cranks() && encoder.places().any(|place| place >= FIRST_ANGLE_PLACE) {
            return Err(FramesError::Angles);
        }
        Ok(encoder)
    }

    /// As [`Encoder::new`], but with angles for any rig.
    pub(super) fn of_any_rig(frames: &Frames, rig: &Rig) -> Result<Self, FramesError> {
        let strings = [&frames.ask, &frames.start, &frames.start, &frames.frame, &frames.park, &frames.stop];
        let encoder = Encoder {
            strings: strings.into_iter().map(|string| tokens(string)).collect::<Result<_, _>>()?,
            range: frames.range.map(|range| range.map(|end| end as f64)),
            reversed: std::array::from_fn(|leg| frames.reversed.contains(&(leg + 1))),
            stroke: rig.stroke(),
            motors: Motors::new(frames, rig),
        };
        let units = encoder.places().filter_map(|place| place.checked_sub(FIRST_ANGLE_PLACE));
        units.map(|place| place / 6).try_for_each(|unit| encoder.motors.check(unit))?;
        Ok(encoder)
    }

    /// Places of the quantities in all its strings.
    fn places(&self) -> impl Iterator<Item = usize> {
        self.strings.iter().flatten().filter_map(Token::place)
    }

    /// True if its frames have positions of actuators.
    pub fn moves_actuators(&self) -> bool {
        // Places of the lengths and velocities among the quantities.
        const LENGTH_PLACES: Range<usize> = 1..13;
        self.strings[Message::Frame as usize].iter().any(|token| match token {
            Token::Number(Source::Leg(_), _) => true,
            Token::Number(Source::Quantity(place, _), _) => {
                LENGTH_PLACES.contains(place) || *place >= FIRST_ANGLE_PLACE
            }
            _ => false,
        })
    }

    /// Length of the actuators' stroke \[m\].
    pub fn stroke_length(&self) -> f64 {
        self.stroke[1] - self.stroke[0]
    }

    /// Positions of the actuators \[m\] in a controller's answer: lengths or arcs after `legs`, or
    /// angles of motors after the name of a unit. None in other packets.
    pub fn reported(&self, answer: &[u8]) -> Option<[f64; 6]> {
        match report(answer)? {
            (None, lengths) => Some(lengths),
            (Some(unit), numbers) => {
                self.motors.check(unit).ok()?;
                Some(std::array::from_fn(|crank| self.motors.arc(unit, crank, numbers[crank])))
            }
        }
    }

    /// True if it can ask for the legs' lengths.
    pub fn asks(&self) -> bool {
        !self.strings[Message::Ask as usize].is_empty()
    }

    /// Replaces `out` by a string of the template.
    pub fn write(&self, message: Message, values: &Values, out: &mut Vec<u8>) {
        // Ends of the numbers of actuators where a template has none, but for signed ones.
        const SIXTEEN_BITS: [i64; 2] = [0, 65_535];
        out.clear();
        for token in &self.strings[message as usize] {
            let (source, form) = match token {
                Token::Bytes(bytes) => {
                    out.extend(bytes);
                    continue;
                }
                Token::Number(source, form) => (*source, *form),
            };
            let before = |from: usize| out.get(from..).unwrap_or_default().iter();
            let number = match (source, form) {
                (Source::Leg(leg), Form::Whole(whole)) if whole.is_signed => self.number(leg, values, whole.ends()),
                (Source::Leg(leg), _) => self.number(leg, values, SIXTEEN_BITS),
                (Source::Quantity(place, factor), _) => factor * self.quantity(place, values),
                (Source::Count, _) => wrapped(values.count.into(), form),
                (Source::Sum(from), _) => wrapped(before(from).map(|byte| u64::from(*byte)).sum(), form),
                (Source::ExclusiveOr(from), _) => wrapped(before(from).fold(0, |all, byte| all ^ byte).into(), form),
            };
            form.push(number, out);
        }
    }

    fn quantity(&self, place: usize, values: &Values) -> f64 {
        match place.checked_sub(FIRST_ANGLE_PLACE) {
            Some(angle) => self.motors.number(angle / 6, angle % 6, values.length[angle % 6]),
            None => values.quantity(place),
        }
    }

    /// The number for an actuator's length, between these ends where the template has none.
    fn number(&self, leg: usize, values: &Values, ends: [i64; 2]) -> f64 {
        let [first, last] = self.range.unwrap_or(ends.map(|end| end as f64));
        let [shortest, longest] = self.stroke;
        let part = ((values.length[leg] - shortest) / (longest - shortest)).clamp(0.0, 1.0);
        let part = if self.reversed[leg] { 1.0 - part } else { part };
        // A length that is not a number counts as the shortest, and no zero is negative.
        (first + part * (last - first)).round() as i64 as f64
    }
}

/// The lowest bits of a number, as many as the form has.
fn wrapped(number: u64, form: Form) -> f64 {
    if let Form::Whole(whole) = form { (number % (1 << (8 * whole.width))) as f64 } else { number as f64 }
}

/// The tokens of a template.
fn tokens(template: &str) -> Result<Vec<Token>, FramesError> {
    // Most bytes of a template.
    const MAX_TEMPLATE_BYTES: usize = 4096;
    let mut tokens = Vec::new();
    let mut rest = template.trim_start();
    if template.len() > MAX_TEMPLATE_BYTES {
        return Err(FramesError::Range("a template has at most 4096 characters"));
    }
    while !rest.is_empty() {
        let (token, after) = match rest.strip_prefix('\'') {
            Some(text) => {
                let (text, after) = text.split_once('\'').ok_or_else(|| FramesError::Token(rest.to_owned()))?;
                (Token::Bytes(text.into()), after)
            }
            None => {
                let end = rest.find(|c: char| c.is_whitespace() || c == '\'').unwrap_or(rest.len());
                let (word, after) = rest.split_at(end);
                (token(word).ok_or_else(|| FramesError::Token(word.to_owned()))?, after)
            }
        };
        tokens.push(token);
        rest = after.trim_start();
    }
    Ok(tokens)
}

/// The token of a word: a byte, or `what:form`.
fn token(word: &str) -> Option<Token> {
    let Some((name, form)) = word.split_once(':') else {
        let byte = u8::from_str_radix(word, 16).ok().filter(|_| word.len() == 2)?;
        return Some(Token::Bytes(vec![byte]));
    };
    let half = |half| Some(Form::Whole(Whole { width: 2, is_signed: false, little: false, half: Some(half) }));
    let (kind, from) = name.split_once('@').unwrap_or((name, "0"));
    let source = match (kind, from.parse().ok()?) {
        ("count", 0) => Source::Count,
        ("sum", from) => Source::Sum(from),
        ("xor", from) => Source::ExclusiveOr(from),
        _ if name.starts_with("leg") => Source::Leg(number_of("leg", name)? - 1),
        _ => {
            let (kind, factor) = form.split_once('*').unwrap_or((form, "1"));
            let factor = factor.parse().ok().filter(|factor: &f64| factor.is_finite())?;
            return Some(Token::Number(Source::Quantity(place_of(name)?, factor), Form::of(kind)?));
        }
    };
    let form = match (source, form) {
        (Source::Leg(_), "dec") => Some(Form::Decimals(0)),
        (Source::Leg(_), "hi") => half(0),
        (Source::Leg(_), "lo") => half(1),
        _ => Form::of(form).filter(|form| match form {
            Form::Whole(whole) => !whole.is_signed || matches!(source, Source::Leg(_)),
            _ => false,
        }),
    };
    Some(Token::Number(source, form?))
}

/// The place of a quantity, or of a motor's angle.
fn place_of(name: &str) -> Option<usize> {
    let angles = MOTOR_UNITS.iter().zip((FIRST_ANGLE_PLACE..).step_by(6));
    let angle = angles.filter_map(|(unit, first)| Some(first + number_of(unit, name)? - 1));
    FRAME_QUANTITIES.split(' ').position(|quantity| quantity == name).or(angle.last())
}

/// Number of the actuator behind a prefix of its name.
fn number_of(prefix: &str, name: &str) -> Option<usize> {
    name.strip_prefix(prefix)?.parse().ok().filter(|number| (1..=6).contains(number))
}
