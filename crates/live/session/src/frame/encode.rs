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
    /// Bytes of an actuator's number, the most significant first.
    Binary {
        leg: usize,
        whole: Whole,
        sent: Range<usize>,
    },
    /// A quantity times a factor as a whole number.
    Scaled {
        place: usize,
        factor: f64,
        whole: Whole,
    },
    /// The number of the frame.
    Count(Whole),
    /// A checksum of the frame's bytes before it, from this one on.
    Checksum {
        kind: Checksum,
        from: usize,
        whole: Whole,
    },
    Decimal {
        leg: usize,
    },
    Quantity {
        place: usize,
        factor: f64,
        decimals: usize,
    },
    /// A quantity times a factor, as a number of 32 or 64 bits.
    Float {
        place: usize,
        factor: f64,
        is_double: bool,
        little: bool,
    },
}

impl Token {
    /// The place of its quantity.
    fn place(&self) -> Option<usize> {
        match self {
            Token::Quantity { place, .. } | Token::Float { place, .. } | Token::Scaled { place, .. } => Some(*place),
            _ => None,
        }
    }
}

/// Form of a whole number.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Whole {
    /// Number of its bytes.
    width: usize,
    is_signed: bool,
    little: bool,
}

impl Whole {
    /// The form of a word such as `u16`, `i16le`.
    fn of(word: &str) -> Option<Whole> {
        let (kind, little) = word.strip_suffix("le").map_or((word, false), |kind| (kind, true));
        let (kind, is_signed) = match kind.strip_prefix('i') {
            Some(bits) => (bits, true),
            None => (kind.strip_prefix('u')?, false),
        };
        let width = match kind {
            "8" => 1,
            "16" => 2,
            "24" => 3,
            "32" => 4,
            _ => return None,
        };
        Some(Whole { width, is_signed, little })
    }

    /// The type's smallest and largest number.
    fn ends(self) -> [i64; 2] {
        let bits = 8 * self.width;
        if self.is_signed { [-(1 << (bits - 1)), (1 << (bits - 1)) - 1] } else { [0, (1 << bits) - 1] }
    }

    /// Adds the number, or the nearest one that it has, and of its bytes these, the
    /// most significant first.
    fn push(self, number: i64, sent: Range<usize>, out: &mut Vec<u8>) {
        let [least, most] = self.ends();
        let digits = number.clamp(least, most).to_be_bytes();
        let digits = &digits[digits.len() - self.width..][sent];
        if self.little { out.extend(digits.iter().rev()) } else { out.extend(digits) }
    }
}

/// Kind of a checksum.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Checksum {
    Sum,
    ExclusiveOr,
}

impl Checksum {
    fn of(self, bytes: &[u8]) -> i64 {
        match self {
            Checksum::Sum => bytes.iter().map(|byte| i64::from(*byte)).sum(),
            Checksum::ExclusiveOr => i64::from(bytes.iter().fold(0, |all, byte| all ^ byte)),
        }
    }
}

/// A template, ready to be filled in.
#[derive(Clone, Debug, PartialEq)]
pub struct Encoder {
    ask: Vec<Token>,
    start: Vec<Token>,
    frame: Vec<Token>,
    park: Vec<Token>,
    stop: Vec<Token>,
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
        let encoder = Encoder {
            ask: tokens(&frames.ask)?,
            start: tokens(&frames.start)?,
            frame: tokens(&frames.frame)?,
            park: tokens(&frames.park)?,
            stop: tokens(&frames.stop)?,
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
        let all = [&self.ask, &self.start, &self.frame, &self.park, &self.stop];
        all.into_iter().flatten().filter_map(Token::place)
    }

    /// True if its frames have positions of actuators.
    pub fn moves_actuators(&self) -> bool {
        // Places of the lengths and velocities among the quantities.
        const LENGTH_PLACES: Range<usize> = 1..13;
        self.frame.iter().any(|token| match (token, token.place()) {
            (Token::Binary { .. } | Token::Decimal { .. }, _) => true,
            (_, Some(place)) => LENGTH_PLACES.contains(&place) || place >= FIRST_ANGLE_PLACE,
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
        !self.ask.is_empty()
    }

    /// Replaces `out` by the question for the legs' lengths.
    pub fn ask(&self, out: &mut Vec<u8>) {
        self.fill(&self.ask, &Values::default(), out);
    }

    /// Replaces `out` by the start string.
    pub fn start(&self, values: &Values, out: &mut Vec<u8>) {
        self.fill(&self.start, values, out);
    }

    /// Replaces `out` by a frame.
    pub fn frame(&self, values: &Values, out: &mut Vec<u8>) {
        self.fill(&self.frame, values, out);
    }

    /// Replaces `out` by the park string.
    pub fn park(&self, values: &Values, out: &mut Vec<u8>) {
        self.fill(&self.park, values, out);
    }

    /// Replaces `out` by the stop string.
    pub fn stop(&self, values: &Values, out: &mut Vec<u8>) {
        self.fill(&self.stop, values, out);
    }

    fn fill(&self, tokens: &[Token], values: &Values, out: &mut Vec<u8>) {
        // Ends of the numbers of actuators where a template has none, but for signed ones.
        const SIXTEEN_BITS: [i64; 2] = [0, 65_535];
        out.clear();
        for token in tokens {
            match token {
                Token::Bytes(bytes) => out.extend(bytes),
                Token::Binary { leg, whole, sent } => {
                    let ends = if whole.is_signed { whole.ends() } else { SIXTEEN_BITS };
                    whole.push(self.number(*leg, values, ends), sent.clone(), out);
                }
                Token::Scaled { place, factor, whole } => {
                    whole.push((factor * self.quantity(*place, values)).round() as i64, 0..whole.width, out);
                }
                Token::Count(whole) => whole.push(wrapped(values.count.into(), *whole), 0..whole.width, out),
                Token::Checksum { kind, from, whole } => {
                    let sum = kind.of(out.get(*from..).unwrap_or_default());
                    whole.push(wrapped(sum, *whole), 0..whole.width, out);
                }
                // Writing to a vector cannot fail.
                Token::Decimal { leg } => drop(write!(out, "{}", self.number(*leg, values, SIXTEEN_BITS))),
                Token::Float { place, factor, is_double, little } => {
                    let value = factor * self.quantity(*place, values);
                    let from = out.len();
                    if *is_double {
                        out.extend(value.to_be_bytes());
                    } else {
                        out.extend((value as f32).to_be_bytes());
                    }
                    if *little {
                        out[from..].reverse();
                    }
                }
                Token::Quantity { place, factor, decimals } => {
                    drop(write!(out, "{:.decimals$}", factor * self.quantity(*place, values)));
                }
            }
        }
    }

    /// The quantity at a place, or the angle of a motor.
    fn quantity(&self, place: usize, values: &Values) -> f64 {
        match place.checked_sub(FIRST_ANGLE_PLACE) {
            Some(angle) => self.motors.number(angle / 6, angle % 6, values.length[angle % 6]),
            None => values.quantity(place),
        }
    }

    /// The number for an actuator's length, between these ends where the template has none.
    fn number(&self, leg: usize, values: &Values, ends: [i64; 2]) -> i64 {
        let [first, last] = self.range.unwrap_or(ends.map(|end| end as f64));
        let [shortest, longest] = self.stroke;
        let part = ((values.length[leg] - shortest) / (longest - shortest)).clamp(0.0, 1.0);
        let part = if self.reversed[leg] { 1.0 - part } else { part };
        // A length that is not a number counts as the shortest.
        (first + part * (last - first)).round() as i64
    }
}

/// A number that begins at 0 again beyond the last one of its form.
fn wrapped(number: i64, whole: Whole) -> i64 {
    number.rem_euclid(1 << (8 * whole.width))
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

fn token(word: &str) -> Option<Token> {
    // Most decimals of a quantity.
    const MAX_DECIMALS: usize = 15;
    let Some((name, form)) = word.split_once(':') else {
        let byte = u8::from_str_radix(word, 16).ok().filter(|_| word.len() == 2)?;
        return Some(Token::Bytes(vec![byte]));
    };
    if let Some(token) = of_frame(name, form) {
        return Some(token);
    }
    let Some(leg) = name.strip_prefix("leg") else {
        let place = place_of(name)?;
        let (kind, factor) = form.split_once('*').unwrap_or((form, "1"));
        let factor = factor.parse().ok().filter(|factor: &f64| factor.is_finite())?;
        if let Some(bits) = kind.strip_prefix('f') {
            let (bits, little) = bits.strip_suffix("le").map_or((bits, false), |bits| (bits, true));
            let is_double = match bits {
                "64" => true,
                "32" => false,
                _ => return None,
            };
            return Some(Token::Float { place, factor, is_double, little });
        }
        if let Some(whole) = Whole::of(kind) {
            return Some(Token::Scaled { place, factor, whole });
        }
        let decimals = kind.parse().ok().filter(|count| *count <= MAX_DECIMALS)?;
        return Some(Token::Quantity { place, factor, decimals });
    };
    let leg = leg.parse::<usize>().ok().filter(|leg| (1..=6).contains(leg))? - 1;
    let half = |sent| Token::Binary { leg, whole: Whole { width: 2, is_signed: false, little: false }, sent };
    match form {
        "dec" => Some(Token::Decimal { leg }),
        "hi" => Some(half(0..1)),
        "lo" => Some(half(1..2)),
        _ => Whole::of(form).map(|whole| Token::Binary { leg, whole, sent: 0..whole.width }),
    }
}

/// The place of a quantity, or of a motor's angle.
fn place_of(name: &str) -> Option<usize> {
    let angles = MOTOR_UNITS.iter().zip((FIRST_ANGLE_PLACE..).step_by(6));
    let angle = angles.filter_map(|(unit, first)| {
        let crank = name.strip_prefix(unit)?.parse::<usize>().ok().filter(|crank| (1..=6).contains(crank))?;
        Some(first + crank - 1)
    });
    FRAME_QUANTITIES.split(' ').position(|quantity| quantity == name).or(angle.last())
}

/// A counter, or a checksum from a byte on: `count:u8`, `sum:u8`, `xor@2:u8`.
fn of_frame(name: &str, form: &str) -> Option<Token> {
    let unsigned = || Whole::of(form).filter(|whole| !whole.is_signed);
    let (name, from) = name.split_once('@').unwrap_or((name, "0"));
    let from = from.parse().ok()?;
    let kind = match name {
        "count" if from == 0 => return unsigned().map(Token::Count),
        "sum" => Checksum::Sum,
        "xor" => Checksum::ExclusiveOr,
        _ => return None,
    };
    unsigned().map(|whole| Token::Checksum { kind, from, whole })
}
