//! Contradictions between the channels of a recording.
//!
//! - Speed is the integral of the force along x, without gravity on slopes.
//! - The lateral force of bends is speed times yaw rate, where a vehicle does not lean.
//! - Rates are the derivatives of angles.

use std::f64::consts::TAU;

use moris_washout::interface::STANDARD_GRAVITY;

use super::channels::{Channels, LEAST_CHANGE, LEAST_SWAY};
use super::remedy;
use crate::message::{Message, given, message, named};
use crate::recording::columns::UnitSource;
use crate::recording::conventions::{Conventions, Dimension, ForceUnit, Gravity, Quantity, SpeedUnit, Unit};
use crate::recording::signal::{centred, integral, regression, root_mean_square};
use crate::recording::table::Table;

/// Fraction of the least sizes that are compared, down to which the other signal is: it may be in a
/// larger unit.
const FAINT: f64 = 0.01;
/// Least rate that is compared with an angle, as a root mean square \[rad/s\].
pub const LEAST_RATE: f64 = 0.005;
/// Ratio of two signals that should be equal, up to which they are taken as equal: slopes and bias
/// change the force.
const RATIO: f64 = 1.5;
/// Largest relative distance from another unit's ratio that shows this unit.
const UNIT_TOLERANCE: f64 = 0.2;
/// Largest logarithm of a ratio over that of a unit of rates.
const RATE_TOLERANCE: f64 = 0.4;
/// Ratio above which no slope or bias changes the speed, but the scale of time is wrong.
const SCALE: f64 = 5.0;
/// Ratio above which the scale of time is wrong where the speed fits the yaw rate in bends, and the
/// relative distance of this fit.
const PACE: f64 = 1.8;
const FITS: f64 = 0.1;
/// Ratio below which a sign is wrong. Two-wheelers have a small lateral force of either sign.
const OPPOSITE: f64 = -0.5;
/// Speed of bends below which a sign is wrong \[m/s\].
const BACKWARD: f64 = -3.0;

/// Warnings that name the options for channels that contradict each other.
pub fn warnings(channels: &Channels) -> Vec<Message> {
    let Channels { table, conventions, .. } = *channels;
    let mut warnings = Vec::new();
    if channels.has(Quantity::Speed) {
        let surge = surge_ratio(channels);
        let sway = ratio(&channels.turning(), &channels.lateral(), LEAST_SWAY);
        let of_surge = surge.and_then(|surge| speed_and_force(table, conventions, surge, sway));
        let is_explained = of_surge.is_some() || surge.is_some_and(is_equal);
        warnings.extend(of_surge);
        warnings.extend(sway.and_then(|sway| bends(table, conventions, sway, is_explained)));
        warnings.extend(channels.reversing.clone().map(Message::from));
    } else if conventions.mounting.is_none() {
        let speed = channels.speed_of_bends();
        warnings.extend(speed.filter(|speed| *speed < BACKWARD).map(|speed| {
            let [rate, force] = [Quantity::Rate(2), Quantity::Force(1)].map(|of| turned(conventions, of));
            message![
                "In bends the lateral force and the yaw rate are those of {speed:.0} m/s, backward: one of them has the \
                 wrong sign. Use the one that applies: ",
                rate,
                " where the rate is positive to the right, or ",
                force,
                " where the force is."
            ]
        }));
    }
    warnings.extend(angles_and_rates(channels));
    warnings
}

/// True for a ratio that slopes and bias explain.
fn is_equal(ratio: f64) -> bool {
    (1.0 / RATIO..RATIO).contains(&ratio)
}

/// Factor from the signal that is expected to the other; none where one is small, or they do not go
/// together.
fn ratio(expected: &[f64], found: &[f64], least: f64) -> Option<f64> {
    let [expected_size, found_size] = [expected, found].map(root_mean_square);
    let is_small = expected_size.max(found_size) < least || expected_size.min(found_size) < FAINT * least;
    if is_small { None } else { regression(expected, found) }
}

/// Ratio of the changes of speed and the integral of the force along x. Where slopes explain it, as
/// the pitch or the rate of pitch gives them, it is 1.
fn surge_ratio(channels: &Channels) -> Option<f64> {
    let ratio = ratio_of_force(channels, channels.force(0));
    if ratio.is_some_and(is_equal) {
        return ratio;
    }
    if slopes_explain(channels) { Some(1.0) } else { ratio }
}

/// Ratio of the changes of speed and the integral of a force.
fn ratio_of_force(channels: &Channels, force: impl Iterator<Item = f64>) -> Option<f64> {
    let found = channels.changes(&channels.speeds);
    let expected = channels.driven(force);
    let is_small = root_mean_square(&found) < LEAST_CHANGE || root_mean_square(&expected) < FAINT * LEAST_CHANGE;
    if is_small { None } else { regression(&expected, &centred(found.into_iter())) }
}

/// True where slopes explain the changes of speed beside the force along x, as the pitch or the
/// rate of pitch gives them.
pub fn slopes_explain(channels: &Channels) -> bool {
    // Pitch is positive with the nose down, where gravity accelerates.
    let pitch: Vec<f64> = channels.inputs.iter().map(|input| input.orientation.pitch).collect();
    let of_rate = centred(integral(channels.rate(1), channels.step).into_iter());
    let on_slopes = |pitch: &Vec<f64>| {
        let force = channels.force(0).zip(pitch).map(|(force, pitch)| force + STANDARD_GRAVITY * pitch.sin());
        ratio_of_force(channels, force).is_some_and(is_equal)
    };
    [pitch, of_rate].iter().any(on_slopes)
}

/// A unit, or a scale of time, that explains a ratio.
enum Cause {
    Unit(Quantity, Unit),
    TimeScale(f64),
    /// Factor of a speed in a unit that is not known.
    SpeedScale(f64),
    /// Factor of the force along x and y, with the units that it has and should have.
    Horizontal(f64, [Unit; 2]),
}

/// Judges the ratio of the changes of speed and the integral of the force along x.
fn speed_and_force(table: &Table, conventions: &Conventions, surge: f64, sway: Option<f64>) -> Option<Message> {
    let fact = format!("The speed changes {surge:.1} times as much as the integral of the force along x");
    if surge < OPPOSITE {
        let remedy = turned(conventions, Quantity::Force(0));
        return Some(message![
            "{fact}: the axis may point to the back, or the force be positive in braking, or slopes or reversing cause \
             it. If the axis does, ",
            remedy,
            "."
        ]);
    }
    if is_equal(surge) {
        return None;
    }
    let meaning = match cause(table, conventions, surge, sway) {
        Some(Cause::Unit(quantity, unit)) => {
            let name = match quantity {
                Quantity::Speed => "it".to_owned(),
                _ => format!("the {}", quantity.dimension().name()),
            };
            let (given, other) = (table.unit(quantity).0.word, unit.word);
            message!["{name} seems to be in {other}, not in {given}: ", remedy(table, quantity, other)]
        }
        Some(Cause::TimeScale(scale)) => {
            let pace = time_scale(conventions, scale);
            let slopes = if (1.0 / SCALE..SCALE).contains(&scale) { ", if no slopes cause it" } else { "" };
            message![pace, slopes]
        }
        Some(Cause::SpeedScale(factor)) => {
            let columns = conventions.scaled(&[Quantity::Speed], &format!("* {factor}"));
            message!["its unit seems to be {factor} m/s: use ", columns]
        }
        Some(Cause::Horizontal(factor, [unit, other])) => {
            let columns = conventions.scaled(&[0, 1].map(Quantity::Force), &format!("* {factor:.5}"));
            let (unit, other) = (unit.word, other.word);
            message!["the forces along x and y seem to be in {unit}, and that along z in {other}: use ", columns]
        }
        None => message!["check ", named("speed-unit")],
    };
    Some(message!["{fact}: ", meaning, "."])
}

/// The fact that time runs at another pace, and the remedy.
fn time_scale(conventions: &Conventions, scale: f64) -> Message {
    let (unit, columns) = (named("time-unit"), conventions.scaled(&[Quantity::Time], &format!("* {scale:.3}")));
    let (times, pace) = if scale < 1.0 { (1.0 / scale, "slow") } else { (scale, "fast") };
    message!["the time seems to run {times:.1} times too {pace}: check ", unit, ", or use ", columns]
}

/// The unit or scale that explains the ratios of the changes of speed and of the lateral force.
fn cause(table: &Table, conventions: &Conventions, surge: f64, sway: Option<f64>) -> Option<Cause> {
    let near = |a: f64, b: f64| (a / b).ln().abs();
    // In bends a wrong unit of speed or force has the opposite effect, and that of time none.
    let of_time = sway.is_none_or(|sway| sway > 0.0 && near(sway, 1.0) < near(sway, 1.0 / surge));
    let of_others = sway.is_none_or(|sway| sway <= 0.0 || near(sway, 1.0) >= near(sway, 1.0 / surge) || surge < SCALE);
    // A speed that fits the yaw rate in bends has the right unit.
    let fits_bends = sway.is_some_and(|sway| near(sway, 1.0) < FITS) && !(1.0 / PACE..PACE).contains(&surge);
    let of_others = of_others && !fits_bends;
    let mut causes: Vec<(f64, Cause)> = Vec::new();
    let mut consider = |quantity: Quantity, effect: fn(f64, f64) -> f64| {
        let given = table.unit(quantity).0;
        // Feet are too near to km/h.
        let is_other = |unit: &Unit| *unit != given && *unit != SpeedUnit::FootPerSecond.unit();
        for unit in quantity.dimension().units().filter(is_other) {
            causes.push((near(surge, effect(given.in_si, unit.in_si)), Cause::Unit(quantity, unit)));
        }
    };
    if of_others {
        consider(Quantity::Speed, |given, other| given / other);
        if conventions.gravity == Gravity::Removed {
            consider(Quantity::Force(0), |given, other| other / given);
        }
    }
    if of_time {
        consider(Quantity::Time, |given, other| other / given);
    }
    if of_others && sway.is_some() && conventions.gravity == Gravity::Included {
        let (unit, units) = (table.unit(Quantity::Force(0)).0, [ForceUnit::MetrePerSecondSquared, ForceUnit::Gravity]);
        for other in units.map(|unit| unit.unit()).into_iter().filter(|other| *other != unit) {
            let factor = other.in_si / unit.in_si;
            causes.push((near(surge, factor), Cause::Horizontal(factor, [other, unit])));
        }
    }
    if of_others {
        causes.extend([0.01, 0.001].map(|factor| (near(surge, 1.0 / factor), Cause::SpeedScale(factor))));
    }
    let nearest =
        causes.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(distance, _)| *distance < UNIT_TOLERANCE);
    let is_paced = fits_bends || !(1.0 / SCALE..SCALE).contains(&surge);
    let scale = || (of_time && sway.is_some() && is_paced).then_some(Cause::TimeScale(surge));
    nearest.map(|(_, cause)| cause).or_else(scale)
}

/// Judges the ratio of the lateral force of bends and speed times yaw rate. Where the speed fits
/// the force along x, its unit is right.
fn bends(table: &Table, conventions: &Conventions, sway: f64, is_explained: bool) -> Option<Message> {
    if sway < OPPOSITE {
        let rate = turned(conventions, Quantity::Rate(2));
        let force = turned(conventions, Quantity::Force(1));
        let remedy = if conventions.mounting.is_some() {
            rate
        } else {
            message![rate, " where the rate is positive to the right, or ", force, " where the force is"]
        };
        return Some(message![
            "In bends the lateral force is {sway:.1} times speed by yaw rate: one of them has the wrong sign. Use the one \
             that applies: ",
            remedy,
            "."
        ]);
    }
    let fact = format!("In bends the lateral force is {sway:.2} times speed by yaw rate");
    if let Some(warning) = rate_unit(table, sway, &fact) {
        return Some(warning);
    }
    if is_explained || sway >= 1.0 / RATIO {
        return None;
    }
    let Cause::Unit(quantity, other) = cause(table, conventions, 1.0 / sway, Some(sway))? else { return None };
    let (given, source) = table.unit(quantity);
    if quantity != Quantity::Force(0) && (quantity != Quantity::Speed || source != UnitSource::Default) {
        return None;
    }
    let remedy = remedy(table, quantity, other.word);
    let (name, other, given) = (quantity.dimension().name(), other.word, given.word);
    Some(message![
        "In bends the lateral force is {sway:.2} times speed by yaw rate. If the vehicle does not lean, its {name} is in \
         {other}, not in {given}: ",
        remedy,
        "."
    ])
}

/// A unit of the rates that explains the ratio of what they should be and what they are.
fn rate_unit(table: &Table, ratio: f64, fact: &str) -> Option<Message> {
    let given = table.unit(Quantity::Rate(2)).0;
    let distance = |unit: &Unit| (ratio * given.in_si / unit.in_si).ln().abs();
    let others = Dimension::Rate.units().filter(|other| *other != given);
    let other = others.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let is_near = ratio > 0.0 && distance(&other) < RATE_TOLERANCE;
    is_near.then(|| {
        message![
            format!("{fact}: the angular velocities seem to be in {}, not in {}: ", other.word, given.word),
            remedy(table, Quantity::Rate(2), other.word),
            "."
        ]
    })
}

/// Compares rates with the derivatives of angles.
fn angles_and_rates(channels: &Channels) -> Vec<Message> {
    let Channels { table, conventions, .. } = *channels;
    let ratio = |axis: usize| {
        let (derivative, rate) = channels.derivative_and_rate(axis, TAU);
        Some((axis, ratio(&derivative, &rate, LEAST_RATE)?))
    };
    let measured = (0..3).filter(|&axis| channels.has_body_rates() && channels.has(Quantity::Angle(axis)));
    let ratios: Vec<(usize, f64)> = measured.filter_map(ratio).collect();
    let opposite = |&(axis, ratio): &(usize, f64)| {
        let quantities = [Quantity::Rate(axis), Quantity::Angle(axis)];
        let ([key, name], [remedy, other]) =
            (quantities.map(Quantity::key), quantities.map(|of| turned(conventions, of)));
        (ratio < OPPOSITE).then(|| {
            message![
                "The angular velocity {key} is {ratio:.1} times the derivative of {name}: one of them has the wrong sign. If \
                 it is the angular velocity, ",
                remedy,
                "; if it is the angle, ",
                other,
                "."
            ]
        })
    };
    let sizes: Vec<f64> = ratios.iter().map(|(_, ratio)| ratio.abs()).collect();
    let size = sizes.iter().product::<f64>().powf(1.0 / sizes.len().max(1) as f64);
    let agree = !sizes.is_empty() && sizes.iter().all(|other| (other / size).ln().abs() < UNIT_TOLERANCE);
    let scaled = if (0.5..2.0).contains(&size) || !agree {
        None
    } else {
        let fact = format!("The angular velocities are {size:.2} times the derivatives of the angles");
        let of_time = || (sizes.len() > 1).then(|| message!["{fact}: ", time_scale(conventions, 1.0 / size), "."]);
        rate_unit(table, 1.0 / size, &fact).or_else(of_time)
    };
    ratios.iter().filter_map(opposite).chain(scaled).collect()
}

/// The remedy for a quantity with the wrong sign.
fn turned(conventions: &Conventions, quantity: Quantity) -> Message {
    if conventions.mounting.is_some() {
        return message!["check ", named("mounting")];
    }
    message!["use ", given("columns", format!("{}={}", quantity.key(), conventions.turned_column(quantity)))]
}
