//! Where the legs are before they follow commands.

use moris_washout::Rig;
use moris_washout::platform::{Geometry, Pose, forward_kinematics, leg_lengths};

use crate::session::Refusal;

/// Where the legs are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Legs {
    /// An unknown place.
    Unknown,
    /// At the settled pose, as a person has seen.
    Settled,
    /// Anywhere, with a controller that goes to a length at its own low speed. The settled lengths
    /// are commanded for as long as it may take at [`slow_speed`](crate::Settings::slow_speed).
    Slow,
    /// At these lengths, as the controller reports \[m\].
    Reported([f64; 6]),
}

impl Legs {
    /// The place's name.
    pub fn name(self) -> &'static str {
        match self {
            Legs::Unknown => "unknown",
            Legs::Settled => "settled",
            Legs::Slow => "slow",
            Legs::Reported(_) => "reported",
        }
    }

    /// The place that a person may give by this name.
    pub fn of_person(name: &str) -> Option<Legs> {
        Self::named(name).filter(|legs| *legs != Legs::Unknown)
    }

    /// The one of this name that has no lengths.
    pub fn named(name: &str) -> Option<Legs> {
        [Legs::Unknown, Legs::Settled, Legs::Slow].into_iter().find(|legs| legs.name() == name)
    }
}

/// Reported lengths, within the stroke.
///
/// # Errors
/// The first that is none of this rig.
pub fn lengths_within(rig: &Rig, lengths: [f64; 6]) -> Result<[f64; 6], Refusal> {
    // Reported lengths may lie outside of the stroke by this part of it: a sensor is not exact.
    const STROKE_TOLERANCE: f64 = 0.02;
    let [shortest, longest] = [rig.min_length, rig.max_length];
    let tolerance = STROKE_TOLERANCE * (longest - shortest);
    let range = shortest - tolerance..=longest + tolerance;
    match lengths.iter().position(|length| !range.contains(length)) {
        Some(leg) => Err(Refusal::Length { leg, length: lengths[leg], shortest, longest }),
        None => Ok(lengths.map(|length| length.clamp(shortest, longest))),
    }
}

/// Lengths of the lowest pose, at `part` of the stroke from its end: the shortest, or the longest
/// of a platform that hangs.
pub fn lowest(rig: &Rig, geometry: &Geometry, part: f64) -> [f64; 6] {
    let part = part.clamp(0.0, 1.0);
    let at = |part: f64| [rig.min_length + part * (rig.max_length - rig.min_length); 6];
    let neutral = Pose::neutral(rig);
    let height = |lengths: [f64; 6]| {
        // A small part of the way, where a pose is surely found.
        let begin = leg_lengths(geometry, &neutral);
        let near = std::array::from_fn(|k| begin[k] + 0.01 * (lengths[k] - begin[k]));
        forward_kinematics(geometry, &near, &neutral).map_or(0.0, |pose| pose.position.z)
    };
    let [short, long] = [at(part), at(1.0 - part)];
    if height(short) <= height(long) { short } else { long }
}
