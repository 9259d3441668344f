//! Text of a recorded session: its parameters and settings, each event with its step, and a digest
//! of all commands.
//!
//! Numbers are written so that they are read back to the bit. A session is recorded by writing
//! [`header`] and each [`Entry`] in order, and repeated by [`replay`].

use std::fmt::{self, Display, Formatter, Write};

use moris_interface::{Group, Kind, ParameterError, Reader, Slot, refuse, slots_of};
use moris_laps::Laps;
use moris_washout::Parameters;

use crate::legs::Legs;
use crate::motion::{Motion, Sample};
use crate::session::{Commands, Session, Settings};
use crate::transitions::Event;

/// First line of a recorded session.
const HEADER_LINE: &str = "moris-live-session,1";
/// Beginning of a line of the road that is known at first.
const ROAD_PREFIX: &str = "road,";

/// Something from outside that a session has received before a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Happening {
    /// An event of the operator or the device.
    Event(Event),
    /// A sample that arrived at this time of the session \[s\].
    Sample(f64, Sample),
    /// The place of the legs.
    Legs(Legs),
    /// The session's clock has slipped by this time \[s\].
    Slip(f64),
    /// A value of a parameter has been chosen, by its slot.
    Choice(u16, f64),
    /// The chosen parameters come into force.
    Retune,
    /// The session's end, with the digest of all commands.
    End(u64),
}

/// A line of a recorded session.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Steps before it.
    pub step: u64,
    /// The event, sample or end.
    pub happening: Happening,
}

/// Digest of all commands of a session (FNV-1a, 64 bits).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(pub u64);

impl Default for Digest {
    fn default() -> Self {
        Digest(0xcbf2_9ce4_8422_2325)
    }
}

impl Digest {
    /// Takes the commands of a step.
    pub fn take(&mut self, commands: &Commands) {
        let bits = commands.length.iter().map(|length| length.to_bits());
        for word in bits.chain([commands.state as u64]) {
            for byte in word.to_le_bytes() {
                self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        }
    }
}

/// The lines before the events. `laps` are those that a session knows that learns the road.
pub fn header(parameters: &Parameters, settings: &Settings, laps: Option<&Laps>) -> String {
    let mut text = format!("{HEADER_LINE}\nsettings,{}\n", serde_json::to_string(settings).unwrap_or_default());
    for (slot, value) in slots_of(parameters).iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "parameter,{},{value:?}", name_of(slot));
    }
    for line in laps.map(Laps::text).unwrap_or_default().lines() {
        text += &format!("{ROAD_PREFIX}{line}\n");
    }
    text
}

/// The name of a parameter's slot; none beyond the last.
pub fn name_of(slot: usize) -> String {
    let name = |slot: &Slot| Parameters::ROWS[usize::from(slot.row)].variable_name(usize::from(slot.element));
    Parameters::SLOTS.get(slot).map(name).unwrap_or_default()
}

/// Checks that a parameter's slot may have a value: a whole number for one of several items.
///
/// # Errors
/// The parameter, and why not.
pub fn check_value(slot: usize, value: f64) -> Result<(), ParameterError> {
    let Some(place) = Parameters::SLOTS.get(slot) else { return Ok(()) };
    let row = &Parameters::ROWS[usize::from(place.row)];
    let is_whole = matches!(row.kind, Kind::Real(_)) || value.fract() == 0.0;
    if row.accepts(value) && is_whole { Ok(()) } else { refuse(name_of(slot), row.reason(value)) }
}

/// The slot of a parameter.
pub fn slot_of(name: &str) -> Option<usize> {
    (0..Parameters::SLOTS.len()).find(|slot| name_of(*slot) == name)
}

impl Display for Entry {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let list = |numbers: &[f64]| numbers.iter().map(|number| format!(",{number:?}")).collect::<String>();
        write!(f, "{},", self.step)?;
        match &self.happening {
            Happening::Event(event) => write!(f, "event,{}", event.name()),
            Happening::End(digest) => write!(f, "end,{digest:016x}"),
            Happening::Choice(slot, value) => write!(f, "parameter,{},{value:?}", name_of(usize::from(*slot))),
            Happening::Legs(Legs::Reported(lengths)) => write!(f, "legs,reported{}", list(lengths)),
            Happening::Legs(legs) => write!(f, "legs,{}", legs.name()),
            Happening::Slip(time) => write!(f, "slip,{time:?}"),
            Happening::Retune => write!(f, "retune"),
            Happening::Sample(arrival, sample) => {
                let time = sample.time.map_or(String::new(), |time| format!("{time:?}"));
                let position = sample.position.map_or(",,,".to_owned(), |position| list(position.as_slice()));
                let [paused, has_angles] = [sample.paused, sample.has_angles].map(u8::from);
                let motion = list(sample.motion.0.as_slice());
                write!(f, "sample,{arrival:?},{time}{position},{paused},{has_angles}{motion}")
            }
        }
    }
}

impl Entry {
    /// The entry of a line; none if it is no entry.
    pub fn of_line(line: &str) -> Option<Entry> {
        let mut fields = line.split(',');
        let step = fields.next()?.parse().ok()?;
        let kind = fields.next()?;
        let happening = match kind {
            "event" => Happening::Event(Event::named(fields.next()?)?),
            "end" => Happening::End(u64::from_str_radix(fields.next()?, 16).ok()?),
            "parameter" => Happening::Choice(slot_of(fields.next()?)? as u16, fields.next()?.parse().ok()?),
            "retune" => Happening::Retune,
            "slip" => Happening::Slip(fields.next()?.parse().ok()?),
            "legs" => Happening::Legs(match fields.next()? {
                "reported" => Legs::Reported(numbers(&mut fields)?),
                name => Legs::named(name)?,
            }),
            "sample" => {
                let mut optional = || match fields.next()? {
                    "" => Some(None),
                    field => field.parse().ok().map(Some),
                };
                let (arrival, time) = (optional()??, optional()?);
                let position = [optional()?, optional()?, optional()?];
                let position = if let [Some(x), Some(y), Some(z)] = position { Some([x, y, z].into()) } else { None };
                let [paused, has_angles] = [fields.next()? == "1", fields.next()? == "1"];
                let motion = Motion(numbers(&mut fields)?.into());
                Happening::Sample(arrival, Sample { time, motion, position, paused, has_angles })
            }
            _ => return None,
        };
        fields.next().is_none().then_some(Entry { step, happening })
    }
}

/// The next numbers of a line.
fn numbers<'a, const N: usize>(fields: &mut impl Iterator<Item = &'a str>) -> Option<[f64; N]> {
    let mut numbers = [0.0; N];
    for number in &mut numbers {
        *number = fields.next()?.parse().ok()?;
    }
    Some(numbers)
}

/// Reason for which a recorded session cannot be repeated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ReplayError {
    /// The text is no recorded session.
    #[error("line {0} is none of a session that this version has recorded by moris-live --record")]
    Line(usize),
    /// A parameter cannot be used.
    #[error(transparent)]
    Parameter(#[from] moris_interface::ParameterError),
}

/// Result of a repeated session.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Replayed {
    /// Number of the session's steps.
    pub steps: u64,
    /// The digest of its commands.
    pub digest: u64,
    /// The digest in the recording; none if the recording was cut off.
    pub recorded: Option<u64>,
}

/// Repeats a recorded session, up to its last whole line. `observe` receives the commands of each
/// step.
///
/// # Errors
/// The text is no recorded session.
pub fn replay(text: &str, mut observe: impl FnMut(&Session)) -> Result<Replayed, ReplayError> {
    // Most steps of a session: eleven days.
    const MAX_STEPS: u64 = 1_000_000_000;
    // A full disk cuts the last line off.
    let whole = text.rfind('\n').map_or(text, |end| &text[..end]);
    let mut lines = whole.lines().enumerate().map(|(place, line)| (place + 1, line)).peekable();
    let first = lines.next().filter(|(_, line)| *line == HEADER_LINE).ok_or(ReplayError::Line(1))?;
    let settings = lines.next().and_then(|(_, line)| line.strip_prefix("settings,"));
    let settings: Settings =
        settings.and_then(|text| serde_json::from_str(text).ok()).ok_or(ReplayError::Line(first.0 + 1))?;
    let mut slots = slots_of(&Parameters::default());
    while let Some((place, line)) = lines.next_if(|(_, line)| line.starts_with("parameter,")) {
        let entry = Entry::of_line(&format!("0,{line}")).map(|entry| entry.happening);
        let Some(Happening::Choice(slot, value)) = entry else { return Err(ReplayError::Line(place)) };
        slots[usize::from(slot)] = value;
    }
    let mut session = Session::new(&Parameters::read(&mut Reader::new(&slots)), &settings)?;
    let (mut road, mut begin) = (String::new(), 0);
    while let Some((place, line)) = lines.next_if(|(_, line)| line.starts_with(ROAD_PREFIX)) {
        begin = if road.is_empty() { place } else { begin };
        road.extend([&line[ROAD_PREFIX.len()..], "\n"]);
    }
    if !road.is_empty() {
        session.learn(Laps::of_text(&road).map_err(|none| ReplayError::Line(begin + none.line - 1))?);
    }
    let mut digest = Digest::default();
    let mut steps = 0;
    for (place, line) in lines {
        let entry = Entry::of_line(line)
            .filter(|entry| (steps..=MAX_STEPS).contains(&entry.step))
            .ok_or(ReplayError::Line(place))?;
        while steps < entry.step {
            digest.take(session.step());
            observe(&session);
            steps += 1;
        }
        match entry.happening {
            // What was refused then is refused now.
            Happening::Event(event) => drop(session.handle(event)),
            Happening::Sample(arrival, sample) => session.receive(arrival, &sample),
            Happening::Legs(legs) => drop(session.locate(legs)),
            Happening::Slip(time) => session.slip(time),
            Happening::Choice(slot, value) => session.choose(usize::from(slot), value),
            Happening::Retune => drop(session.retune()),
            Happening::End(recorded) => return Ok(Replayed { steps, digest: digest.0, recorded: Some(recorded) }),
        }
    }
    Ok(Replayed { steps, digest: digest.0, recorded: None })
}
