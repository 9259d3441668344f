//! Wrong units and axes.
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

use std::f64::consts::{FRAC_PI_2, TAU};

use moris_washout::Input;
use moris_washout::interface::STANDARD_GRAVITY;
use moris_washout::nalgebra::Vector3;

use super::agreement::quaternion;
use super::channels::Channels;
use crate::message::{Message, given};
use crate::recording::columns::UnitSource;
use crate::recording::conventions::{AngleUnit, Axes, ForceUnit, Gravity, Quantity, RateUnit, Unit};
use crate::recording::signal::{extremes, integral, median, relation, root_mean_square, smooth, sorted};
use crate::texts::text;

/// Roll, pitch or lean that vehicles reach only where their rates show it \[rad\].
const STEEP_ANGLE: f64 = FRAC_PI_2 + 0.1;
/// Least derivative and rate that are compared, as root mean squares \[rad/s\].
const MIN_COMPARED_RATE: f64 = 0.005;
/// Largest distance of the median specific force from standard gravity \[m/s2\]: sensors are biased
/// and tilted.
const GRAVITY_TOLERANCE: f64 = 3.0;
/// Time over which the drift of an integrated rate is removed \[s\].
const DRIFT_TIME: f64 = 10.0;

/// Roll or pitch that no vehicle reaches.
pub fn angle_range(channels: &Channels, _: Quantity) -> Option<Message> {
    // Roll or pitch that no vehicle exceeds [rad].
    const STEEPEST_ANGLE: f64 = 3.2;
    let size = |input: &Input| input.orientation.roll.abs().max(input.orientation.pitch.abs());
    let steepest = channels.inputs.iter().map(size).fold(0.0, f64::max);
    if steepest <= STEEPEST_ANGLE {
        return None;
    }
    if channels.table.unit(Quantity::Angle(0)).0 != AngleUnit::Radian.unit() {
        return Some(text!["too-steep-degrees", steepest = steepest.to_degrees()]);
    }
    let remedy = channels.unit_remedy(Quantity::Angle(0), AngleUnit::Degree.word());
    Some(text!["angles-of-degrees", kind = text!["too-steep", steepest], remedy])
}

/// Angles that change as degrees would. A given unit overrides it.
pub fn angle_unit(channels: &Channels, quantity: Quantity) -> Option<Message> {
    let is_open = channels.table.unit(quantity).1 == UnitSource::Default && channels.has(quantity);
    if !is_open || matches!(quantity, Quantity::Angle(_)) && channels.has_quaternion() {
        return None;
    }
    let name = quantity.key();
    let evidence = if let Quantity::Angle(axis) = quantity {
        evidence_of_degrees(channels, axis, name)
    } else {
        let lean = channels.inputs.iter().map(|input| input.lean.abs()).fold(0.0, f64::max);
        (lean > STEEP_ANGLE).then(|| text!["angle-reaches", name, reach = lean])
    }?;
    let quantity = if quantity == Quantity::Lean { quantity } else { Quantity::Angle(0) };
    let remedy = channels.unit_remedy(quantity, AngleUnit::Degree.word());
    let radians = given(quantity.dimension().option(), AngleUnit::Radian.word());
    Some(text!["angle-in-degrees", evidence, remedy, radians])
}

fn evidence_of_degrees(channels: &Channels, axis: usize, name: &str) -> Option<Message> {
    // Ratios of an angle's derivative and a rate that show degrees.
    const DEGREE_RATIOS: [f64; 2] = [30.0, 110.0];
    let ratio = |period: f64| {
        let (derivative, rate) = channels.derivative_and_rate(axis, period);
        relation(&rate, &derivative).slope_above(MIN_COMPARED_RATE)
    };
    // Degrees jump by 360. A steady turn has nothing but the two means.
    let of_changes = || ratio(360.0).or_else(|| steady_ratio(channels, axis));
    let of_changes = channels.has_body_rates().then(of_changes).flatten().map(f64::abs);
    if let Some(ratio) = of_changes.filter(|ratio| (DEGREE_RATIOS[0]..DEGREE_RATIOS[1]).contains(ratio)) {
        return Some(text!["angle-changes", name, ratio]);
    }
    let reach = channels.angle(axis).map(f64::abs).fold(0.0, f64::max);
    let is_confirmed = || ratio(TAU).is_some_and(|ratio| (0.5..2.0).contains(&ratio.abs()));
    (axis < 2 && reach > STEEP_ANGLE && !is_confirmed()).then(|| text!["angle-reaches", name, reach])
}

/// Ratio of an angle's derivative in degrees and a rate that hardly vary; none of others.
fn steady_ratio(channels: &Channels, axis: usize) -> Option<f64> {
    // Spread of a derivative that hardly varies, as a part of it.
    const STEADY_SPREAD: f64 = 0.2;
    let derivative = || channels.derivative(axis, 360.0);
    let usual = median(derivative());
    let rate = median(channels.rate(axis));
    let spread = median(derivative().map(|change| (change - usual).abs()));
    (rate.abs() > MIN_COMPARED_RATE && spread < STEADY_SPREAD * usual.abs()).then(|| usual / rate)
}

/// An attitude of axes that point down, which turns the vehicle upside down.
pub fn attitude_from_below(channels: &Channels, quantity: Quantity) -> Option<Message> {
    // Cosine of the angle to the vertical below which a vehicle is upside down.
    const UPSIDE_DOWN: f64 = -0.5;
    let up = |input: &Input| input.orientation.roll.cos() * input.orientation.pitch.cos();
    if median(channels.inputs.iter().map(up)) >= UPSIDE_DOWN {
        return None;
    }
    if !channels.has_quaternion() {
        return Some(text!["angles-from-below"]);
    }
    // Half a turn about x before it leads from north, east, down to north, west, up.
    let from_below = || {
        let columns = channels.conventions.columns_of(&["-qx", "qw", "-qz", "qy"], &Quantity::QUATERNION);
        text!["quaternion-from-below", columns]
    };
    // The rates tell whether it is another convention.
    Some(quaternion(channels, quantity).unwrap_or_else(from_below))
}

/// Gravity in the columns of the rates, and none in those of the forces.
pub fn exchanged_sensors(channels: &Channels, _: Quantity) -> Option<Message> {
    // Relative distance from standard gravity of rates in m/s2, and the largest force beside them
    // in the file's unit. A circle at as many degrees a second has a lateral force.
    const EXCHANGED_GRAVITY_TOLERANCE: f64 = 0.05;
    const MAX_EXCHANGED_FORCE: f64 = 0.5;
    let Channels { table, conventions, .. } = channels;
    let median_of = |quantity: fn(usize) -> Quantity| {
        let column =
            |axis: usize| table.columns.get(&quantity(axis)).map_or(0.0, |values| median(values.iter().copied()));
        Vector3::from_fn(|axis, _| column(axis)) / table.unit(quantity(0)).0.in_si
    };
    let (force, rate) = (median_of(Quantity::Force), median_of(Quantity::Rate));
    let is_in = |unit: &Unit| (rate.norm() * unit.in_si / STANDARD_GRAVITY - 1.0).abs() < EXCHANGED_GRAVITY_TOLERANCE;
    let dimension = Quantity::Force(0).dimension();
    let unit = dimension.units().find(is_in)?;
    let is_si = unit == dimension.default_unit();
    // An offset of 1 degree a second beside forces without gravity is nothing rare.
    let may_be_offset = unit == ForceUnit::Gravity.unit() && conventions.gravity == Gravity::Removed;
    if may_be_offset || force.norm() > MAX_EXCHANGED_FORCE || conventions.mounting.is_some() {
        return None;
    }
    let quantities = [0, 1, 2, 3, 4, 5].map(|k| if k < 3 { Quantity::Force(k) } else { Quantity::Rate(k - 3) });
    let columns = conventions.columns_of(&["wx", "wy", "wz", "ax", "ay", "az"], &quantities);
    let also = if is_si { Message::default() } else { text!["also", remedy = given(dimension.option(), unit.word)] };
    Some(text!["exchanged-sensors", gravity = rate.norm(), unit = unit.word, columns, also])
}

/// Compares the medians of the accelerations, which manoeuvres hardly change, with gravity.
pub fn gravity(channels: &Channels, _: Quantity) -> Option<Message> {
    // Size of gravity from which it may be in counts [1].
    const MIN_COUNTS: f64 = 60.0;
    let Channels { table, inputs, conventions, .. } = channels;
    let median = Vector3::from_fn(|axis, _| median(channels.force(axis)));
    let gravity = Vector3::new(0.0, 0.0, STANDARD_GRAVITY);
    let is_near = (median - gravity).norm() < GRAVITY_TOLERANCE;
    if is_near || is_driven_hard(&median, inputs) || is_steady_bend(&median, inputs) {
        return None;
    }
    // As the file has it: without the gravity that conversion has added, in the file's unit.
    let added = if conventions.gravity == Gravity::Removed { gravity } else { Vector3::zeros() };
    let (unit, _) = table.unit(Quantity::Force(2));
    let raw = (median - added) / unit.in_si;
    let is_mounted = conventions.mounting.is_some();
    let signs = if is_mounted { [1.0; 3] } else { conventions.axes.force_signs() };
    let size = raw.norm();
    let is_gravity_in = |other: &Unit| (0.75..1.25).contains(&(size * other.in_si / STANDARD_GRAVITY));
    let mut other_units = Quantity::Force(2).dimension().units().filter(|other| *other != unit);
    let meaning = match other_units.find(is_gravity_in) {
        Some(other) => {
            let remedy = channels.unit_remedy(Quantity::Force(2), other.word);
            text!["gravity-in-unit", other = other.word, unit = unit.word, remedy]
        }
        None if size > MIN_COUNTS => {
            let columns = conventions.scaled(&[0, 1, 2].map(Quantity::Force), &format!("/ {size:.0}"));
            text!["gravity-in-counts", size, columns]
        }
        None => meaning_of_median(&median, channels),
    };
    let turned = if is_mounted { text!["turned-by-mounting"] } else { Message::default() };
    let (y, z) = (raw.y * signs[1], raw.z * signs[2]);
    Some(text!["gravity", turned, x = raw.x, y, z, unit = unit.word, meaning])
}

/// True if driving explains a horizontal median, as on a circuit with more bends one way. Then the
/// force varies by more than the median. And its z is nearer to gravity than under a tilt with this
/// horizontal part.
fn is_driven_hard(median: &Vector3<f64>, inputs: &[Input]) -> bool {
    let horizontal = median.xy().norm();
    let tilted = (STANDARD_GRAVITY.powi(2) - horizontal.powi(2)).max(0.0).sqrt();
    let distance = |z: f64| (median.z - z).abs();
    let is_level = distance(STANDARD_GRAVITY) < GRAVITY_TOLERANCE && distance(STANDARD_GRAVITY) < distance(tilted);
    is_level && self::median(inputs.iter().map(|input| (input.specific_force - median).xy().norm())) > horizontal
}

/// True if the speed and the yaw rate explain a lateral median, as on a steady circle.
fn is_steady_bend(median: &Vector3<f64>, inputs: &[Input]) -> bool {
    let turning = self::median(inputs.iter().map(|input| input.speed * input.angular_velocity.z));
    (median - Vector3::new(0.0, turning, STANDARD_GRAVITY)).norm() < GRAVITY_TOLERANCE
}

/// The meaning of a median in the right unit that is not gravity along z.
fn meaning_of_median(median: &Vector3<f64>, channels: &Channels) -> Message {
    let conventions = channels.conventions;
    if conventions.gravity == Gravity::Removed {
        text!["gravity-in-removed"]
    } else if (median + Vector3::new(0.0, 0.0, STANDARD_GRAVITY)).norm() < GRAVITY_TOLERANCE {
        let opposite = || {
            let forces = [0, 1, 2].map(Quantity::Force);
            let turned = forces.map(|force| format!("{}={}", force.key(), conventions.turned_column(force)));
            given("columns", format!("\"{}\"", turned.join(",")))
        };
        match conventions.axes {
            // Axes that point down keep the sign of bends.
            _ if channels.speed_of_bends().is_some_and(|speed| speed < 0.0) => {
                text!["forces-opposite", opposite = opposite()]
            }
            Axes::ForwardLeftUp | Axes::ForwardRightUp => text!["z-down"],
            Axes::ForwardRightDown => text!["z-up"],
        }
    } else if median.norm() < GRAVITY_TOLERANCE {
        text!["gravity-taken-out"]
    } else if (median.norm() - STANDARD_GRAVITY).abs() < GRAVITY_TOLERANCE {
        text!["other-axis-vertical", axis = ["x", "y", "z"][median.iamax()]]
    } else {
        text!["gravity-in-no-unit"]
    }
}

/// Rates that are plausible only as deg/s. A given unit overrides all tests except the first.
pub fn rate_unit(channels: &Channels, _: Quantity) -> Option<Message> {
    // Angular velocity that no head exceeds for a hundredth of a recording [rad/s].
    const FASTEST_RATE: f64 = 10.0;
    let (unit, source) = channels.table.unit(Quantity::Rate(0));
    if unit != RateUnit::RadianPerSecond.unit() {
        return None;
    }
    let fast = usual_maximum(channels.inputs);
    let (evidence, insist) = if fast > FASTEST_RATE {
        (text!["rates-reach", fast], Message::default())
    } else if source == UnitSource::Default {
        (evidence_of_degrees_a_second(channels)?, text!["or-if-they-are"])
    } else {
        return None;
    };
    let remedy = channels.unit_remedy(Quantity::Rate(0), RateUnit::DegreePerSecond.word());
    Some(text!["rates-in-degrees", evidence, remedy, insist])
}

/// Angular velocity that is exceeded for a hundredth of the time \[rad/s\].
pub fn usual_maximum(inputs: &[Input]) -> f64 {
    let rates = sorted(inputs.iter().map(|input| input.angular_velocity.amax()));
    rates[(rates.len() - 1) * 99 / 100]
}

fn evidence_of_degrees_a_second(channels: &Channels) -> Option<Message> {
    // Swing of roll or pitch, drift removed, that no vehicle exceeds [rad]: a motorcycle goes from
    // -1 to 1.
    const WIDEST_SWING: f64 = 3.5;
    let by_angle = |axis: usize| {
        let name = Quantity::Angle(axis).key();
        let derivative = || rates_of_angle(channels, axis, name).filter(|_| channels.table.has_orientation());
        derivative().or_else(|| {
            let swing = widest_swing(channels, axis);
            let is_wide = swing > WIDEST_SWING;
            is_wide.then(|| text!["rates-swing", name, swing = swing.to_degrees(), drift = DRIFT_TIME])
        })
    };
    // Roll and pitch.
    let mut angles = (0..2).filter(|_| channels.has_body_rates());
    angles.find_map(by_angle).or_else(|| rates_of_turn(channels))
}

fn rates_of_angle(channels: &Channels, axis: usize, name: &str) -> Option<Message> {
    let angles: Vec<f64> = channels.angle(axis).collect();
    let derivative: Vec<f64> = angles.windows(2).map(|pair| (pair[1] - pair[0]) / channels.step).collect();
    let rates: Vec<f64> = channels.rate(axis).take(derivative.len()).collect();
    let scale = relation(&derivative, &rates).slope().filter(|scale| (30.0..100.0).contains(scale))?;
    Some(text!["rates-of-angle", scale, name])
}

fn rates_of_turn(channels: &Channels) -> Option<Message> {
    // Least lateral specific force of a turn, as a standard deviation [m/s2].
    const MIN_TURN_FORCE: f64 = 0.3;
    // Radius below which no vehicle turns [m]; in deg/s for rad/s, a radius of 1 km reads as 0.3 m.
    const TIGHTEST_RADIUS: f64 = 1.0;
    let lateral = channels.lateral();
    if root_mean_square(&lateral) < MIN_TURN_FORCE {
        return None;
    }
    let yaw = smooth(channels.rate(2), channels.step);
    // a = v omega of a turn; a two-wheeler has no lateral force in its turns, and none that has the yaw rate's sign.
    let speed = relation(&yaw, &lateral).slope()?;
    let radius = speed / root_mean_square(&yaw);
    (0.0..TIGHTEST_RADIUS).contains(&radius).then(|| text!["rates-of-turn", speed, radius])
}

/// Widest swing of the integral of a rate over any [`DRIFT_TIME`], from which its straight drift is
/// removed \[rad\].
fn widest_swing(channels: &Channels, axis: usize) -> f64 {
    let angles = integral(channels.rate(axis), channels.step);
    let window = ((DRIFT_TIME / channels.step) as usize).clamp(2, angles.len().max(2));
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
