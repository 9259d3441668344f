//! Channels that are another axis's.

use std::f64::consts::TAU;

use super::Channels;
use super::channels::LEAST_CHANGE;
use crate::message::{Message, given, message, named};
use crate::recording::conventions::{Conventions, Quantity};
use crate::recording::signal::{centred, is_constant, regression, root_mean_square};

/// Ratios of two signals that are the same, of either sign.
const SAME: [f64; 2] = [0.67, 1.5];
/// Least rate that is compared, as a root mean square \[rad/s\].
const LEAST_RATE: f64 = 0.002;

/// Warnings about a speed that goes with the force along y, a roll that goes with the rate of
/// pitch, and axes with the values of another one.
pub fn warnings(channels: &Channels) -> Vec<Message> {
    [forces(channels), rates(channels)].into_iter().flatten().chain(repeated(channels)).collect()
}

/// Warnings about two axes with the same values, of either sign. Those of a mounted sensor may be
/// equal.
fn repeated(Channels { table, conventions, .. }: &Channels) -> Vec<Message> {
    let axes = [Quantity::Force, Quantity::Rate].map(|of| [(of(0), of(1)), (of(0), of(2)), (of(1), of(2))]);
    let is_repeated = |&(one, other): &(Quantity, Quantity)| {
        let (Some(one), Some(other)) = (table.columns.get(&one), table.columns.get(&other)) else { return false };
        let equals = |sign: f64| one.iter().zip(other).all(|(one, other)| *one == sign * other);
        !is_constant(one) && (equals(1.0) || equals(-1.0))
    };
    let pairs = axes.concat().into_iter().filter(|pair| conventions.mounting.is_none() && is_repeated(pair));
    let warning = |(one, other): (Quantity, Quantity)| {
        let [one, other] = [one, other].map(|quantity| conventions.column(quantity));
        message![
            "Columns {one} and {other} hold the same values: one of them is not what its name says. Name the column that \
             is with ",
            named("columns"),
            "."
        ]
    };
    pairs.map(warning).collect()
}

fn is_same(ratio: Option<f64>) -> bool {
    ratio.is_some_and(|ratio| (SAME[0]..SAME[1]).contains(&ratio.abs()))
}

fn forces(channels: &Channels) -> Option<Message> {
    let needed = centred(channels.changes(&channels.speeds).into_iter());
    if !channels.has(Quantity::Speed) || root_mean_square(&needed) < LEAST_CHANGE {
        return None;
    }
    let ratio = |axis: usize| {
        let driven = channels.driven(channels.force(axis));
        // Noise goes with nothing.
        (root_mean_square(&driven) > 0.0).then(|| regression(&driven, &needed)).flatten()
    };
    if ratio(0).is_some() || !is_same(ratio(1)) {
        return None;
    }
    let sign = if ratio(1)? > 0.0 { "" } else { "-" };
    Some(message![
        "The speed goes with the force along y, and not with that along x: the axes seem to be exchanged. ",
        remedy(channels.conventions, [Quantity::Force(0), Quantity::Force(1)], sign)
    ])
}

fn rates(channels: &Channels) -> Option<Message> {
    if !channels.table.has_orientation() || !channels.has_body_rates() {
        return None;
    }
    let signals = [0, 1].map(|axis| channels.derivative_and_rate(axis, TAU));
    let ratio = |angle: usize, rate: usize| {
        let (derivative, rate) = (&signals[angle].0, &signals[rate].1);
        let is_small = |values: &[f64]| root_mean_square(values) < LEAST_RATE;
        if is_small(derivative) || is_small(rate) { None } else { regression(derivative, rate) }
    };
    let is_exchanged = ratio(0, 0).is_none() && ratio(1, 1).is_none() && is_same(ratio(0, 1)) && is_same(ratio(1, 0));
    is_exchanged.then(|| {
        message![
            "Roll goes with the angular velocity wy, and pitch with wx: the rates seem to be exchanged. ",
            remedy(channels.conventions, [Quantity::Rate(0), Quantity::Rate(1)], "")
        ]
    })
}

/// The remedy where two columns are exchanged.
fn remedy(conventions: &Conventions, [one, other]: [Quantity; 2], sign: &str) -> Message {
    if conventions.mounting.is_some() {
        return message!["Check ", named("mounting"), "."];
    }
    let [first, second] = [one, other].map(|quantity| conventions.column(quantity));
    let columns = format!("{}={sign}{second},{}={first}", one.key(), other.key());
    message!["If they are, use ", given("columns", columns), "."]
}
