//! Channels that come later than those that cause them, or earlier.

use std::f64::consts::TAU;

use moris_simulation::measures::delay::delay;
use moris_simulation::measures::statistics::correlation;

use super::Channels;
use super::channels::LEAST_CHANGE;
use super::consistency::LEAST_RATE;
use crate::message::{Message, message};
use crate::recording::conventions::Quantity;
use crate::recording::signal::{integral, root_mean_square};

/// Least delay that is warned of, of either sign \[s\].
const LEAST_DELAY: f64 = 0.2;
/// Largest fraction of the unexplained variance that is left without the delay.
const CLEARER: f64 = 0.2;

/// Warnings about a speed that comes later or earlier than the force along x, and about angles and
/// their rates.
pub fn warnings(channels: &Channels) -> Vec<Message> {
    let step = channels.step;
    let speed = || {
        let found = channels.changes(&channels.speeds);
        let expected = channels.changes(&integral(channels.force(0), step));
        let delay = clear_delay(&expected, &found, LEAST_CHANGE, step)?;
        Some(warning(Quantity::Speed, "the force along x that changes it", delay))
    };
    let angle = |axis: usize| {
        let (derivative, rate) = channels.derivative_and_rate(axis, TAU);
        let delay = clear_delay(&rate, &derivative, LEAST_RATE, step)?;
        Some(warning(Quantity::Angle(axis), "the angular velocity that changes it", delay))
    };
    let angles = (0..3).filter(|&axis| channels.has_body_rates() && channels.has(Quantity::Angle(axis)));
    let speed = channels.has(Quantity::Speed).then(speed).flatten();
    speed.into_iter().chain(angles.filter_map(angle)).collect()
}

/// The delay of a signal behind the one that is expected, where it explains most of their
/// difference \[s\].
fn clear_delay(expected: &[f64], found: &[f64], least: f64, step: f64) -> Option<f64> {
    if root_mean_square(found) < least {
        return None;
    }
    let delay = delay(expected, found, step).filter(|delay| delay.abs() >= LEAST_DELAY)?;
    let shift = (delay.abs() / step).round() as usize;
    let (earlier, later) = if delay > 0.0 { (expected, found) } else { (found, expected) };
    let unexplained = |shift: usize| {
        let correlation = correlation(&earlier[..earlier.len() - shift], &later[shift..])?;
        Some(1.0 - correlation * correlation)
    };
    (unexplained(shift)? < CLEARER * unexplained(0)?).then_some(delay)
}

fn warning(quantity: Quantity, cause: &str, delay: f64) -> Message {
    let (key, seconds) = (quantity.key(), delay.abs());
    let (place, remedy) = if delay > 0.0 { ("after", "earlier") } else { ("before", "later") };
    message![
        "Column {key} comes {seconds:.1} s {place} {cause}: a filter, GPS or a clock of its own delays one of them. Write \
         its values {seconds:.1} s {remedy}."
    ]
}
