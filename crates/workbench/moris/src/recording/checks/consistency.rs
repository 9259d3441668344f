//! Contradictions between the channels of a recording.
//!
//! - Speed is the integral of the force along x.
//! - The lateral force of bends is speed times yaw rate, where a vehicle does not lean.
//! - Rates are the derivatives of angles.

use moris_washout::Input;

use super::remedy;
use crate::recording::columns::UnitSource;
use crate::recording::conventions::{Conventions, Quantity, RateFrame, Unit};
use crate::recording::message::{given, named};
use crate::recording::signal::{centred, integral, regression, root_mean_square, smooth};
use crate::recording::table::Table;

/// Time over which changes of speed are compared with the force \[s\].
const WINDOW: f64 = 2.0;
/// Least change of speed in it that is compared, as a root mean square \[m/s\].
const LEAST_CHANGE: f64 = 0.3;
/// Least lateral force of bends that is compared, as a root mean square \[m/s2\].
const LEAST_SWAY: f64 = 0.3;
/// Least rate that is compared with an angle, as a root mean square \[rad/s\].
const LEAST_RATE: f64 = 0.02;
/// Ratio of two signals that should be equal, up to which they are taken as equal: slopes and bias
/// change the force.
const RATIO: f64 = 1.5;
/// Largest relative distance from another unit's ratio that shows this unit.
const UNIT_TOLERANCE: f64 = 0.2;
/// Ratio below which a sign is wrong. Two-wheelers have a small lateral force of either sign.
const OPPOSITE: f64 = -0.5;

/// Warnings that name the options for channels that contradict each other.
pub fn warnings(table: &Table, inputs: &[Input], conventions: &Conventions) -> Vec<String> {
    let of_speed = || [speed_and_force(table, inputs, conventions), bends(table, inputs, conventions)];
    let of_speed = table.columns.contains_key(&Quantity::Speed).then(of_speed).into_iter().flatten().flatten();
    of_speed.chain(angles_and_rates(table, inputs, conventions)).collect()
}

/// Factor from the signal that is expected to the other; none where one is small, or they do not go
/// together.
fn ratio(expected: &[f64], found: &[f64], least: f64) -> Option<f64> {
    let is_small = |values| root_mean_square(values) < least;
    if is_small(expected) || is_small(found) { None } else { regression(expected, found) }
}

/// Compares changes of speed with the integral of the force along x.
fn speed_and_force(table: &Table, inputs: &[Input], conventions: &Conventions) -> Option<String> {
    let step = table.step();
    let window = ((WINDOW / step).round() as usize).max(1);
    let integral = integral(inputs.iter().map(|input| input.specific_force.x), step);
    let starts = 0..inputs.len().saturating_sub(window);
    let changes: Vec<f64> = starts.clone().map(|k| inputs[k + window].speed - inputs[k].speed).collect();
    let expected = centred(starts.map(|k| integral[k + window] - integral[k]));
    if root_mean_square(&changes) < LEAST_CHANGE || root_mean_square(&expected) < LEAST_CHANGE {
        return None;
    }
    let ratio = regression(&expected, &centred(changes.into_iter()))?;
    let fact = format!("The speed changes {ratio:.1} times as much as the integral of the force along x");
    if ratio < OPPOSITE {
        let remedy = turned(conventions, Quantity::Force(0));
        return Some(format!("{fact}: x points backward. If it does, {remedy}."));
    }
    let meaning = match other_unit(table, ratio) {
        Some(other) => {
            let remedy = remedy(table, Quantity::Speed, other.word);
            format!("it seems to be in {}, not in {}: {remedy}", other.word, table.unit(Quantity::Speed).0.word)
        }
        None => format!("check {}", named("speed-unit")),
    };
    (!(1.0 / RATIO..RATIO).contains(&ratio)).then(|| format!("{fact}: {meaning}."))
}

/// The unit of a speed that is so many times too large.
fn other_unit(table: &Table, ratio: f64) -> Option<Unit> {
    let (given, _) = table.unit(Quantity::Speed);
    let distance = |other: &Unit| (ratio * other.in_si / given.in_si).ln().abs();
    let others = Quantity::Speed.dimension().units().filter(|other| *other != given);
    let nearest = others.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    (distance(&nearest) < UNIT_TOLERANCE).then_some(nearest)
}

/// Compares the lateral force of bends with speed times yaw rate.
fn bends(table: &Table, inputs: &[Input], conventions: &Conventions) -> Option<String> {
    let step = table.step();
    let expected = smooth(inputs.iter().map(|input| input.speed * input.angular_velocity.z), step);
    let lateral = smooth(inputs.iter().map(|input| input.specific_force.y), step);
    let ratio = ratio(&expected, &lateral, LEAST_SWAY)?;
    if ratio < OPPOSITE {
        let rate = turned(conventions, Quantity::Rate(2));
        let force = turned(conventions, Quantity::Force(1));
        let remedy = if conventions.mounting.is_some() {
            rate
        } else {
            format!("{rate} where the rate is positive to the right, or {force} where the force is")
        };
        return Some(format!(
            "In bends the lateral force is {ratio:.1} times speed by yaw rate: one of them has the wrong sign. Use the one \
             that applies: {remedy}."
        ));
    }
    let (given, source) = table.unit(Quantity::Speed);
    let other = other_unit(table, 1.0 / ratio).filter(|_| source == UnitSource::Default && ratio < 1.0 / RATIO)?;
    Some(format!(
        "In bends the lateral force is {ratio:.2} times speed by yaw rate. If the vehicle does not lean, its speed is in {}, \
         not in {}: {}.",
        other.word,
        given.word,
        remedy(table, Quantity::Speed, other.word)
    ))
}

/// Compares rates with the derivatives of angles.
fn angles_and_rates(table: &Table, inputs: &[Input], conventions: &Conventions) -> Vec<String> {
    if conventions.rate_frame != RateFrame::Body {
        return Vec::new();
    }
    let step = table.step();
    let opposite = |axis: usize| {
        table.columns.get(&Quantity::Angle(axis))?;
        let angle = |input: &Input| input.orientation.to_vector()[axis];
        // Yaw jumps by a turn.
        let changes = inputs.windows(2).map(|pair| (angle(&pair[1]) - angle(&pair[0])).sin() / step);
        let derivative = smooth(changes, step);
        let rate = smooth(inputs[1..].iter().map(|input| input.angular_velocity[axis]), step);
        let ratio = ratio(&derivative, &rate, LEAST_RATE)?;
        let name = ["roll", "pitch", "yaw"][axis];
        let remedy = turned(conventions, Quantity::Rate(axis));
        (ratio < OPPOSITE).then(|| {
            format!(
                "The angular velocity {} is {ratio:.1} times the derivative of {name}: one of them has the wrong sign. If it \
                 is the angular velocity, {remedy}.",
                Quantity::Rate(axis).key()
            )
        })
    };
    (0..3).filter_map(opposite).collect()
}

/// The remedy for a quantity with the wrong sign.
fn turned(conventions: &Conventions, quantity: Quantity) -> String {
    if conventions.mounting.is_some() {
        return format!("check {}", named("mounting"));
    }
    let name = conventions.column(quantity);
    let turned = name.strip_prefix('-').map_or_else(|| format!("-{name}"), str::to_owned);
    format!("use {}", given("columns", format!("{}={turned}", quantity.key())))
}
