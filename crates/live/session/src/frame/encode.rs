//! A template's tokens to bytes.

use std::io::Write;
use std::ops::Range;

use nalgebra::Vector3;

use super::{Frames, FramesError};
use crate::session::Commands;

/// Quantities of a frame besides the actuators' positions, in SI units.
pub const QUANTITIES: &str = "time length1 length2 length3 length4 length5 length6 \
    velocity1 velocity2 velocity3 velocity4 velocity5 velocity6 x y z roll pitch yaw fx fy fz heave own_x own_y own_z";
/// Places of the lengths and velocities among them.
const LENGTHS: Range<usize> = 1..13;
/// Most bytes of a template.
const MOST: usize = 4096;
/// Most decimals of a quantity.
const DECIMALS: usize = 15;

/// Values of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Values {
    /// Time \[s\].
    pub time: f64,
    /// Lengths of the actuators \[m\].
    pub length: [f64; 6],
    /// Velocities of the legs \[m/s\].
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
    /// These bytes of an actuator's number of so many bytes, the most significant first.
    Binary {
        leg: usize,
        width: usize,
        sent: Range<usize>,
        little: bool,
    },
    Decimal {
        leg: usize,
    },
    Quantity {
        place: usize,
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

/// A template, ready to be filled in.
#[derive(Clone, Debug, PartialEq)]
pub struct Encoder {
    ask: Vec<Token>,
    start: Vec<Token>,
    frame: Vec<Token>,
    park: Vec<Token>,
    stop: Vec<Token>,
    range: [f64; 2],
    reversed: [bool; 6],
    stroke: [f64; 2],
}

impl Encoder {
    /// The encoder for actuators of these shortest and longest lengths \[m\].
    ///
    /// # Errors
    /// A token is unknown.
    pub fn new(frames: &Frames, stroke: [f64; 2]) -> Result<Self, FramesError> {
        Ok(Encoder {
            ask: tokens(&frames.ask)?,
            start: tokens(&frames.start)?,
            frame: tokens(&frames.frame)?,
            park: tokens(&frames.park)?,
            stop: tokens(&frames.stop)?,
            range: frames.range.map(|end| end as f64),
            reversed: std::array::from_fn(|leg| frames.reversed.contains(&(leg + 1))),
            stroke,
        })
    }

    /// True if its frames have positions of actuators.
    pub fn moves_actuators(&self) -> bool {
        self.frame.iter().any(|token| match token {
            Token::Binary { .. } | Token::Decimal { .. } => true,
            Token::Quantity { place, .. } | Token::Float { place, .. } => LENGTHS.contains(place),
            Token::Bytes(_) => false,
        })
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
        out.clear();
        for token in tokens {
            match token {
                Token::Bytes(bytes) => out.extend(bytes),
                Token::Binary { leg, width, sent, little } => {
                    let number = self.number(*leg, values).clamp(0, (1 << (8 * width)) - 1);
                    let digits = number.to_be_bytes();
                    let digits = &digits[digits.len() - width..][sent.clone()];
                    if *little { out.extend(digits.iter().rev()) } else { out.extend(digits) }
                }
                // Writing to a vector cannot fail.
                Token::Decimal { leg } => drop(write!(out, "{}", self.number(*leg, values))),
                Token::Float { place, factor, is_double, little } => {
                    let value = factor * values.quantity(*place);
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
                Token::Quantity { place, decimals } => {
                    drop(write!(out, "{:.decimals$}", values.quantity(*place)));
                }
            }
        }
    }

    /// The number for an actuator's length.
    fn number(&self, leg: usize, values: &Values) -> i64 {
        let [shortest, longest] = self.stroke;
        let part = ((values.length[leg] - shortest) / (longest - shortest)).clamp(0.0, 1.0);
        let part = if self.reversed[leg] { 1.0 - part } else { part };
        // A length that is not a number counts as the shortest.
        (self.range[0] + part * (self.range[1] - self.range[0])).round() as i64
    }
}

/// The tokens of a template.
fn tokens(template: &str) -> Result<Vec<Token>, FramesError> {
    let mut tokens = Vec::new();
    let mut rest = template.trim_start();
    if template.len() > MOST {
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
    let Some((name, form)) = word.split_once(':') else {
        let byte = u8::from_str_radix(word, 16).ok().filter(|_| word.len() == 2)?;
        return Some(Token::Bytes(vec![byte]));
    };
    let Some(leg) = name.strip_prefix("leg") else {
        let place = QUANTITIES.split(' ').position(|quantity| quantity == name)?;
        let (kind, factor) = form.split_once('*').unwrap_or((form, "1"));
        if let Some(bits) = kind.strip_prefix('f') {
            let (bits, little) = bits.strip_suffix("le").map_or((bits, false), |bits| (bits, true));
            let factor = factor.parse().ok().filter(|factor: &f64| factor.is_finite())?;
            let is_double = match bits {
                "64" => true,
                "32" => false,
                _ => return None,
            };
            return Some(Token::Float { place, factor, is_double, little });
        }
        return Some(Token::Quantity { place, decimals: form.parse().ok().filter(|count| *count <= DECIMALS)? });
    };
    let leg = leg.parse::<usize>().ok().filter(|leg| (1..=6).contains(leg))? - 1;
    let (kind, little) = form.strip_suffix("le").map_or((form, false), |kind| (kind, true));
    let (width, sent) = match kind {
        "dec" if !little => return Some(Token::Decimal { leg }),
        "hi" if !little => (2, 0..1),
        "lo" if !little => (2, 1..2),
        "u8" => (1, 0..1),
        "u16" => (2, 0..2),
        "u24" => (3, 0..3),
        "u32" => (4, 0..4),
        _ => return None,
    };
    Some(Token::Binary { leg, width, sent, little })
}
