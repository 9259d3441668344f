//! Wrong units of rates.
//!
//! Rates in deg/s that are read as rad/s are 57 times too large. Those of a calm car still resemble
//! a motorcycle's. Four tests distinguish them, each by a fact that holds for every vehicle:
//!
//! - no head turns faster than 10 rad/s for a hundredth of the time;
//! - rates are the derivatives of the angles, where the recording has both;
//! - roll and pitch are bounded, so the integral of their rates may drift, but does not swing by
//!   more than half a turn;
//! - correlated lateral force and yaw rate are those of a turn, a = v omega, whose radius a /
//!   omega^2 is at least a metre.

use moris_washout::Input;

use super::{Channels, remedy};
use crate::message::{Message, given, message};
use crate::recording::columns::UnitSource;
use crate::recording::conventions::{Quantity, RateUnit};
use crate::recording::signal::{extremes, integral, regression, root_mean_square, smooth, sorted};

/// Angular velocity that no head exceeds for a hundredth of a recording \[rad/s\].
const FASTEST: f64 = 10.0;
/// Time over which the drift of an integrated rate is removed \[s\].
const DRIFT: f64 = 10.0;
/// Swing of roll or pitch, drift removed, that no vehicle exceeds \[rad\]: a
/// motorcycle goes from -1 to 1.
const WIDEST_SWING: f64 = 3.5;
/// Least lateral specific force of a turn, as a standard deviation \[m/s2\].
const TURN: f64 = 0.3;
/// Radius below which no vehicle turns \[m\]; in deg/s for rad/s, a radius of 1 km reads as 0.3 m.
const TIGHTEST: f64 = 1.0;

/// Rejects rates that are plausible only as deg/s. A given unit overrides all
/// tests except the first.
pub fn check(channels: &Channels) -> Result<(), Message> {
    let Channels { table, inputs, .. } = channels;
    let (unit, source) = table.unit(Quantity::Rate(0));
    if unit != RateUnit::RadianPerSecond.unit() {
        return Ok(());
    }
    let fast = usual_maximum(inputs);
    let (evidence, insist) = if fast > FASTEST {
        (Some(format!("angular velocities reach {fast:.0}")), Message::default())
    } else if source == UnitSource::Default {
        let option = given(Quantity::Rate(0).dimension().option(), "rad/s");
        (not_radians(channels), message![" (or ", option, ", if they are)"])
    } else {
        (None, Message::default())
    };
    let Some(evidence) = evidence else { return Ok(()) };
    let remedy = remedy(table, Quantity::Rate(0), RateUnit::DegreePerSecond.word());
    Err(message!["{evidence}: these are degrees a second, not radians; ", remedy, insist])
}

/// Angular velocity that is exceeded for a hundredth of the time \[rad/s\].
pub fn usual_maximum(inputs: &[Input]) -> f64 {
    let rates = sorted(inputs.iter().map(|input| input.angular_velocity.amax()));
    rates[(rates.len() - 1) * 99 / 100]
}

/// Evidence that angular velocities are not in rad/s.
fn not_radians(channels: &Channels) -> Option<String> {
    let by_angle = |axis: usize| {
        let name = Quantity::Angle(axis).key();
        let derivative = || derivative_differs(channels, axis, name).filter(|_| channels.table.has_orientation());
        derivative().or_else(|| swings_too_wide(channels, axis, name))
    };
    // Roll and pitch.
    let mut angles = (0..2).filter(|_| channels.has_body_rates());
    angles.find_map(by_angle).or_else(|| turns_too_tight(channels))
}

fn derivative_differs(channels: &Channels, axis: usize, name: &str) -> Option<String> {
    let angle = |input: &Input| input.orientation.to_vector()[axis];
    let changes = channels.inputs.windows(2).map(|pair| angle(&pair[1]) - angle(&pair[0]));
    let derivative: Vec<f64> = changes.map(|change| change / channels.step).collect();
    let rates: Vec<f64> = channels.rate(axis).take(derivative.len()).collect();
    let scale = regression(&derivative, &rates).filter(|scale| (30.0..100.0).contains(scale))?;
    Some(format!("angular velocities are {scale:.0} times the derivative of {name}"))
}

fn swings_too_wide(channels: &Channels, axis: usize, name: &str) -> Option<String> {
    let swing = widest_swing(channels.rate(axis), channels.step);
    (swing > WIDEST_SWING)
        .then(|| format!("in rad/s, {name} would swing by {:.0} degrees within {DRIFT} s", swing.to_degrees()))
}

fn turns_too_tight(channels: &Channels) -> Option<String> {
    let lateral = channels.lateral();
    if root_mean_square(&lateral) < TURN {
        return None;
    }
    let yaw = smooth(channels.rate(2), channels.step);
    // a = v omega of a turn; a two-wheeler has no lateral force in its turns, and none that has the yaw rate's sign.
    let speed = regression(&yaw, &lateral)?;
    let radius = speed / root_mean_square(&yaw);
    (0.0..TIGHTEST).contains(&radius).then(|| {
        format!("in rad/s, the turns' lateral force and yaw rate would be those of {speed:.2} m/s and a radius of {radius:.2} m")
    })
}

/// Widest swing of the integral of a rate over any [`DRIFT`] seconds, from which its straight
/// drift is removed \[rad\].
fn widest_swing(rates: impl Iterator<Item = f64>, step: f64) -> f64 {
    let angles = integral(rates, step);
    let window = ((DRIFT / step) as usize).clamp(2, angles.len().max(2));
    // Windows that overlap by half: a swing at the end of one is in the middle of the next.
    let swing = |part: &[f64]| {
        let (first, last) = (part[0], part[part.len() - 1]);
        let slope = (last - first) / (part.len() - 1) as f64;
        let level = part.iter().enumerate().map(|(k, angle)| angle - slope * k as f64);
        let (low, high) = extremes(level);
        high - low
    };
    let parts = (0..angles.len()).step_by(window / 2).map(|start| &angles[start..(start + window).min(angles.len())]);
    parts.filter(|part| part.len() > 1).map(swing).fold(0.0, f64::max)
}
