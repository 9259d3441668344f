//! Where the legs are before they follow commands.

use moris_washout::Rig;
use moris_washout::platform::{Geometry, Pose, forward_kinematics, leg_lengths};

use crate::session::Refusal;

/// Where the legs are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Legs {
    /// An unknown place.
    Unknown,
    /// At the settled pose, as the operator has seen.
    Settled,
    /// Anywhere, with a controller that goes to a length at its own low speed. The settled lengths
    /// are commanded for as long as it may take at [`slow_speed`](crate::Settings::slow_speed).
    Slow,
    /// At these lengths, or arcs of cranks, as the controller reports \[m\].
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

    /// The place that the operator may give by this name.
    pub fn of_person(name: &str) -> Option<Legs> {
        Self::named(name).filter(|legs| *legs != Legs::Unknown)
    }

    /// The one of this name that has no lengths.
    pub fn named(name: &str) -> Option<Legs> {
        [Legs::Unknown, Legs::Settled, Legs::Slow].into_iter().find(|legs| legs.name() == name)
    }
}

/// Reported lengths, or arcs of cranks, within the stroke.
///
/// # Errors
/// The first that is none of this rig.
pub fn lengths_within(rig: &Rig, lengths: [f64; 6]) -> Result<[f64; 6], Refusal> {
    // Reported lengths may lie outside of the stroke by this part of it: a sensor is not exact.
    const STROKE_TOLERANCE: f64 = 0.02;
    let [shortest, longest] = rig.stroke();
    let tolerance = STROKE_TOLERANCE * (longest - shortest);
    let range = shortest - tolerance..=longest + tolerance;
    let Some(leg) = lengths.iter().position(|length| !range.contains(length)) else {
        return Ok(lengths.map(|length| length.clamp(shortest, longest)));
    };
    let is_angle = rig.has_cranks();
    let degrees = |arc: f64| ((arc / rig.crank_arm).to_degrees() * 1e6).round() / 1e6;
    let shown = |position: f64| if is_angle { degrees(position) } else { position };
    let [position, least, greatest] = [lengths[leg], shortest, longest].map(shown);
    Err(Refusal::Position { leg, position, least, greatest, unit: if is_angle { "degrees" } else { "m" } })
}

/// Lengths of the lowest pose, at `part` of the stroke from its end: the shortest, or the longest
/// of a platform that hangs. The arms of cranks go so far towards that end as their least
/// transmission permits.
pub fn lowest(rig: &Rig, geometry: &Geometry, part: f64) -> [f64; 6] {
    // Steps from neutral to the lowest pose of cranks, each of which is checked.
    const CRANK_SEARCH_STEPS: u32 = 200;
    let [start, end] = rig.stroke();
    let part = part.clamp(0.0, 1.0);
    let at = |part: f64| start + part * (end - start);
    let neutral = Pose::neutral(rig);
    let begin = leg_lengths(geometry, &neutral);
    let towards = |end: f64, part: f64| std::array::from_fn(|k| begin[k] + part * (end - begin[k]));
    // A small part of the way, where a pose is surely found.
    let height =
        |end: f64| forward_kinematics(geometry, &towards(end, 0.01), &neutral).map_or(0.0, |pose| pose.position.z);
    let [short, long] = [at(part), at(1.0 - part)];
    let lowest = if height(short) <= height(long) { short } else { long };
    let Some(cranks) = &geometry.cranks else { return [lowest; 6] };
    let (mut pose, mut found) = (neutral, begin);
    for step in 1..=CRANK_SEARCH_STEPS {
        let arcs = towards(lowest, f64::from(step) / f64::from(CRANK_SEARCH_STEPS));
        match forward_kinematics(geometry, &arcs, &pose) {
            Ok(next) if geometry.transmission(&next) >= cranks.least_transmission => (pose, found) = (next, arcs),
            _ => break,
        }
    }
    found
}
